#!/usr/bin/env bash
# Tests the libraries that other programs load: the LD_PRELOAD library in a foreign program, for both widths, and the
# plugin for PyBullet. The tests of the build itself run the plugin in a stub of PyBullet's server.
#
#   adaptors.sh PREFIX WORK
set -euo pipefail

prefix=$1 work=$2
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
preload=$(find "$prefix" -name libtandem-preload.so)
plugin=$(find "$prefix" -name libtandem-pybullet.so)
rm -rf "$work"
mkdir -p "$work"

cat >"$work/push.toml" <<'END'
object = 1
[device]
start = [-0.03, 0, 0.02]
force = [5, 0, 0]
END
for bullet in bullet bullet-float64; do
  read -ra flags <<<"$(pkg-config --cflags --libs "$bullet")"
  g++ -std=c++20 -I "$tests" "$tests/preload/host.cpp" "${flags[@]}" -o "$work/host-$bullet"
  LD_PRELOAD=$preload TANDEM_PRELOAD=$work/push.toml "$work/host-$bullet" >"$work/$bullet.out" 2>"$work/$bullet.err"
  grep -q '^tandem preload: shares moving body 1 of world 1' "$work/$bullet.err" || {
    cat "$work/$bullet.err"
    echo "$bullet: nothing is shared" >&2
    exit 1
  }
done

# The plugin finds its dependencies from its place. The entry points exist, and the helper finds the file.
python3 - "$plugin" <<'END'
import ctypes, sys
plugin = ctypes.CDLL(sys.argv[1])
for name in ("initPlugin", "exitPlugin", "executePluginCommand", "preTickPluginCallback", "postTickPluginCallback"):
    getattr(plugin, name + "_tandem")
END
PYTHONPATH=$(dirname "$(find "$prefix" -name tandem_pybullet.py)") python3 - "$plugin" <<'END'
import os, sys, types
sys.modules["pybullet"] = types.ModuleType("pybullet")  # to be imported, no more
import tandem_pybullet
found = tandem_pybullet.find_plugin()
assert os.path.samefile(found, sys.argv[1]), found
END
