#!/usr/bin/env bash
# Compares the state hashes of both experiments with all schemes from two build folders. Equal runs must have equal
# hashes in Debug and Release and with any compiler.
#
#   scripts/compare_hashes.sh build/dev build/release
#
# Status 0: all equal; 1: something differs or a run failed; 2: bad use.
set -euo pipefail

if [ $# -ne 2 ]; then
  echo "usage: $0 BUILD1 BUILD2    (two build folders, such as build/dev build/release)" >&2
  exit 2
fi
build1=$1 build2=$2
programs=(tandem)
if [ -x "$build1/demos/tandem-float" ] && [ -x "$build2/demos/tandem-float" ]; then programs+=(tandem-float); fi
for build in "$build1" "$build2"; do
  for program in "${programs[@]}"; do
    if [ ! -x "$build/demos/$program" ]; then
      echo "$0: no program $build/demos/$program; build it first: cmake --build $build --target $program" >&2
      exit 2
    fi
  done
done
scenarios=$(cd "$(dirname "${BASH_SOURCE[0]}")/../demos/scenarios" && pwd)
different=0

# state_hash PROGRAM ARGUMENTS...: the hash of one run, or nothing if it failed.
state_hash() {
  "$1" run --json "${@:2}" | sed -n 's/^ *"state_hash": *"\([0-9a-f]*\)".*/\1/p' || true
}

# compare PROGRAM EXPERIMENT SCHEME KEY=VALUE...
compare() {
  local program=$1 name=$* arguments=("$scenarios/$2.toml" --set "experiment.scheme=$3")
  for override in "${@:4}"; do arguments+=(--set "$override"); done
  local first second
  first=$(state_hash "$build1/demos/$program" "${arguments[@]}")
  second=$(state_hash "$build2/demos/$program" "${arguments[@]}")
  if [ -n "$first" ] && [ "$first" = "$second" ]; then
    echo "equal      $first  $name"
  else
    echo "DIFFERENT  ${first:-(run failed)} and ${second:-(run failed)}: $name"
    different=1
  fi
}

for program in "${programs[@]}"; do
  for experiment in experiment1 experiment2; do
    for scheme in virtual_coupling kinematic_proxy remote_dynamic_proxy; do
      compare "$program" "$experiment" "$scheme" bridge.injection=handoff
      compare "$program" "$experiment" "$scheme" bridge.injection=impulse rates.host=1000
      compare "$program" "$experiment" "$scheme" experiment.guide=false 'site1.hand_force=[3,0.2,0.1]'
    done
  done
done
if [ "$different" -ne 0 ]; then
  echo "$0: $build1 and $build2 do not compute the same states" >&2
fi
exit "$different"
