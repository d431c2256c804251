#!/usr/bin/env bash
# Checks what a compiler does not: which module may include which (modules.txt), that neither modules
# nor files include each other in a circle, that the pure modules know no thread and no clock, and
# that files and folders stay small and named after an idea.
# Usage: include_rules.sh [ROOT]; a line for each violation; exit code 1 if there is one.
set -euo pipefail
rules=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=${1:-$(cd "$rules/../.." && pwd)}
cd "$root"

mapfile -t files < <(find . -path ./build -prune -o -path ./.git -prune -o -name node_modules -prune -o \
  -type f \( -name '*.h' -o -name '*.cc' -o -name '*.inc' \) -print | sed 's,^\./,,' | sort)

report=$(awk -f "$rules/include_rules.awk" "$rules/modules.txt" "${files[@]}")
arrows() { sed -n "s/^$1 //p" <<<"$report"; }
violations=$(arrows violation)

# tsort names the members of each circle it finds.
circles() {
  local loops
  loops=$(arrows "$1" | tsort 2>&1 >/dev/null | sed -n 's/^tsort: //p' | grep -v 'contains a loop' |
    tr '\n' ' ') || true
  [[ -z $loops ]] || printf 'circle of %ss: %s\n' "$1" "$loops"
}
violations+=$(circles module | sed '1s/^/\n/')
violations+=$(circles file | sed '1s/^/\n/')

violations=$(sed '/^$/d' <<<"$violations")
[[ -z $violations ]] || printf '%s\n' "$violations"
count=$(grep -c . <<<"$violations" || true)
printf '%d files, %d violations\n' "${#files[@]}" "$count"
[[ $count -eq 0 && ${#files[@]} -gt 0 ]]
