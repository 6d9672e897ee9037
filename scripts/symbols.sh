#!/usr/bin/env bash
# Lists the names that the shared libraries export, demangled and sorted. Programs linked to the libraries rely on them.
#
#   scripts/symbols.sh FOLDER            prints them, library by library; FOLDER or one in it holds libtandem_*.so
#   scripts/symbols.sh --check FOLDER    compares with the lists in tests/install/symbols; 1 if a name has disappeared
#   scripts/symbols.sh --update FOLDER   writes these lists
#
# Inline functions and templates are left out, as not every compiler exports them. Both widths of Bullet share one list.
# New names do not fail a check, but it prints them: write them down with --update once they are meant to stay. A name
# that has disappeared breaks programs that were built before. It needs a new SOVERSION (the minor version, before 1.0),
# and then --update.
set -euo pipefail
export LC_ALL=C

lists=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)/tests/install/symbols
libraries=(coordination network falcon devices bullet_bridge plugin)

fail() { echo "symbols.sh: $*" >&2; exit 2; }

# names FILE: functions and data with their own definition; not class tables, which are weak in some builds only.
names() {
  nm --dynamic --defined-only --demangle "$1" | sed -n 's/^[0-9a-f]* [BDRT] \(.*\)@@.*/\1/p' |
    grep -v '^[a-z -]* \(for\|to\) tandem::' | sort -u
}

# known_names FOLDER LIBRARY: names of both widths, if there are two; they may differ only by btScalar.
known_names() {
  local file=$1/libtandem_$2.so double=$1/libtandem_$2_float64.so
  [[ -e $file ]] || file=$double
  [[ -e $file ]] || fail "$1 has no libtandem_$2.so"
  names "$file"
  if [[ -e $double && $file != "$double" ]] && ! diff <(names "$file") <(names "$double") >&2; then
    fail "libtandem_$2.so (<) and libtandem_$2_float64.so (>) show different names"
  fi
}

mode=print
case "${1:-}" in
  --check|--update) mode=${1#--}; shift ;;
esac
[[ $# == 1 && -d ${1:-} ]] || { sed -n '2,12s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2; }

folder=$(find "$1" -name 'libtandem_coordination.so' -printf '%h\n' -quit)
[[ -n $folder ]] || fail "$1 has no libtandem_coordination.so; install a build with BUILD_SHARED_LIBS=ON there"
failed=0
for library in "${libraries[@]}"; do
  list=$lists/$library.txt
  found=$(known_names "$folder" "$library")
  case "$mode" in
    print)  printf 'libtandem_%s\n%s\n\n' "$library" "$found" ;;
    update) mkdir -p "$lists"; printf '%s\n' "$found" >"$list"; echo "$(wc -l <"$list") names of $library" ;;
    check)
      gone=$(comm -23 "$list" - <<<"$found")
      new=$(comm -13 "$list" - <<<"$found")
      [[ -z $new ]] || printf 'libtandem_%s shows what is not in %s yet (take it in with --update):\n%s\n' \
        "$library" "$list" "$new"
      [[ -z $gone ]] || { printf 'libtandem_%s does not show any more:\n%s\n' "$library" "$gone"; failed=1; }
      ;;
  esac
done
if [[ $failed == 1 ]]; then
  echo "symbols.sh: names have disappeared. If that is meant, it breaks programs that were built before: raise the" \
    "minor version, note it under Breaking in CHANGELOG.md, and run scripts/symbols.sh --update $1" >&2
fi
[[ $mode != check || $failed == 1 ]] || echo "All names are there."
exit "$failed"
