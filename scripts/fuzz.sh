#!/usr/bin/env bash
# Runs every fuzzer of the preset fuzz for SECONDS, from its seeds and from earlier findings. Keeps an input that breaks
# a parser in out/fuzz, and prints the command that reproduces it.
#
#   scripts/fuzz.sh [SECONDS]      60 by default; build first with scripts/test.sh fuzz
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/steps.sh"

seconds=${1:-60}
[[ "$seconds" =~ ^[1-9][0-9]*$ ]] || { echo "fuzz.sh: $seconds: give a whole number of seconds" >&2; exit 2; }
seeds="$checkout/tests/fuzz/corpus"
bin="$checkout/build/fuzz/tests/fuzz"

# Prints the log only if the fuzzer found something.
fuzz() {
  local name=$1 found="$checkout/out/fuzz/$1"
  mkdir -p "$found/corpus"
  if "$bin/tandem_fuzz_$name" -max_total_time="$seconds" -timeout=20 -max_len=4096 -print_final_stats=1 \
    "-artifact_prefix=$found/" "$found/corpus" "$seeds/$name" >"$found/log" 2>&1; then
    step "$name: $(sed -n 's/^stat::number_of_executed_units: *//p' "$found/log") inputs, none refused wrongly"
  else
    cat "$found/log"
    step "$name: FAILED; to see it again: $bin/tandem_fuzz_$name FILE, with the file named above"
    return 1
  fi
}

step "Fuzzing for $seconds s each"
failed=0
running=0
for folder in "$seeds"/*/; do
  if (( running == $(nproc) )); then
    wait -n || failed=1
    running=$((running - 1))
  fi
  fuzz "$(basename "$folder")" &
  running=$((running + 1))
done
while (( running > 0 )); do
  wait -n || failed=1
  running=$((running - 1))
done
exit "$failed"
