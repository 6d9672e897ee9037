#!/usr/bin/env bash
# Measures how punctual the live loop is, beside a bare periodic thread (cyclictest) of the same priority.
#
#   scripts/live_bench.sh [--runs N] [--seconds S] [--priority P]     5 runs of 60 s at 80
#
# In turns: cyclictest while a host steps 1000 active boxes at 60 Hz; two live sites of Experiment I, one of them with
# that host; one second of it beside the same in virtual time. Limits are on the medians: skipped ticks, wake-up and tick
# times, and the force. All measurements stay in out/live_bench. Needs the right to SCHED_FIFO.
#
# Exit status 0: all limits hold. 3: one does not. 1 and 2: the measurement failed, or bad use.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/steps.sh"

runs=5 seconds=60 priority=80
out="$checkout/out/live_bench"
program="$checkout/build/release/tests/tandem_live_bench"

fail() { echo "live_bench.sh: $1" >&2; exit "${2:-1}"; }

# number NAME VALUE LEAST MOST
number() {
  [[ "$2" =~ ^[1-9][0-9]{0,4}$ ]] && (( $2 >= $3 && $2 <= $4 )) || fail "$1 ${2:-(nothing)}: must be $3 to $4" 2
}

while (( $# > 0 )); do
  case "$1" in
    --runs)     runs=${2:-}; number "$1" "$runs" 1 99 ;;
    --seconds)  seconds=${2:-}; number "$1" "$seconds" 1 3600 ;;
    --priority) priority=${2:-}; number "$1" "$priority" 1 98 ;;
    -h|--help)  sed -n '2,10s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
    *) fail "$1: there is no such option; allowed: --runs, --seconds, --priority" 2 ;;
  esac
  shift 2
done

chrt --fifo "$priority" true 2>/dev/null ||
  fail "no right to real-time priority $priority; be root, or give your user rtprio in /etc/security/limits.d and log in anew"

"$checkout/scripts/packages.sh" install build test live
configure_preset release -DTANDEM_BUILD_TESTS=ON
build_preset release tandem_live_bench
rm -rf "$out" && mkdir -p "$out"

# bare ROUND: runs cyclictest, with a histogram of wake-up times per microsecond up to 20 ms.
bare() {
  "$program" --load --seconds $((seconds + 2)) >"$out/load$1.json" & local load=$!
  sleep 1
  cyclictest --quiet --priority="$priority" --mlockall --interval=1000 --duration="$seconds" \
    --histogram=20000 --threads=1 >"$out/bare$1.txt"
  wait "$load"
}

trap 'kill $(jobs -p) 2>/dev/null || true' EXIT
for (( round = 1; round <= runs; ++round )); do
  step "run $round of $runs: cyclictest for $seconds s beside the host"
  bare "$round"
  step "run $round of $runs: two live sites for $seconds s"
  "$program" --json --seconds "$seconds" --priority "$priority" >"$out/live$round.json"
  step "run $round of $runs: one second beside virtual time"
  "$program" --json --compare --priority "$priority" >"$out/beside$round.json"
  uptime | sed 's/.*load/         load/'
done

python3 - "$out" "$runs" <<'PYTHON'
import json, pathlib, statistics, sys

out, runs = pathlib.Path(sys.argv[1]), range(1, int(sys.argv[2]) + 1)
PERIOD = 1000  # us


def read_bare(path):
    """Share of missed periods and p99 [us] of a histogram: a thread so late has missed the periods that have passed."""
    counts, beyond, longest = [], 0, 0
    for line in path.read_text().splitlines():
        words = line.split()
        if line.startswith("# Histogram Overflows:"):
            beyond = int(words[-1])
        elif line.startswith("# Max Latencies:"):
            longest = int(words[-1])
        elif len(words) == 2 and words[0].isdigit():
            counts.append((int(words[0]), int(words[1])))
    counts.append((longest, beyond))
    samples = sum(count for _, count in counts)
    missed = sum(count * (late // PERIOD) for late, count in counts)
    passed = 0
    for late, count in counts:
        passed += count
        if passed >= 0.99 * samples:
            return missed / (samples + missed), late, longest


bare = [read_bare(out / f"bare{n}.txt") for n in runs]
live = [json.loads((out / f"live{n}.json").read_text()) for n in runs]
beside = [json.loads((out / f"beside{n}.json").read_text()) for n in runs]

print(f"\n{'run':>3}{'bare: missed':>14}{'p99 us':>8}{'max us':>8}{'live: missed':>14}{'p99 us':>8}{'max us':>8}"
      f"{'tick p99':>10}{'max us':>8}{'host p50':>10}{'max ms':>8}{'force':>9}")
for n, (b, l, c) in enumerate(zip(bare, live, beside), 1):
    d = c["difference"]
    print(f"{n:>3}{b[0]:>14.1e}{b[1]:>8}{b[2]:>8}{l['skipped_rate']:>14.1e}{1e6 * l['wake']['p99']:>8.1f}"
          f"{1e6 * l['wake']['max']:>8.0f}{1e6 * l['tick']['p99']:>10.1f}{1e6 * l['tick']['max']:>8.0f}"
          f"{1e3 * l['host']['step']['p50']:>10.2f}{1e3 * l['host']['step']['max']:>8.1f}"
          f"{100 * max(d['force_mean'], d['force_max']):>7.2f} %")
    for note in l["notes"]:
        print("    note:", note)


def median(values):
    return statistics.median(list(values))


bare_missed, bare_p99 = median(b[0] for b in bare), median(b[1] for b in bare)
rows = [
    ("missed ticks, share", bare_missed + 1e-4, median(l["skipped_rate"] for l in live), "{:.2e}"),
    ("wake-up p99 [us]", 1.5 * bare_p99, median(1e6 * l["wake"]["p99"] for l in live), "{:.1f}"),
    ("tick p99 [us]", 50.0, median(1e6 * l["tick"]["p99"] for l in live), "{:.1f}"),
    ("force, mean, off virtual time [%]", 2.0, median(100 * c["difference"]["force_mean"] for c in beside), "{:.3f}"),
    ("force, max, off virtual time [%]", 2.0, median(100 * c["difference"]["force_max"] for c in beside), "{:.3f}"),
]
print(f"\n{'medians':<36}{'at most':>10}{'measured':>10}")
missed = False
for name, asked, measured, form in rows:
    holds = measured <= asked
    missed |= not holds
    print(f"{name:<36}{form.format(asked):>10}{form.format(measured):>10}  {'pass' if holds else 'FAIL'}")
sys.exit(3 if missed else 0)
PYTHON
