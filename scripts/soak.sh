#!/usr/bin/env bash
# Runs the long tests: those of the network, most in virtual time, for minutes each, and two over real sockets; and
# random worlds.
# scripts/test.sh runs a part of them.
#
#   scripts/soak.sh [forged|peers|churn|matrix|flood|attacks|guest]...     the first six by default
#
# forged: 1e8 forged, changed, cut, replayed and random datagrams at a live pair. peers: four sites for 24 hours with
# 1 s delay, 100 ms jitter, a quarter lost and a quarter doubled. churn: 10,000 times a site leaves, is killed or gets
# another port. matrix: two sites with worlds and devices under 150 conditions of the network, three times each, with an
# outage. flood: two `tandem peer` for 20 s, and again with 100,000 forged datagrams a second at one of them, three times
# each. Under the flood its memory may grow by 64 kB more than without. Another hundredth of all its ticks may be late,
# and another hundredth of its peer's states lost. attacks: two `tandem peer` for ten minutes, with a man in the middle
# without the key (tests/wire/attack.py), five attacks at the same time. They must be live all the time but a second.
# guest: a million random worlds (tandem bench guest) of seed TANDEM_GUEST_SEED, or of a seed of its own that it prints;
# hours on two cores.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/steps.sh"

# soak NAME PROGRAM TEST VARIABLE=VALUE...
soak() {
  local name=$1 program=$2 test=$3 start=$SECONDS
  shift 3
  step "$name: $*"
  env "$@" "$checkout/build/release/tests/$program" --gtest_brief=1 --gtest_filter="$test"
  step "$name: passed in $((SECONDS - start)) s"
}

flood_rate=100000  # datagrams a second
flood_port=17012   # of the site that is flooded
out="$checkout/out/soak"

# rss PID: resident memory [kB].
rss() { awk '/^VmRSS:/ { print $2 }' "/proc/$1/status"; }

# peer SITE PORT OTHER_PORT: call it in the background; its subshell becomes the program.
peer() {
  exec "$checkout/build/release/demos/tandem" peer --scenario "$checkout/demos/scenarios/experiment1.toml" \
    --set experiment.duration=20 --site "$1" --bind "127.0.0.1:$2" --peer "127.0.0.1:$3" --key "$out/k.psk" \
    --out "$out/$run" --quiet
}

