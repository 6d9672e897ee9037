#!/usr/bin/env bash
# Links the programs to the shared libraries, to test that these export all that a large user needs. Nothing is compiled
# again: takes the link command of the static build and replaces our libraries by the shared ones.
#
#   shared_program.sh STATIC_BUILD STATIC_PREFIX SHARED_PREFIX WORK
set -euo pipefail

build=$(cd "$1" && pwd) scenario=$2/share/tandem/scenarios/experiment1.toml prefix=$3 work=$4
libraries=$(find "$prefix" -name libtandem_coordination.so -printf '%h\n' -quit)
names='coordination|network|falcon|devices|(bullet_bridge|plugin)(_float64)?'
mkdir -p "$work"
for program in tandem tandem-float; do
  command=$(ninja -C "$build" -t commands "demos/$program" | tail -n 1)
  command=$(sed -E "s#[^ ]*/libtandem_($names)\.a#$libraries/libtandem_\1.so#g
                    s#-o demos/$program( |$)#-o $work/$program -Wl,-rpath,$libraries #" <<<"$command")
  (cd "$build" && bash -c "$command")
  readelf -d "$work/$program" | grep -q 'NEEDED.*libtandem_plugin' || { echo "$program is not linked anew" >&2; exit 1; }
  "$work/$program" run --json "$scenario" >"$work/$program.json"
  grep state_hash "$work/$program.json"
done
