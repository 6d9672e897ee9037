#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests and house checks. Runs from any folder.
#
#   scripts/test.sh [release|dev|tsan|fuzz|install]
#
# release (the default) is optimised and has both scalar widths of Bullet, the others have float64:
# dev has AddressSanitizer and UBSan and leaves long simulations out, tsan runs the tests that start threads, and
# fuzz runs each fuzzer over its seeds and a fixed number of inputs. install installs the libraries of release
# and shared ones, and builds other people's projects on them; as root it also installs the Debian packages.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/steps.sh"

# Minutes of one motion under a sanitizer, whose code shorter tests run too. Release runs them in both widths.
long_simulations='NotWithAHandAloneInTheHeap|BulletsExample.GetsNoEnergy|PegInHole|PlanarReferenceInBullet'
long_simulations+='|GuestBench.HardlyAnything|Model.AgreesForParameters|JointsForAMinute|ArmsAtRates.AFreeArm|BenchSpeed'
long_simulations+='|GodObject.RandomPath|GuardsOfTheExperiments|EachWorld.TellsItsStory|AveragePosition|SpringOfAHost'
long_simulations+='|Room.ManyAtRest|Room.ABudget|PlanarReferenceConverges/(row16|tower9)|BenchStress|BenchLimits'
long_simulations+='|BenchAccuracy.BodiesInJoints|FrozenContact.Agrees|LoneHandAtAWall.*Whatever|BulletsPile'
long_simulations+='|Analyse.(AnyPacketRate|TakesUsers|TellsModes|SaysInWords)|AnalyseFigures|SafeCoordination|Advice.IsWhat'

preset=${1:-release}
groups=(build demo view import dds test)
targets=()
options=(-DTANDEM_BUILD_TESTS=ON)
selection=()
case "$preset" in
  release) groups+=(hosts) ;;
  dev) groups+=(ci); options+=("-DTANDEM_LEAVE_OUT=$long_simulations")
       export TANDEM_GUEST_WORLDS=10 TANDEM_DOOR_WORLDS=20 TANDEM_PYBULLET_WORLDS=20 ;;  # of 30, 100, 100
  tsan)  groups+=(ci); targets=(tandem_thread_tests tandem_device_tests tandem_hid_tests)
         selection=(--tests-regex '^tandem_(thread|device|hid)_tests\.') ;;
  fuzz)  groups+=(ci); targets=(tandem_fuzzers); selection=(--label-regex '^fuzz$') ;;
  install) groups+=(ci package); targets=(tandem tandem-float tandem_pybullet tandem_preload
             tandem_preload_float tandem_preload_float64) ;;
  -h|--help) sed -n '2,10s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
  *)     echo "test.sh: $preset: no such preset; allowed: release, dev, tsan, fuzz, install" >&2; exit 2 ;;
esac

step "Looking for packages that are missing"
"$checkout/scripts/packages.sh" install "${groups[@]}"

# build PRESET [OPTION...]: configures it, and builds the chosen targets.
build() {
  step "Configuring preset $1"
  configure_preset "$@"
  step "Building on $(nproc) cores"
  build_preset "$1" ${targets[@]+"${targets[@]}"}
}

if [[ "$preset" == install ]]; then
  build release "${options[@]}"
  targets=()
  build install
  step "Testing"
  cmake -S "$checkout/tests/install" -B "$checkout/build/install_tests" -G Ninja >"$checkout/build/install_tests.log" \
    "-DTANDEM_STATIC=$checkout/build/release" "-DTANDEM_SHARED=$checkout/build/install"
  ctest --test-dir "$checkout/build/install_tests" --output-on-failure --parallel "$(nproc)"
else
  build "$preset" "${options[@]}"
  step "Testing"
  cd "$checkout"
  ctest --preset "$preset" --parallel "$(nproc)" ${selection[@]+"${selection[@]}"}
fi
step "All passed ($preset)"
