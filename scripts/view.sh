#!/usr/bin/env bash
# Installs what is missing, builds the window, and shows a live world in it. Runs from any folder.
#
#   scripts/view.sh                    the world crate, with the mouse in your hand
#   scripts/view.sh touch [OPTION...]  another world, and the options of `tandem view`
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/steps.sh"

case "${1:-}" in
  -h|--help) sed -n '2,5s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
esac

prepare_release build view import
step "Building the window on $(nproc) cores; a few minutes the first time"
build_preset release tandem tandem-view

step "Escape ends the window, F1 is help"
exec "$checkout/build/release/demos/tandem" view "$@"
