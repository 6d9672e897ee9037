#!/usr/bin/env bash
# Installs what is missing, builds the program, runs both experiments under all schemes, with two and
# more users, and the playground, analyses their stability, and draws one report. Its path is the last
# line. Runs from any folder.
#
#   scripts/demo.sh                   Bullet in double precision
#   scripts/demo.sh --float           Bullet in single precision
#   scripts/demo.sh --two-processes   both experiments live: two programs, real sockets, and the network
#                                     of the paper between them, beside the same in virtual time
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/steps.sh"

program=tandem
out="$checkout/out/demo"
live=no
case "${1:-}" in
  "")      ;;
  --two-processes) live=yes; out="$checkout/out/live" ;;
  --float) program="tandem-float"; out="$checkout/out/demo-float" ;;
  -h|--help) sed -n '2,9s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
  *)       echo "demo.sh: $1: no such option; allowed: --float, --two-processes" >&2; exit 2 ;;
esac
scenarios="$checkout/demos/scenarios"
tandem="$checkout/build/release/demos/$program"
damping_sweep=(0 0.25 0.5 1 2)   # b_dev [N s/m]; 0.5 is the scenarios' own value
all_schemes=(remote_dynamic_proxy kinematic_proxy virtual_coupling)
contact_schemes=(remote_dynamic_proxy kinematic_proxy)   # virtual coupling has no remote user to touch
runs=()
analyses=()

# run NAME SCENARIO [KEY=VALUE...]: runs once for each name, however many parts of the report use it.
run() {
  local name=$1 scenario=$2 known overrides=()
  shift 2
  for known in ${runs[@]+"${runs[@]}"}; do [[ "$known" != "$out/$name" ]] || return 0; done
  for setting in "$@"; do overrides+=(--set "$setting"); done
  "$tandem" run "$scenarios/$scenario" ${overrides[@]+"${overrides[@]}"} --out "$out/$name" --quiet
  runs+=("$out/$name")
}

# A run with the scenario's own damping has no damping in its name.
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

# list_sites N FIRST ODD EVEN: sites whose hands push by these forces [N]: that of user 1, and of the others.
list_sites() {
  local user force list="{hand_force=[$2,0,0]}"
  for ((user = 2; user <= $1; ++user)); do
    force=$((user % 2 ? $3 : $4))
    list+=",{hand_force=[$force,0,0]}"
  done
  echo "site=[$list]"
}

# User 1 pushes the cube, the others' hands are empty.
push_among_many() {   # N SCHEME MODE
  run "many-push-$1-$2-$3" experiment1_many.toml "$(list_sites "$1" 5 0 0)" "experiment.scheme=$2" \
    "coordination.mode=$3"
}

# All push on and squeeze the cube, so that nobody loses touch: this shows the drag.
move_together() {   # N SCHEME MODE
  run "many-together-$1-$2-$3" experiment1_many.toml "$(list_sites "$1" 4 4 -2)" "experiment.scheme=$2" \
    "coordination.mode=$3" "device.damping=5" "experiment.duration=2"
}

stand_in_a_row() {   # N SCHEME
  run "many-row-$1-$2" experiment2_many.toml "$(list_sites "$1" 3 0 0)" "experiment.scheme=$2"
}

# Maps and curves of growth with lasting contact. Coarser maps than usual save half of the time.
analyse() {   # NAME SCENARIO
  "$tandem" analyse "$scenarios/$2" --figures --points 40x32 --out "$out/$1" >/dev/null
  analyses+=("$out/$1")
}

# cooperate_live NAME SCENARIO DELAY_MS [KEY=VALUE...]: runs two sites with `tandem link` between them. Site 2 only
# answers, so it receives site 1 through the link.
cooperate_live() {
  local name=$1 scenario=$2 delay=$3 overrides=() link first second
  local folder="$out/$name" port=17400
  shift 3
  for setting in "$@" "network.delay=$(printf '0.%03d' "$delay")"; do overrides+=(--set "$setting"); done
  mkdir -p "$folder"
  step "$name in virtual time"
  "$tandem" run "$scenarios/$scenario" "${overrides[@]}" --out "$folder/virtual"
  step "$name live, ${delay} ms each way"
  "$tandem" link --listen "127.0.0.1:$port" --forward "127.0.0.1:$((port + 2))" --delay "${delay}ms" --quiet &
  link=$!
  local peer=("$tandem" peer --scenario "$scenarios/$scenario" "${overrides[@]}" --key "$out/key"
    --out "$folder/live" --playout off)
  "${peer[@]}" --site 2 --bind "127.0.0.1:$((port + 2))" --peer "127.0.0.1:$port" >"$folder/site2.log" 2>&1 &
  second=$!
  "${peer[@]}" --site 1 --bind "127.0.0.1:$((port + 1))" --peer "127.0.0.1:$port" >"$folder/site1.log" 2>&1 &
  first=$!
  wait "$first" && wait "$second" || { cat "$folder"/site?.log; kill "$link"; return 1; }
  kill "$link" && wait "$link" || true
  for site in 1 2; do echo "site $site:"; cat "$folder/site$site.log"; done
  runs+=("$folder/virtual" "$folder/live")
}

demonstrate_live() {
  mkdir -p "$out"
  [[ -f "$out/key" ]] || "$tandem" key new "$out/key" >/dev/null
  for scheme in "${all_schemes[@]}"; do
    cooperate_live "experiment1-$scheme" experiment1.toml 50 "experiment.scheme=$scheme"
  done
  for scheme in "${contact_schemes[@]}"; do
    cooperate_live "experiment2-$scheme-100ms" experiment2.toml 100 "experiment.scheme=$scheme"
    cooperate_live "experiment2-$scheme-200ms" experiment2.toml 200 "experiment.scheme=$scheme"
  done
  step "Drawing the figures"
  "$tandem" plot "${runs[@]}" >/dev/null
  step "Done. Open this report in a browser; the columns of both sites, live and virtual, are beside it:"
  echo "${runs[0]}/report.html"
}

prepare_release build demo view
targets=("$program")
# Elsewhere than on Debian the packages of graphics may be missing: then the report has no films.
! pkg-config --exists imgui glfw3 egl opengl || targets+=(tandem-view)
step "Building ${targets[*]} on $(nproc) cores; a few minutes the first time"
build_preset release "${targets[@]}"

if [[ $live == yes ]]; then
  demonstrate_live
  exit
fi

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

step "Three, four and eight users: one pushes, all move together, all in a row"
for users in 3 4 8; do
  for scheme in virtual_coupling remote_dynamic_proxy; do
    for mode in sum average; do
      push_among_many "$users" "$scheme" "$mode"
      move_together "$users" "$scheme" "$mode"
    done
  done
  stand_in_a_row "$users" remote_dynamic_proxy
done

step "Users come and go"
run many-come-and-go users_come_and_go.toml

if [[ -f "$scenarios/playground.toml" ]]; then
  step "The playground: a free cube among boxes, floor and gravity"
  run playground playground.toml
fi

step "Stability of both experiments: maps, and curves over delay and users"
analyse stability1 experiment1.toml
analyse stability2 experiment2.toml

step "Drawing the figures of ${#runs[@]} runs and ${#analyses[@]} analyses"
"$tandem" plot "${runs[@]}" "${analyses[@]}" >/dev/null

step "Done. Open this report in a browser:"
echo "${runs[0]}/report.html"
