#!/usr/bin/env bash
# How many defects the virtual runs alone catch: each line of mutants.txt runs through mutants_runs.txt
# until one of them breaks an invariant that the sound brain holds there, those that are else only
# counted included. A line "caught" or "survived" each, and the sum.
# Exit code 0: at least --least of them were caught; 1: fewer; 2: could not run.
# Usage: mutants.sh [--least N] [--jobs J] [NAME ...]
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
program=${GIVEWAY_BIN:-$root/build/release/bin}/fleetctl_mutants
least=0 jobs=$(nproc)

usage() {
  sed -n '6s/^# //p' "${BASH_SOURCE[0]}" >&2
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

# broken MUTANT WORDS: the invariants that the run breaks, one a line, sorted.
broken() {
  local mutant=$1 outcome
  shift
  outcome=$(GIVEWAY_MUTANT=$mutant "$program" virtual "$@" --jobs "$jobs" --json </dev/null) || [[ $? == 1 ]]
  jq -r '.violations | to_entries[] | select(.value > 0).key' <<<"$outcome" | sort
}

runs=() sound=()
while read -r line; do
  [[ -n $line && $line != \#* ]] || continue
  read -ra words <<<"$line"
  [[ ! -f $here/scenarios/${words[0]}.textproto ]] || words[0]=$here/scenarios/${words[0]}.textproto
  runs+=("${words[*]}")
  sound+=("$(broken "" "${words[@]}")")
  echo "sound     $line: $(tr '\n' ' ' <<<"${sound[-1]:-all held}")"
done <"$here/mutants_runs.txt"

caught=0 tried=0
wanted=" $* "
while read -r name _; do
  [[ $wanted == "  " || $wanted == *" $name "* ]] || continue
  tried=$((tried + 1))
  by=""
  for i in "${!runs[@]}"; do
    read -ra words <<<"${runs[i]}"
    new=$(comm -13 <(echo "${sound[i]}") <(broken "$name" "${words[@]}") | tr '\n' ' ')
    [[ -n $new ]] || continue
    by="$new by ${runs[i]##*/}"
    break
  done
  [[ -z $by ]] || caught=$((caught + 1))
  echo "$([[ -n $by ]] && echo caught || echo survived)  $name: ${by:-nothing new}"
done < <(grep -E '^[a-z_]+ +[|]' "$here/mutants.txt")
echo "$caught of $tried caught"
[[ $caught -ge $least ]]