# live_pair NAME RATE: runs 20 s with RATE forged datagrams a second at site 2, and prints a line. Sets $late, per
# million of its ticks; $given, the states that it received; $grown, its memory growth in kB from the 5th to the 19th
# second.
live_pair() {
  local run=$1 rate=$2 first second early end
  mkdir -p "$out/$run"
  peer 2 $flood_port $((flood_port - 1)) & second=$!
  peer 1 $((flood_port - 1)) $flood_port & first=$!
  sleep 2  # the countdown is over
  "$checkout/build/release/tests/tandem_flood" $flood_port "$rate" 18 >"$out/$run/flood.txt" & local flood=$!
  sleep 3
  early=$(rss $second)
  sleep 14
  end=$(rss $second)
  wait $first && wait $second && wait $flood || { step "flood: FAILED: a program ended badly"; return 1; }
  grown=$((end - early))
  late=$(python3 - "$out/$run/site2.json" "$early" "$end" <<'PYTHON'
import json, sys
run = json.load(open(sys.argv[1]))
loop, network = run["loop"], run["network"]
refused = sum(network["datagrams"]["refused"].values())
print(f"  ticks {loop['ticks']}, late {loop['late']}, worst {1e3 * loop['worst_lateness']:.2f} ms; "
      f"memory {sys.argv[2]} kB after 5 s, {sys.argv[3]} kB after 19 s; "
      f"states given {network['states']['given']}, datagrams refused {refused}", file=sys.stderr)
print(1000000 * loop["late"] // loop["ticks"], network["states"]["given"])
PYTHON
)
  given=${late#* } late=${late% *}
}

# median NUMBER...: the median of an odd count.
median() { printf '%s\n' "$@" | sort -n | sed -n "$((($# + 1) / 2))p"; }

flood() {
  local late grown given all_late=() all_grown=() all_given=() quiet_late=() quiet_grown=() quiet_given=()
  trap 'kill $(jobs -p) 2>/dev/null || true' EXIT
  rm -rf "$out" && mkdir -p "$out"
  "$checkout/build/release/demos/tandem" key new "$out/k.psk" >/dev/null
  for round in 1 2 3; do  # other programs make more difference than the flood, so in turns
    step "flood: without"
    live_pair "quiet$round" 0
    quiet_late+=("$late") quiet_grown+=("$grown") quiet_given+=("$given")
    step "flood: with $flood_rate a second"
    live_pair "flooded$round" $flood_rate
    all_late+=("$late") all_grown+=("$grown") all_given+=("$given")
  done
  late=$(median "${all_late[@]}") grown=$(median "${all_grown[@]}")
  local most_late=$(($(median "${quiet_late[@]}") + 10000)) most_grown=$(($(median "${quiet_grown[@]}") + 64))
  if (( grown > most_grown )); then
    step "flood: FAILED: memory grew by $grown kB; at most $most_grown kB"; return 1
  fi
  if (( late > most_late )); then
    step "flood: FAILED: $late of a million ticks were late; at most $most_late"; return 1
  fi
  if (( 100 * $(median "${all_given[@]}") < 99 * $(median "${quiet_given[@]}") )); then
    step "flood: FAILED: states were lost"; return 1
  fi
  step "flood: passed"
}

# All attacks at once: each takes ten minutes, and little of the processor.
attacks() {
  local attack failed=0 running=()
  trap 'kill $(jobs -p) 2>/dev/null || true' EXIT
  step "attacks: for ten minutes"
  for attack in cookies flood copies forgeries hellos; do
    python3 -B "$checkout/tests/wire/attack.py" "$checkout/build/release/demos/tandem" \
      "$checkout/demos/scenarios/experiment1.toml" "$attack" --seconds 600 --strict &
    running+=($!)
  done
  for attack in "${running[@]}"; do wait "$attack" || failed=1; done
  (( failed == 0 )) || { step "attacks: FAILED"; return 1; }
  step "attacks: passed"
}

# A million random worlds; out/soak/guest.json lists those that fail.
guest() {
  local seed=${TANDEM_GUEST_SEED:-$(date +%s)}
  step "guest: seed $seed"
  mkdir -p "$out"
  "$checkout/build/release/demos/tandem" bench guest --cases 1000000 --seed "$seed" --json >"$out/guest.json"
}

(( $# > 0 )) || set -- forged peers churn matrix flood attacks
for name in "$@"; do
  case "$name" in
    forged|peers|churn|matrix|flood|attacks|guest) ;;
    -h|--help) sed -n '2,18s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
    *) echo "soak.sh: $name: there is no such test; allowed: forged, peers, churn, matrix, flood, attacks, guest" >&2; exit 2 ;;
  esac
done
"$checkout/scripts/packages.sh" install build test
configure_preset release -DTANDEM_BUILD_TESTS=ON
build_preset release tandem_net_tests tandem_matrix_tests tandem_flood tandem tandem-bench
for name in "$@"; do
  case "$name" in
    forged) soak forged tandem_net_tests Mesh.ForgedAndReplayedDatagramsChangeNothing \
              TANDEM_FORGED_DATAGRAMS=100000000 ;;
    peers)  soak peers tandem_net_tests Soak.FourPeersOnABadNetwork TANDEM_SOAK_MINUTES=1440 ;;
    churn)  soak churn tandem_net_tests Soak.SitesComeAndGo TANDEM_CHURN_CYCLES=10000 ;;
    matrix) soak matrix tandem_matrix_tests '*ConditionMatrixTest*' TANDEM_MATRIX_CELLS=150 TANDEM_MATRIX_SEEDS=3 ;;
    flood)  flood ;;
    attacks) attacks ;;
    guest) guest ;;
  esac
done
