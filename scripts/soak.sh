#!/usr/bin/env bash
# The long tests of the network, in virtual time; minutes of a machine each. scripts/test.sh runs a slice of them.
#
#   scripts/soak.sh [forged|peers|churn]...     all three when none is named
#
# forged: 1e8 forged, changed, cut, replayed and random datagrams at a live pair. peers: four sites for 24 hours with 1 s delay,
# 100 ms jitter, a quarter lost and a quarter twice. churn: 10,000 times a site leaves, is killed or gets another port.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/steps.sh"

# soak NAME TEST VARIABLE VALUE
soak() {
  local start=$SECONDS
  step "$1: $3=$4"
  env "$3=$4" "$checkout/build/release/tests/tandem_net_tests" --gtest_brief=1 --gtest_filter="$2"
  step "$1: passed in $((SECONDS - start)) s"
}

(( $# > 0 )) || set -- forged peers churn
for name in "$@"; do
  case "$name" in
    forged|peers|churn) ;;
    -h|--help) sed -n '2,8s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
    *) echo "soak.sh: $name: there is no such test; allowed: forged, peers, churn" >&2; exit 2 ;;
  esac
done
"$checkout/scripts/packages.sh" install build test
configure_preset release -DTANDEM_BUILD_TESTS=ON
build_preset release tandem_net_tests
for name in "$@"; do
  case "$name" in
    forged) soak forged Mesh.ForgedAndReplayedDatagramsChangeNothing TANDEM_FORGED_DATAGRAMS 100000000 ;;
    peers)  soak peers Soak.FourPeersOnABadNetwork TANDEM_SOAK_MINUTES 1440 ;;
    churn)  soak churn Soak.SitesComeAndGo TANDEM_CHURN_CYCLES 10000 ;;
  esac
done
