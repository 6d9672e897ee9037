#!/usr/bin/env bash
# Tests Debian's packages from beginning to end, on this machine. Packs a shared build, installs all three packages,
# builds and runs an outside project with them, runs the program, purges them, and looks for leftovers. Ends with 77,
# skipped, if that is impossible or unwanted.
#
#   debian.sh BUILD WORK
set -euo pipefail

build=$1 work=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
soversion=$(sed -n 's/^project(tandem VERSION \([0-9]*\.[0-9]*\)\..*/\1/p' "$here/../../CMakeLists.txt")
library=libtandem$soversion
packages=(tandem-tools libtandem-dev "$library")

skip() { echo "skipped: $*"; exit 77; }
fail() { echo "debian.sh: $*" >&2; exit 1; }
is_known() { dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null | grep -qvx 'not-installed'; }

(( EUID == 0 )) || skip "installing packages needs root"
command -v dpkg-shlibdeps >/dev/null || skip "there is no dpkg-shlibdeps; scripts/packages.sh install package"
for package in "${packages[@]}"; do
  ! is_known "$package" || skip "$package is installed on this machine already, and this test would remove it"
done

rm -rf "$work"
mkdir -p "$work"
# Lists all files of the system's folders that our packages might touch.
list_system() { find /usr/include /usr/lib /usr/share /usr/bin /etc -path '*tandem*' | sort; }
list_system >"$work/before"

"$here/../../scripts/deb.sh" "$build" "$work/deb"
purge() { dpkg --purge "${packages[@]}" >"$work/purge.log" 2>&1; }
trap purge EXIT
DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$work"/deb/*.deb </dev/null \
  >"$work/install.log" 2>&1 || { cat "$work/install.log"; fail "apt-get cannot install the packages"; }

# depends PACKAGE NAME: the package must declare this dependency.
depends() {
  dpkg-query -W -f='${Depends}' "$1" | tr ',' '\n' | sed 's/^ *//; s/ .*//' | grep -qxF "$2" ||
    fail "$1 does not depend on $2: $(dpkg-query -W -f='${Depends}' "$1")"
}
for needed in libbullet3.24 libsodium23 libftdi1-2 libhidapi-hidraw0 libc6 libstdc++6; do
  depends "$library" "$needed"
done
depends libtandem-dev "$library"
depends libtandem-dev libbullet-dev
depends libtandem-dev libeigen3-dev
depends tandem-tools "$library"

# No path is given: everything is in the system's own folders.
cmake -G Ninja -S "$here/consumer" -B "$work/consumer" -DCMAKE_CXX_COMPILER=g++ \
  "-DMINIMAL_HOST=$here/../../demos/hosts/minimal_host.cpp" >"$work/configure.log"
cmake --build "$work/consumer"
ctest --test-dir "$work/consumer" --output-on-failure
read -ra flags <<<"$(pkg-config --cflags --libs tandem-float64)"
g++ -std=c++17 "$here/consumer/host17.cpp" "${flags[@]}" -o "$work/host17"
"$work/host17"
# A build without the program packs the udev rule alone.
for program in tandem tandem-float; do
  [[ -x $build/demos/$program ]] || { echo "$program was not built, so not packed"; continue; }
  "$program" run --json /usr/share/tandem/scenarios/experiment1.toml >"$work/$program.json"
  ! readelf -d "/usr/bin/$program" | grep -q 'R.*PATH' || fail "$program looks for libraries elsewhere first"
done
! readelf -d "$(find /usr/lib -name libtandem_plugin.so)" | grep -q 'R.*PATH' || fail "the libraries hold a RUNPATH"
[[ -f /usr/lib/udev/rules.d/70-tandem-devices.rules ]] || fail "there is no udev rule"
[[ ! -x $build/demos/tandem || -f /usr/lib/systemd/system/tandem-relay.service ]] ||
  fail "there is no unit of the relay"
libraries=$(dirname "$(dpkg -L libtandem0.1 | grep 'libtandem_coordination.so.0.1$')")
for file in libtandem-preload.so tandem/preload-float.so tandem/preload-float64.so tandem/libtandem-pybullet.so; do
  [[ -f $libraries/$file ]] || fail "there is no $file"
  ! ldd "$libraries/$file" | grep 'not found' || fail "$file does not find what it needs"
done
for package in "${packages[@]}"; do
  [[ -f /usr/share/doc/$package/copyright ]] || fail "$package has no licence"
  dpkg --verify "$package" || fail "$package is not installed as it was packed"
done

trap - EXIT
purge || { cat "$work/purge.log"; fail "dpkg cannot purge the packages"; }
list_system | diff "$work/before" - || fail "purging leaves files behind"
for package in "${packages[@]}"; do ! is_known "$package" || fail "$package is still known to dpkg"; done
ldconfig -p | grep libtandem && fail "the linker's cache still has libtandem"
echo "Installed, used and purged: ${packages[*]}"
