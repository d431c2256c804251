#!/usr/bin/env bash
# How many defects the virtual runs alone detect: each line of mutants.txt runs through mutants_runs.txt until
# one of them breaks an invariant that the sound brain holds there, including those that are otherwise only
# counted. Holds there: under four times as many seeds, so that a defect is not detected by what any other
# course of events would have shown. What one line of defence hides shows without it: a run of the base
# "agreement" is without claims and echoes, as in defects.sh. A line "detected" or "survived" each, and the
# sum.
# Exit code 0: at least --least of them were detected; 1: fewer; 2: could not run.
# Usage: mutants.sh [--least N] [--jobs J] [NAME ...]
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
program=${GIVEWAY_BIN:-$root/build/release/bin}/fleetctl_mutants
least=0 jobs=$(nproc)

usage() {
  sed -n '9s/^# //p' "${BASH_SOURCE[0]}" >&2
  exit 2
}

while [[ ${1:-} == --* ]]; do
  [[ $# -ge 2 && $2 =~ ^[0-9]+$ ]] || usage
  case $1 in
    --least) least=$2 ;;
    --jobs) jobs=$2 ;;
    *) usage ;;
  esac
  shift 2
done
[[ -x $program ]] || { echo "mutants.sh: $program is not built" >&2 && exit 2; }

declare -rA taken_away=([all]="" [agreement]="claim_ignored,obstacle_ignored")

# broken MUTANT BASE WORDS: the invariants that the run breaks, one a line, sorted; "no_result" where it
# could not be run.
broken() {
  local mutant=$1 base=$2 outcome
  shift 2
  outcome=$(GIVEWAY_MUTANT=$mutant GIVEWAY_DEFECT=${taken_away[$base]} \
    "$program" virtual "$@" --jobs "$jobs" --json </dev/null) || true
  jq -er 'select(.verdict != "not_run") | .violations | [to_entries[] | select(.value > 0).key] |
    join("\n")' <<<"$outcome" 2>/dev/null | sort || echo no_result
}

# more WORDS: the same with four times the seeds.
more() {
  local -a words=("$@")
  local i
  for i in "${!words[@]}"; do
    [[ ${words[i]} =~ ^([0-9]+)\.\.([0-9]+)$ && ${words[i - 1]} == --seeds ]] || continue
    words[i]=${BASH_REMATCH[1]}..$((BASH_REMATCH[1] + 4 * (BASH_REMATCH[2] - BASH_REMATCH[1] + 1) - 1))
  done
  echo "${words[@]}"
}

runs=() sound=()
while read -r base line; do
  [[ -n $base && $base != \#* ]] || continue
  read -ra words <<<"$line"
  [[ ! -f $here/scenarios/${words[0]}.textproto ]] || words[0]=$here/scenarios/${words[0]}.textproto
  runs+=("$base ${words[*]}")
  read -ra four <<<"$(more "${words[@]}")"
  sound+=("$(broken "" "$base" "${four[@]}")")
  echo "sound     $base, $line: $(tr '\n' ' ' <<<"${sound[-1]:-all held}")"
  [[ ${sound[-1]} != *no_result* ]] || exit 2
done <"$here/mutants_runs.txt"

detected=0 tried=0
wanted=" $* "
while read -r name _; do
  [[ $wanted == "  " || $wanted == *" $name "* ]] || continue
  tried=$((tried + 1))
  by=""
  for i in "${!runs[@]}"; do
    read -ra words <<<"${runs[i]}"
    new=$(comm -13 <(echo "${sound[i]}") <(broken "$name" "${words[@]}") | sed '/^$/d' | tr '\n' ' ')
    [[ -n $new ]] || continue
    by="$new by ${runs[i]##*/}"
    break
  done
  [[ -z $by ]] || detected=$((detected + 1))
  echo "$([[ -n $by ]] && echo detected || echo survived)  $name: ${by:-nothing new}"
done < <(grep -E '^[a-z_]+ +[|]' "$here/mutants.txt")
echo "$detected of $tried detected"
[[ $detected -ge $least ]]
