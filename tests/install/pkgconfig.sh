#!/usr/bin/env bash
# Builds a host with only a compiler and pkg-config, for both widths.
#
#   pkgconfig.sh static|shared PREFIX WORK
set -euo pipefail

kind=$1 prefix=$2 work=$3
host=$(dirname "${BASH_SOURCE[0]}")/consumer/host17.cpp
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name tandem.pc)")
export PKG_CONFIG_PATH
rm -rf "$work"
mkdir -p "$work"

options=(--cflags --libs)
[[ $kind == shared ]] || options+=(--static)
for module in tandem tandem-float64; do
  read -ra flags <<<"$(pkg-config "${options[@]}" "$module")"
  g++ -std=c++17 "$host" "${flags[@]}" "-Wl,-rpath,$(dirname "$PKG_CONFIG_PATH")" -o "$work/$module"
  "$work/$module" | tee "$work/$module.log"
  grep -q '^cube pushed to' "$work/$module.log"
  # The static program contains Tandem; the shared one depends on it.
  if ldd "$work/$module" | grep -q 'libtandem_plugin' && [[ $kind == static ]]; then
    echo "$module: a static package, but the program looks for a shared library" >&2
    exit 1
  fi
done

for module in tandem-coordination tandem-devices; do
  pkg-config "${options[@]}" --print-errors "$module"
done
if [[ $kind == shared ]] && pkg-config --print-requires-private tandem tandem-devices 2>/dev/null | grep .; then
  echo "a shared package asks for what only static ones need" >&2
  exit 1
fi
