#!/usr/bin/env bash
# Builds scripts and styles of report.html and of the local app from web/, or checks what was built.
#
#   tools/web.sh build             web/dist from web/
#   tools/web.sh check PROGRAM     types, unit tests, web/dist as built, report.html and the app in a browser
#
# Needs node and npm; `check` also chromium, found on the PATH or named in the variable CHROMIUM.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

fail() {
  printf 'web: %s\n' "$@" >&2
  exit 1
}

for needed in node npm; do
  command -v "$needed" >/dev/null || fail "no $needed here: run make without PACKAGES=no, or install it"
done

# The packages that web/package-lock.json names, unless they are here already.
fetch_packages() {
  if [[ web/node_modules/.package-lock.json -nt web/package-lock.json ]]; then return; fi
  npm --prefix web ci --ignore-scripts --no-audit --no-fund --loglevel=error
}

# The bundle again, in a folder of its own, against the one that was committed.
check_bundle() {
  local fresh=$1
  MANOSCOPE_WEB_DIST=$fresh npm --prefix web run --silent build
  local file
  for file in report.js report.css app.js app.css; do
    cmp -s "$fresh/$file" "web/dist/$file" ||
      fail "web/dist/$file is not what web/ builds: run make web, and commit web/dist"
  done
}

# Reports of a virtual experiment as large as a real one, with maps and without.
make_pages() {
  local program=$1 pages=$2
  "$program" twin S1 -o "$pages/experiment" --quiet >/dev/null
  "$program" measure "$pages/experiment" -o "$pages/result" --quiet >/dev/null
  mkdir "$pages/without-maps"
  cp "$pages/result/result.nc" "$pages/without-maps"
  "$program" report "$pages/without-maps" >/dev/null
}

# Of that experiment every third level and run: it measures in seconds.
make_small_experiment() {
  local whole=$1 small=$2 list map
  mkdir "$small"
  cp "$whole/experiment.toml" "$small"
  for list in hydrostatic.csv flow.csv; do
    grep -v '^#' "$whole/$list" | awk 'NR == 1 || NR % 3 == 2' >"$small/$list"
    for map in $(tail -n +2 "$small/$list" | cut -d, -f1); do cp "$whole/$map" "$small"; done
  done
}

cd "$here"
case ${1:-} in
  build)
    fetch_packages
    npm --prefix web run --silent build
    ;;
  check)
    program=${2:?"web: check wants the program, build/manoscope"}
    program=$(realpath "$program")
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    fetch_packages
    npm --prefix web run --silent check
    npm --prefix web run --silent unit
    check_bundle "$work/dist"
    make_pages "$program" "$work"
    make_small_experiment "$work/experiment" "$work/small"
    MANOSCOPE_REPORT=$work/result/report.html \
      MANOSCOPE_REPORT_WITHOUT_MAPS=$work/without-maps/report.html \
      MANOSCOPE_PROGRAM=$program MANOSCOPE_EXPERIMENT=$work/small \
      npm --prefix web run --silent browser
    ;;
  *) fail "usage: tools/web.sh build | check PROGRAM" ;;
esac
