#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests and house checks. Runs from any folder.
#
#   scripts/test.sh [release|dev|clang|tsan|fuzz]
#
# release (the default) is optimised and has both scalar widths of Bullet, the others have float64:
# clang is optimised, dev has AddressSanitizer and UBSan, tsan runs the tests that start threads, and
# fuzz runs each fuzzer over its seeds and a fixed number of inputs.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/steps.sh"

preset=${1:-release}
groups=(build demo test)
targets=()
selection=()
case "$preset" in
  release|dev) ;;
  clang) groups+=(ci) ;;
  tsan)  groups+=(ci); targets=(tandem_thread_tests tandem_device_tests tandem_hid_tests)
         selection=(--tests-regex '^tandem_(thread|device|hid)_tests\.') ;;
  fuzz)  groups+=(ci); targets=(tandem_fuzzers); selection=(--label-regex '^fuzz$') ;;
  -h|--help) sed -n '2,9s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
  *)     echo "test.sh: $preset: no such preset; allowed: release, dev, clang, tsan, fuzz" >&2; exit 2 ;;
esac

step "Looking for packages that are missing"
"$checkout/scripts/packages.sh" install "${groups[@]}"
step "Configuring preset $preset"
configure_preset "$preset" -DTANDEM_BUILD_TESTS=ON
step "Building on $(nproc) cores"
build_preset "$preset" ${targets[@]+"${targets[@]}"}
step "Testing"
cd "$checkout"
ctest --preset "$preset" --parallel "$(nproc)" ${selection[@]+"${selection[@]}"}
step "All passed ($preset)"
