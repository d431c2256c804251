#!/usr/bin/env bash
# Plants every defect of services/vehicle/planted.h, one at a time, and sees it caught by an
# invariant of the virtual fleet. Each line of defects.txt names a defect, the invariants of which
# one at least must break, and the run that shows it. Without a defect the same run must pass, and
# end in the same hash as the product's. A line "ok" or "FAILED" each.
# Exit code 0: every defect was caught; 1: one was not, or is not in the table; 2: could not run.
# Usage: defects.sh [DEFECT ...]
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
bin=${GIVEWAY_BIN:-$root/build/release/bin}
jobs=$(nproc)
failed=0
for program in fleetctl fleetctl_planted; do
  [[ -x $bin/$program ]] || { echo "defects.sh: $bin/$program is not built" >&2 && exit 2; }
done

# report PASSED TEXT: one line.
report() {
  if "$1"; then
    echo "ok      $2"
  else
    echo "FAILED  $2"
    failed=1
  fi
}

# outcome PROGRAM ARGUMENTS: the JSON of one batch; empty if it could not be run.
outcome() {
  local program=$1
  shift
  "$bin/$program" virtual "$@" --jobs "$jobs" --json 2>/dev/null </dev/null || true
}

# The invariants a batch broke, each with a space behind it; "none " where all held.
broken() { jq -r '[.violations | to_entries[] | select(.value > 0).key + " "] | add // "none "'; }

# sound ARGUMENTS: nothing breaks where nothing is planted.
sound() {
  local product planted
  product=$(outcome fleetctl "$@")
  planted=$(outcome fleetctl_planted "$@")
  if jq -e -n --argjson a "${product:-0}" --argjson b "${planted:-1}" \
    '$a.verdict == "passed" and $b.verdict == "passed" and $a.hash == $b.hash' >/dev/null 2>&1; then
    report true "nothing planted: $*"
  else
    report false "nothing planted: $*"
  fi
}

# caught DEFECT INVARIANTS ARGUMENTS: one of the invariants, given with commas between, breaks.
caught() {
  local defect=$1 expected=$2 names invariant is_caught=false
  shift 2
  names=$(GIVEWAY_DEFECT=$defect outcome fleetctl_planted "$@" | broken)
  for invariant in ${expected//,/ }; do
    [[ " $names" != *" $invariant "* ]] || is_caught=true
  done
  report "$is_caught" "$defect: ${names:-no result }by $*"
}

declare -A known_sound=()
declare -A tried=()
wanted=" $* "
while read -r defect expected arguments; do
  [[ -n $defect && $defect != \#* ]] || continue
  tried[$defect]=1
  [[ $wanted == "  " || $wanted == *" $defect "* ]] || continue
  read -ra words <<<"$arguments"
  if [[ -z ${known_sound[$arguments]:-} ]]; then
    known_sound[$arguments]=1
    sound "${words[@]}"
  fi
  caught "$defect" "$expected" "${words[@]}"
done <"$here/defects.txt"

# A defect without a line is one that nobody looks for.
while read -r defect; do
  [[ -n ${tried[$defect]:-} ]] || report false "$defect: has no line in defects.txt"
done < <(sed -n 's/^ *{"\([a-z_]*\)", Defect::k.*/\1/p' "$here/planted_main.cc")
exit "$failed"
