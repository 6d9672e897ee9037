#!/usr/bin/env bash
# Makes docs/images/watching.png anew: a window that watches four users push a crate, of whom one has fallen silent.
# Runs a relay and the four on the loopback. Needs the programs Xvfb and xvfb-run.
#
#   scripts/watching.sh [BUILD]     BUILD: build folder, build/release by default
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

program="$PWD/${1:-build/release}/demos/tandem"
folder="$(mktemp -d)"
trap 'kill $(jobs -p) 2>/dev/null || true; wait; rm -r "$folder"' EXIT

hand() {  # OFFSET_X OFFSET_Y: pushes along x for 20 s
  echo "{hand=\"minimum_jerk\", hand_stiffness=300, hand_damping=8, start_offset=[$1, $2, 0]," \
    "hand_waypoints=[[0.5, 0, 0, 0], [2, 0.03, 0, 0], [12, 0.15, 0, 0], [20, 0.15, 0, 0]]}"
}
# Two on each side of a line through the crate's middle, and the first a bit ahead.
world=(--set "site=[$(hand -0.01 -0.022), $(hand -0.1 0.022), $(hand -0.012 0), $(hand -0.1 -0.06)]"
  --set coordination.mode=average --set experiment.duration=20)

for key in relay pair watch; do "$program" key new "$folder/$key" > /dev/null; done
: > "$folder/relay.txt"
"$program" relay --bind 127.0.0.1:0 --key "$folder/relay" > "$folder/relay.txt" &
until grep -q 127.0.0.1 "$folder/relay.txt"; do sleep 0.1; done
room=(--relay "$(sed -n '1s/.* //p' "$folder/relay.txt")" --relay-key "$folder/relay" --watch-key "$folder/watch")
for site in 1 2 3 4; do
  "$program" peer --scenario demos/worlds/crate.toml "${world[@]}" --site "$site" --bind 127.0.0.1:0 \
    --key "$folder/pair" "${room[@]}" --quiet &
done
fourth=$!
(sleep 8; kill "$fourth") &
xvfb-run -a "$program" view crate "${world[@]}" --watch "${room[@]}" --size 960x600 --seconds 11 \
  --screenshot docs/images/watching.png
