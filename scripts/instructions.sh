#!/usr/bin/env bash
# Counts instructions per haptic tick with valgrind's callgrind, and compares them with a checked-in baseline.
#
#   scripts/instructions.sh [--update] [BUILD]     BUILD: build folder, build/release by default
#
# Exit status 0: within the tolerance, or not comparable (another compiler, other flags or another processor than the
# baseline's; it prints this). 1: a scene costs more or less than the baseline allows. 2: cannot count. --update writes
# the baseline; commit it with the reason for the change.
set -euo pipefail
cd "$(dirname "$0")/.."

update=false
if [[ "${1:-}" == --update ]]; then update=true; shift; fi
program="${1:-build/release}/tests/tandem_tick_instructions"
baseline=tests/bench/tick_instructions.json
ticks=2000

fail() { echo "instructions.sh: $*" >&2; exit 2; }
command -v valgrind >/dev/null || fail "valgrind is not installed; scripts/packages.sh install bench"
[[ -x "$program" ]] || fail "$program is not there; build the target tandem_tick_instructions"

about="$("$program" about)"
if ! $update; then
  [[ -f "$baseline" ]] || fail "$baseline is not there; make it with --update"
  wanted="$(python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["built_with"])' "$baseline")"
  if [[ "$about" != "$wanted" ]]; then
    echo "skipped: the baseline belongs to \"$wanted\", this is \"$about\""
    exit 0
  fi
fi

folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
for scene in $("$program" scenes); do
  valgrind --tool=callgrind --collect-atstart=no --toggle-collect=measureTick \
    --callgrind-out-file="$folder/$scene" "$program" "$scene" "$ticks" >"$folder/log" 2>&1 ||
    { cat "$folder/log" >&2; fail "valgrind could not run the scene $scene"; }
done

python3 - "$folder" "$baseline" "$ticks" "$about" "$update" <<'PYTHON'
import json, pathlib, sys

folder, baseline, ticks, about, update = sys.argv[1:]
counts = {}
for file in sorted(pathlib.Path(folder).iterdir()):
    if file.name == "log":
        continue
    total = next(line for line in file.read_text().splitlines() if line.startswith(("summary:", "totals:")))
    counts[file.name] = round(int(total.split()[1]) / int(ticks))
if update == "true":
    text = {"built_with": about, "tolerance": 0.03, "instructions_per_tick": counts}
    pathlib.Path(baseline).write_text(json.dumps(text, indent=2) + "\n")
    print(f"{baseline} written")
known = json.loads(pathlib.Path(baseline).read_text())
wrong = False
for scene, count in counts.items():
    before = known["instructions_per_tick"].get(scene)
    if before is None:
        print(f"NEW   {scene:<20} {count:>8}: not in the baseline")
        wrong = True
        continue
    change = count / before - 1.0
    good = abs(change) <= known["tolerance"]
    wrong |= not good
    word = "same" if good else "MORE" if change > 0 else "LESS"
    print(f"{word}  {scene:<20} {count:>8} per tick, baseline {before:>8} ({change:+.1%})")
sys.exit(1 if wrong else 0)
PYTHON
