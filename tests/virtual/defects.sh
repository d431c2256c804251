#!/usr/bin/env bash
# Injects every defect of services/vehicle/estimation/injected_mutants.h, and checks that an invariant of the virtual
# fleet detects it. Each line of defects.txt names a defect, the lines of defence that remain, the invariants of
# which at least one must break, and the run that shows it: a generator, a shipped scenario, or one of the
# folder scenarios. Without the defect the same run must pass, and with all lines of defence end in the same
# hash as the product's. A line "ok" or "FAILED" each.
# Exit code 0: every defect was detected; 1: one was not, or has no line; 2: could not run.
# Usage: defects.sh [DEFECT ...]
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
bin=${GIVEWAY_BIN:-$root/build/release/bin}
jobs=$(nproc)
failed=0
# What is taken away, so that only the base named stands.
declare -A taken_away=(
  [all]=""
  [agreement]="claim_ignored,obstacle_ignored"
  [claims]="second_drives_on,through_first_guessed"
)
for program in fleetctl fleetctl_with_defects; do
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

# sound BASE ARGUMENTS: all invariants hold; the product makes the same run.
sound() {
  local base=$1 injected product
  shift
  injected=$(GIVEWAY_DEFECT=${taken_away[$base]} outcome fleetctl_with_defects "$@")
  product=$injected
  [[ $base != all ]] || product=$(outcome fleetctl "$@")
  if jq -e -n --argjson a "${injected:-0}" --argjson b "${product:-1}" \
    '$a.verdict == "passed" and $a.hash == $b.hash' >/dev/null 2>&1; then
    report true "no defect, $base: all held by ${*##*/}"
  else
    report false "no defect, $base: $(broken <<<"$injected")by ${*##*/}"
  fi
}

# detected DEFECT BASE INVARIANTS ARGUMENTS: one of the invariants, separated by commas, breaks.
detected() {
  local defect=$1 base=$2 expected=$3 names invariant is_detected=false
  shift 3
  names=$(GIVEWAY_DEFECT=$defect,${taken_away[$base]} outcome fleetctl_with_defects "$@" | broken)
  for invariant in ${expected//,/ }; do
    [[ " $names" != *" $invariant "* ]] || is_detected=true
  done
  report "$is_detected" "$defect, $base: ${names:-no result }by ${*##*/}"
}

declare -A known_sound=() tried=()
wanted=" $* "
while read -r defect base expected scenario arguments; do
  [[ -n $defect && $defect != \#* ]] || continue
  tried[$defect]=1
  [[ $wanted == "  " || $wanted == *" $defect "* ]] || continue
  [[ ! -f $here/scenarios/$scenario.textproto ]] || scenario=$here/scenarios/$scenario.textproto
  read -ra words <<<"$scenario $arguments"
  if [[ -z ${known_sound[$base ${words[*]}]:-} ]]; then
    known_sound[$base ${words[*]}]=1
    sound "$base" "${words[@]}"
  fi
  detected "$defect" "$base" "$expected" "${words[@]}"
done <"$here/defects.txt"

# A defect without a line would never be tested.
while read -r defect; do
  [[ -n ${tried[$defect]:-} ]] || report false "$defect: has no line in defects.txt"
done < <(sed -n 's/^ *{"\([a-z_]*\)", Mutant::k.*/\1/p' "$root/tests/support/mutant_names.h")
exit "$failed"
