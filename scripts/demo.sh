#!/usr/bin/env bash
# Installs what is missing, builds the program, runs both experiments under all schemes and the
# playground, and draws one report. Its path is the last line. Runs from any folder.
#
#   scripts/demo.sh           Bullet in double precision
#   scripts/demo.sh --float   Bullet in single precision
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/steps.sh"

program=tandem
out="$checkout/out/demo"
case "${1:-}" in
  "")      ;;
  --float) program="tandem-float"; out="$checkout/out/demo-float" ;;
  -h|--help) sed -n '2,6s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
  *)       echo "demo.sh: $1: no such option; allowed: --float" >&2; exit 2 ;;
esac
scenarios="$checkout/demos/scenarios"
tandem="$checkout/build/release/demos/$program"
damping_sweep=(0 0.25 0.5 1 2)   # b_dev [N s/m]; 0.5 is the scenarios' own value
all_schemes=(remote_dynamic_proxy kinematic_proxy virtual_coupling)
contact_schemes=(remote_dynamic_proxy kinematic_proxy)   # virtual coupling has no remote user to touch
runs=()

# run NAME SCENARIO [KEY=VALUE...]: once for each name, however many parts of the report need it.
run() {
  local name=$1 scenario=$2 known overrides=()
  shift 2
  for known in ${runs[@]+"${runs[@]}"}; do [[ "$known" != "$out/$name" ]] || return 0; done
  for setting in "$@"; do overrides+=(--set "$setting"); done
  "$tandem" run "$scenarios/$scenario" ${overrides[@]+"${overrides[@]}"} --out "$out/$name" --quiet
  runs+=("$out/$name")
}

# The run with a scenario's own damping has no damping in its name.
damping_suffix() { [[ "$1" == 0.5 ]] || echo "-damping-$1"; }

cooperate() {   # SCHEME B_DEV
  run "experiment1-$1$(damping_suffix "$2")" experiment1.toml "experiment.scheme=$1" "device.damping=$2"
}

touch_user() {   # SCHEME STIFFNESS DELAY_MS B_DEV
  local delay
  delay=$(printf '0.%03d' "$3")
  run "experiment2-$1-$2N-$3ms$(damping_suffix "$4")" experiment2.toml "experiment.scheme=$1" \
    "contact.stiffness=$2" "network.delay=$delay" "device.damping=$4"
}

step "Looking for packages that are missing"
"$checkout/scripts/packages.sh" install build demo

step "Configuring the build"
# The tests' packages are not needed here; where they are, the build folder stays good for test.sh.
tests=ON
[[ -z "$("$checkout/scripts/packages.sh" missing test)" ]] || tests=OFF
configure_preset release "-DTANDEM_BUILD_TESTS=$tests"
step "Building $program on $(nproc) cores; a few minutes the first time"
build_preset release "$program"

mkdir -p "$out"
step "Experiment I: two users and one cube, three schemes"
for scheme in "${all_schemes[@]}"; do cooperate "$scheme" 0.5; done

step "Experiment II: one user pushes the other, two schemes, three settings"
for scheme in "${contact_schemes[@]}"; do
  touch_user "$scheme" 2000 100 0.5
  touch_user "$scheme" 2000 200 0.5
  touch_user "$scheme" 4000 100 0.5
done

step "Both experiments again over the devices' damping: ${damping_sweep[*]} N s/m"
for b_dev in "${damping_sweep[@]}"; do
  for scheme in "${all_schemes[@]}"; do cooperate "$scheme" "$b_dev"; done
  for scheme in "${contact_schemes[@]}"; do touch_user "$scheme" 2000 100 "$b_dev"; done
done

if [[ -f "$scenarios/playground.toml" ]]; then
  step "The playground: a free cube among boxes, floor and gravity"
  run playground playground.toml
fi

step "Drawing the figures of ${#runs[@]} runs"
"$tandem" plot "${runs[@]}" >/dev/null

step "Done. Open this report in a browser:"
echo "${runs[0]}/report.html"
