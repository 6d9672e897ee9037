#!/usr/bin/env bash
# The long tests of the network, in virtual time; minutes of a machine each. scripts/test.sh runs a slice of them.
#
#   scripts/soak.sh [forged|peers|churn|matrix]...     all four when none is named
#
# forged: 1e8 forged, changed, cut and replayed datagrams at a live pair. peers: four sites for 24 hours with 1 s delay,
# 100 ms jitter, a quarter lost and a quarter twice. churn: 10,000 times a site leaves, is killed or gets another port.
# matrix: two sites with worlds and devices under 150 conditions of the network, three times each, with an outage.
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

(( $# > 0 )) || set -- forged peers churn matrix
for name in "$@"; do
  case "$name" in
    forged|peers|churn|matrix) ;;
    -h|--help) sed -n '2,9s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
    *) echo "soak.sh: $name: there is no such test; allowed: forged, peers, churn, matrix" >&2; exit 2 ;;
  esac
done
"$checkout/scripts/packages.sh" install build test
configure_preset release -DTANDEM_BUILD_TESTS=ON
build_preset release tandem_net_tests tandem_matrix_tests
for name in "$@"; do
  case "$name" in
    forged) soak forged tandem_net_tests Mesh.ForgedAndReplayedDatagramsChangeNothing \
              TANDEM_FORGED_DATAGRAMS=100000000 ;;
    peers)  soak peers tandem_net_tests Soak.FourPeersOnABadNetwork TANDEM_SOAK_MINUTES=1440 ;;
    churn)  soak churn tandem_net_tests Soak.SitesComeAndGo TANDEM_CHURN_CYCLES=10000 ;;
    matrix) soak matrix tandem_matrix_tests '*ConditionMatrixTest*' TANDEM_MATRIX_CELLS=150 TANDEM_MATRIX_SEEDS=3 ;;
  esac
done
