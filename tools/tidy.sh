#!/usr/bin/env bash
# Runs clang-tidy on the sources under src, tests left out, with the settings of .clang-tidy.
#
#   tools/tidy.sh [BUILD [FILE...]]    (BUILD: a configured and built folder; default: build)
#
# JOBS in the environment sets how many run at a time. A file that passed is not looked at again
# until it, a header of the project, the compile commands or the settings change.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build=${1:-build}
if [[ $# -gt 0 ]]; then shift; fi
if [[ ! -f $build/compile_commands.json ]]; then
  printf 'tidy: no %s/compile_commands.json; run make first\n' "$build" >&2
  exit 2
fi

if [[ $# -gt 0 ]]; then
  files=("$@")
else
  mapfile -t files < <(find src -type f -name '*.cpp' ! -name '*_test.cpp' | sort)
fi

# Sources that this build leaves out, for want of an optional library, cannot be looked at.
built=()
for file in "${files[@]}"; do
  if grep -qF "/$file\"" "$build/compile_commands.json"; then built+=("$file"); fi
done
files=("${built[@]}")
if [[ ${#files[@]} -eq 0 ]]; then exit 0; fi

# What every file's verdict depends on besides the file itself.
passed=$build/tidy-passed
mkdir -p "$passed"
common=$({
  clang-tidy --version
  cat .clang-tidy "$build/compile_commands.json"
  find src -type f -name '*.hpp' | sort | xargs --no-run-if-empty cat
} | sha256sum)
export build passed common

check_one() {
  local file=$1 stamp
  stamp=$passed/$({ printf '%s %s\n' "$common" "$file"; cat "$file"; } | sha256sum | cut -c 1-40)
  if [[ -f $stamp ]]; then return 0; fi
  local report
  if report=$(clang-tidy -p "$build" --quiet "$file" 2>&1); then
    : >"$stamp"
  else
    printf '%s\n' "$report" | grep -vE '^([0-9]+ warnings|Suppressed|Use -header-filter)' >&2 || true
    return 1
  fi
}
export -f check_one

# shellcheck disable=SC2016  # $1 is the inner shell's
if ! printf '%s\0' "${files[@]}" |
  xargs -0 -n 1 -P "${JOBS:-$(nproc)}" bash -c 'check_one "$1"' check_one; then
  printf 'tidy: clang-tidy found faults, shown above\n' >&2
  exit 1
fi
