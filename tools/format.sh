#!/usr/bin/env bash
# Formats every C++ file of the project, or with --check names those that are not formatted.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

case ${1:-} in
  "") action=(-i) ;;
  --check) action=(--dry-run -Werror) ;;
  *)
    printf 'usage: tools/format.sh [--check]\n' >&2
    exit 2
    ;;
esac

folders=()
for folder in src tests bench fuzz examples python; do
  if [[ -d $folder ]]; then folders+=("$folder"); fi
done
[[ ${#folders[@]} -gt 0 ]] || exit 0

find "${folders[@]}" -type f \( -name '*.cpp' -o -name '*.hpp' \) -print0 |
  xargs -0 --no-run-if-empty clang-format "${action[@]}"
