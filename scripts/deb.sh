#!/usr/bin/env bash
# Debian packages: libtandem (shared libraries), libtandem-dev (to compile with), tandem-tools (the program).
#
#   scripts/deb.sh                 installs what is missing, builds, and puts the packages into out/deb
#   scripts/deb.sh BUILD FOLDER    from a finished build folder with shared libraries, into FOLDER
#
# Afterwards: apt-get install out/deb/*.deb
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/steps.sh"

case $#:${1:-} in
  0:)   build=$checkout/build/shared folder=$checkout/out/deb ;;
  2:-*) echo "deb.sh: $1: no such option" >&2; exit 2 ;;
  2:*)  build=$(cd "$1" && pwd) folder=$2 ;;
  *)    sed -n '2,7s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 2 ;;
esac

if [[ $# == 0 ]]; then
  step "Looking for packages that are missing"
  "$checkout/scripts/packages.sh" install build import package
  step "Configuring preset shared"
  configure_preset shared
  step "Building on $(nproc) cores"
  build_preset shared
fi
if [[ ! -f $build/CPackConfig.cmake ]]; then
  echo "deb.sh: $build makes no packages; configure it with BUILD_SHARED_LIBS=ON" >&2
  exit 2
fi

step "Packing"
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
rm -f "$folder"/*.deb
(cd "$build" && cpack -G DEB -B "$folder" >"$folder/cpack.log" 2>&1) || { cat "$folder/cpack.log" >&2; exit 1; }
rm -rf "$folder/_CPack_Packages"
step "Done"
ls -1s --block-size=K "$folder"/*.deb
