#!/usr/bin/env bash
# Makes the figures of docs/stability.md anew. They take a minute of a core.
#
#   scripts/stability_figures.sh [BUILD]     BUILD: build folder, build/release by default
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

program="${1:-build/release}/demos/tandem"
out=out/stability
"$program" analyse demos/scenarios/experiment1.toml --map coordination.damping,coordination.stiffness --out $out/two_gains
for experiment in 1 2; do
  "$program" analyse "demos/scenarios/experiment$experiment.toml" --figures --out "$out/experiment$experiment"
done
"$program" plot $out/experiment1 $out/experiment2

# publish FIGURE NAME: copies a figure without the spaces at line ends, which change nothing in it.
publish() { sed 's/ *$//' "$out/$1.svg" >"docs/images/stability_$2.svg"; }

publish two_gains/map two_gains
publish experiment1/figures/stability-map-1 maps
publish experiment1/figures/stability-damping damping
publish experiment1/figures/stability-limits-1 limits
publish experiment1/figures/stability-users-1 users
publish experiment1/figures/stability-fine delay_steps
