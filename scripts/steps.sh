# shellcheck shell=bash
# For scripts that announce what they do: sourced, not run. Sets $checkout, the project's folder.
unset CDPATH
checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
SECONDS=0
export NINJA_STATUS="[%f/%t, %e s] "

# step TEXT: prints a line with the seconds since the script began.
step() { printf '[%4d s] %s\n' "$SECONDS" "$*"; }

# configure_preset PRESET [OPTION...]: configures a preset; starts afresh if another checkout made the build folder.
configure_preset() {
  local preset=$1 options=("${@:2}")
  local cache="$checkout/build/$preset/CMakeCache.txt" log="$checkout/build/$preset.log"
  if [[ -f "$cache" ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$checkout" "$cache"; then
    options+=(--fresh)
  fi
  mkdir -p "$checkout/build"
  if ! (cd "$checkout" && cmake --preset "$preset" ${options[@]+"${options[@]}"} >"$log" 2>&1); then
    cat "$log" >&2
    return 1
  fi
}

# build_preset PRESET [TARGET...]: builds these targets, or all.
build_preset() {
  local preset=$1
  shift
  (cd "$checkout" && cmake --build --preset "$preset" --parallel "$(nproc)" ${1:+--target "$@"})
}

# prepare_release GROUP...: installs the groups' packages and configures release for somebody who wants no tests. If the
# tests' packages are installed, the build folder stays usable for test.sh.
prepare_release() {
  local tests=ON
  step "Looking for packages that are missing"
  "$checkout/scripts/packages.sh" install "$@"
  step "Configuring the build"
  [[ -z "$("$checkout/scripts/packages.sh" missing import test)" ]] || tests=OFF
  configure_preset release "-DTANDEM_BUILD_TESTS=$tests"
}
