#!/usr/bin/env bash
# Lays out all C++ sources by .clang-format, in place; with --check only says which lines differ.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/steps.sh"

case "${1:-}" in
  "")      mode=(-i) ;;
  --check) mode=(--dry-run -Werror) ;;
  *)       echo "format.sh: $1: no such option; allowed: --check" >&2; exit 2 ;;
esac
"$checkout/scripts/packages.sh" install ci
cd "$checkout"
find coordination bullet_bridge falcon plugin demos bench tests \( -name '*.h' -o -name '*.cpp' \) -print0 |
  xargs -0 -n 16 -P "$(nproc)" clang-format "${mode[@]}"
