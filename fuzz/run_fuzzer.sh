#!/usr/bin/env bash
# Runs every reader of map files under libFuzzer.
#
#   fuzz/run_fuzzer.sh FUZZ_READER MUTATE_MAPS SECONDS [READER...]     (no READER: all of them)
#
# The corpus of each reader is kept in fuzz-corpus/READER, what fails in fuzz-findings/READER.
# Exit code 1 if anything fails.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
export LSAN_OPTIONS=suppressions=$here/leaks.supp:print_suppressions=0
fuzz_reader=$1 mutate_maps=$2 seconds=$3
shift 3
"$mutate_maps" --write-seeds fuzz-corpus
if [[ $# -eq 0 ]]; then
  for folder in fuzz-corpus/*/; do set -- "$@" "$(basename "$folder")"; done
fi

failed=()
for reader in "$@"; do
  mkdir -p "fuzz-findings/$reader"
  printf '%s: ' "$reader"
  if log=$("$fuzz_reader" "--reader=$reader" -max_total_time="$seconds" -timeout=20 \
    -rss_limit_mb=2048 -max_len=65536 -print_final_stats=1 -verbosity=0 \
    -artifact_prefix="fuzz-findings/$reader/" "fuzz-corpus/$reader" 2>&1); then
    sed -n 's/^stat::number_of_executed_units: */inputs read: /p' <<<"$log"
  else
    failed+=("$reader")
    printf 'FAILED\n'
    tail -n 40 <<<"$log"
  fi
done
if [[ ${#failed[@]} -gt 0 ]]; then
  printf 'run_fuzzer: faults in %s\n' "${failed[*]}" >&2
  exit 1
fi
