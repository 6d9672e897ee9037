#!/usr/bin/env bash
# The only list of Debian packages that Tandem needs. Prints or installs them.
#
#   scripts/packages.sh list    build demo   prints what the groups contain
#   scripts/packages.sh missing build demo   prints which of them are not installed
#   scripts/packages.sh install build demo   installs what is missing; needs no network if none is missing
#
# Groups: build (library and program), demo (figures), view (the window, films, and those of reports), import (worlds
# as URDF, MJCF and .bullet; optional), test, bench (other engines that tandem bench compares with, and valgrind for
# instruction counts; optional), dds (the carrier on Cyclone DDS; optional), live (cyclictest, for live_bench.sh;
# optional), hosts (a foreign simulator with Bullet inside, for tests/preload), package (Debian packages), ci (Clang,
# sanitizers, fuzzing, format).
set -euo pipefail

packages_of() {
  case "$1" in
    build) echo g++ cmake ninja-build pkg-config libbullet-dev libeigen3-dev libfmt-dev \
                nlohmann-json3-dev libtomlplusplus-dev libcli11-dev libboost-dev libsodium-dev \
                libftdi1-dev libhidapi-dev libtinyobjloader-dev ;;
    demo)  echo python3-matplotlib ;;
    import) echo libmujoco-dev libbullet-extras-dev ;;
    view)  echo libglfw3-dev libimgui-dev libopengl-dev libegl-dev libgl1 libgl1-mesa-dri fonts-dejavu-core ;;
    test)  echo libgtest-dev python3 ccache xvfb xdotool ;;
    bench) echo libmujoco-dev libode-dev libsimbody-dev valgrind ;;
    dds)   echo cyclonedds-dev cyclonedds-tools ;;
    live)  echo rt-tests ;;
    hosts) echo libignition-physics-sdf-dev libignition-plugin-dev libignition-physics5-bullet-plugin5 ;;
    package) echo dpkg-dev binutils ;;
    ci)    echo clang libclang-rt-14-dev lld llvm clang-format clang-tidy ;;
    *)     echo "packages.sh: $1: there is no such group; allowed: build, demo, view, import, test, bench, dds, live, hosts, package, ci" >&2; return 2 ;;
  esac
}

packages_of_all() {
  local group
  for group in "$@"; do packages_of "$group"; done | tr ' ' '\n'
}

is_installed() {
  [[ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" == installed ]]
}

missing_of() {
  local name
  for name in $(packages_of_all "$@"); do is_installed "$name" || echo "$name"; done
}

# Runs apt-get with rights to install: as root, or through sudo (which asks only on a terminal).
apt_get() {
  local rights=()
  if (( EUID != 0 )); then
    rights=(sudo)
    [[ -t 0 ]] || rights+=(-n)
  fi
  "${rights[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 "$@" </dev/null
}

require_rights() {
  (( EUID == 0 )) || command -v sudo >/dev/null && return
  echo "packages.sh: installing needs root, and there is no sudo here; run as root:" >&2
  echo "  apt-get update && apt-get install --no-install-recommends $*" >&2
  return 1
}

install_missing() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "This is no Debian: nothing is installed for you. Debian's names of what is needed:"
    packages_of_all "$@" | paste -sd' '
    return
  fi
  local missing
  missing=$(missing_of "$@" | paste -sd' ')
  if [[ -z "$missing" ]]; then
    echo "All packages are there ($*)."
    return
  fi
  # shellcheck disable=SC2086  # one word per package from here on
  require_rights $missing
  echo "Installing: $missing"
  apt_get update -qq || echo "The package lists could not be refreshed; trying with those at hand." >&2
  # shellcheck disable=SC2086
  if ! apt_get install -qq -y --no-install-recommends $missing; then
    echo "packages.sh: could not install: $missing" >&2
    echo "  Is the network up, and are these in a Debian 12 archive? Then run this again, or install them by hand." >&2
    return 1
  fi
}

main() {
  local command=${1:-}
  (( $# >= 2 )) || command=help
  shift || true
  local group
  for group in "$@"; do packages_of "$group" >/dev/null; done
  case "$command" in
    list)    packages_of_all "$@" ;;
    missing) missing_of "$@" ;;
    install) install_missing "$@" ;;
    *)       sed -n '2,13s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; return 2 ;;
  esac
}

main "$@"
