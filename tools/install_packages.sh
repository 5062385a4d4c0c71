#!/usr/bin/env bash
# Installs the Debian packages of packages/debian.txt that this machine lacks.
#
#   tools/install_packages.sh [--list] [GROUP...]     (no GROUP: all but the optional ones)
#
# Where nothing is missing it says nothing, calls no package manager and needs no privileges.
# Otherwise it installs what is missing as root, or through sudo.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
package_list=${MANOSCOPE_PACKAGE_LIST:-$here/packages/debian.txt}

fail() {
  printf 'install_packages: %s\n' "$@" >&2
  exit 1
}

usage() {
  cat <<'TEXT'
usage: tools/install_packages.sh [--list] [GROUP...]

Installs the packages of packages/debian.txt that are missing.
  GROUP     a group of that file; without one, every group that is not optional
  --list    print the packages of the groups, one a line, and install nothing
  --help    this text
TEXT
}

# The names of all groups, one a line.
groups_of_list() {
  sed -n 's/^\[\([a-z-]*\)\].*/\1/p' "$package_list"
}

# Those that are taken without being named.
ordinary_groups() {
  sed -n '/^\[[a-z-]*\][[:space:]]*optional/d; s/^\[\([a-z-]*\)\].*/\1/p' "$package_list"
}

# The packages of the groups given as arguments, one a line, each once.
packages_of() {
  awk -v wanted=" $* " '
    { sub(/#.*/, "") }
    /^\[/ { group = $1; gsub(/[][]/, "", group); next }
    NF && index(wanted, " " group " ") && !seen[$1]++ { print $1 }
  ' "$package_list"
}

# Those of the packages given as arguments that are not installed, one a line.
missing_of() {
  dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null |
    awk -v packages="$*" '
      $1 == "installed" { installed[$2] = 1 }
      END {
        n = split(packages, name, " ")
        for (i = 1; i <= n; ++i) if (!(name[i] in installed)) print name[i]
      }'
}

# Runs a command as root: directly, or through sudo.
as_root() {
  if [[ $(id -u) -eq 0 ]]; then
    env DEBIAN_FRONTEND=noninteractive "$@"
    return
  fi
  local kept=() name
  for name in http_proxy https_proxy no_proxy; do
    if [[ -n ${!name:-} ]]; then kept+=("$name=${!name}"); fi
  done
  sudo env DEBIAN_FRONTEND=noninteractive "${kept[@]}" "$@"
}

main() {
  local list_only=no groups=() argument
  [[ -r $package_list ]] || fail "cannot read the package list $package_list"
  local known
  known=" $(groups_of_list | tr '\n' ' ')"
  for argument in "$@"; do
    case $argument in
      --list) list_only=yes ;;
      -h | --help)
        usage
        return
        ;;
      -*) fail "unknown option $argument" "see tools/install_packages.sh --help" ;;
      *)
        [[ $known == *" $argument "* ]] ||
          fail "no group '$argument' in $package_list" "its groups are:$known"
        groups+=("$argument")
        ;;
    esac
  done
  # No process substitution here: a bare chroot may have no /dev/fd.
  if [[ ${#groups[@]} -eq 0 ]]; then
    read -r -a groups <<<"$(ordinary_groups | tr '\n' ' ')"
  fi

  local packages missing
  read -r -a packages <<<"$(packages_of "${groups[@]}" | tr '\n' ' ')"
  if [[ $list_only == yes ]]; then
    printf '%s\n' "${packages[@]}"
    return
  fi

  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    fail "this machine has no apt-get; manoscope's package list is made for Debian 12." \
      "Install what these Debian packages hold by your own means: ${packages[*]}" \
      "and then run make with PACKAGES=no, which skips this step."
  fi

  read -r -a missing <<<"$({ missing_of "${packages[@]}" || true; } | tr '\n' ' ')"
  if [[ ${#missing[@]} -eq 0 ]]; then return; fi

  if [[ $(id -u) -ne 0 ]] && ! command -v sudo >/dev/null; then
    fail "these packages are missing: ${missing[*]}" \
      "They need root to be installed, and there is no sudo here. As root, run:" \
      "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" \
      "or run make with PACKAGES=no if you have the libraries from elsewhere."
  fi

  printf 'install_packages: installing %s\n' "${missing[*]}" >&2
  as_root apt-get update -qq ||
    printf 'install_packages: apt-get update failed; trying with the lists at hand\n' >&2
  as_root apt-get install -y -qq --no-install-recommends -o DPkg::Lock::Timeout=300 "${missing[@]}" ||
    fail "apt-get could not install: ${missing[*]}" \
      "The reason stands above. Mend it and run make again, or install them yourself, as root:" \
      "  apt-get update && apt-get install --no-install-recommends ${missing[*]}"
}

main "$@"
