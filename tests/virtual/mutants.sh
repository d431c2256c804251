#!/usr/bin/env bash
# How many defects the virtual runs alone detect: each line of mutants.txt runs through mutants_runs.txt until
# one of them breaks an invariant that the sound brain holds there, including those that are otherwise only
# counted. Holds there: under four times as many seeds, so that a defect is not detected by what any other
# course of events would have shown. What one line of defence hides shows without it: a run of the base
# "agreement" is without claims and echoes, as in defects.sh. What costs or saves no more than time breaks no
# invariant: a defect that survives these runs is detected where a mean of bounds.txt leaves its bounds, which
# the sound brain kept in every draw of the radio that was tried. A line "detected" or "survived" each, and the sums.
# Exit code 0: at least --least of them were detected; 1: fewer; 2: could not run.
# Usage: mutants.sh [--least N] [--jobs J] [NAME ...]
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
program=${GIVEWAY_BIN:-$root/build/release/bin}/fleetctl_mutants
bounds=$here/bounds.txt
# shellcheck source=tests/virtual/figures.sh
source "$here/figures.sh"
least=0 jobs=$(nproc)

usage() {
  sed -n '10s/^# //p' "${BASH_SOURCE[0]}" >&2
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

# moved MUTANT LINE: the figures that the run of bounds.txt brings outside, on one line; nothing if none.
moved() {
  local -a words
  local now
  read -ra words <<<"$2"
  now=$({ GIVEWAY_MUTANT=$1 "$program" virtual "${words[@]}" --jobs "$jobs" --json </dev/null || true; } | figures) ||
    now="no_result 1"
  outside "$(bounds_of "$bounds" "$2")" "$now" | paste -sd ';'
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

bounded=()
while read -r word line; do
  [[ $word == run ]] || continue
  bounded+=("$line")
  off=$(moved "" "$line")
  echo "sound     bounds, $line: ${off:-all inside}"
  [[ -z $off ]] || exit 2
done <"$bounds"

# by_invariant MUTANT: what it breaks, and the run; nothing if it breaks nothing new.
by_invariant() {
  local i new
  local -a words
  for i in "${!runs[@]}"; do
    read -ra words <<<"${runs[i]}"
    new=$(comm -13 <(echo "${sound[i]}") <(broken "$1" "${words[@]}") | sed '/^$/d' | tr '\n' ' ')
    [[ -n $new ]] || continue
    echo "${new}by ${runs[i]##*/}"
    return
  done
}

# by_bound MUTANT: the figures outside, and the run; nothing if all are inside.
by_bound() {
  local line off
  for line in "${bounded[@]}"; do
    off=$(moved "$1" "$line")
    [[ -n $off ]] || continue
    echo "$off, by $line"
    return
  done
}

broke=0 left=0 tried=0
wanted=" $* "
while read -r name _; do
  [[ $wanted == "  " || $wanted == *" $name "* ]] || continue
  tried=$((tried + 1))
  by=$(by_invariant "$name")
  if [[ -n $by ]]; then
    broke=$((broke + 1))
  else
    by=$(by_bound "$name")
    [[ -z $by ]] || left=$((left + 1))
  fi
  echo "$([[ -n $by ]] && echo detected || echo survived)  $name: ${by:-nothing new}"
done < <(grep -E '^[a-z_]+ +[|]' "$here/mutants.txt")
echo "$((broke + left)) of $tried detected, $broke by an invariant and $left by a bound"
[[ $((broke + left)) -ge $least ]]
