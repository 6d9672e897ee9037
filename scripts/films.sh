#!/usr/bin/env bash
# Makes the films of README.md and docs/view.md anew, one for each world. Needs the program ffmpeg and no display.
#
#   scripts/films.sh [BUILD]     BUILD: build folder, build/release by default
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

program="${1:-build/release}/demos/tandem"
for world in demos/worlds/*.toml; do
  "$program" film "$world" --out "docs/films/$(basename "$world" .toml).gif"
done
