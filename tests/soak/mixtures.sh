#!/usr/bin/env bash
# Soaks under few kinds of faults instead of all: each class of faults alone (classes.txt), forty times as
# frequent as in everything.textproto, or three of its rules drawn by seed, ten times. A line each: what
# happened, the verdict, how many contacts. Expected is no contact, and that every fault acted: exit code 0
# if so, 1 if not, 2 if it could not run. Other broken invariants are printed, and do not fail it.
# Usage: mixtures.sh [--virtual] [--duration S] classes [CLASS ...]
#        mixtures.sh [--virtual] [--duration S] combinations FIRST..LAST
# Real processes need root for shared memory and intruders, and a machine that is not busy. SCENARIO
# (warehouse_loop) and VEHICLES (8) may be set.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
here=$(dirname "${BASH_SOURCE[0]}")
SCENARIO=${SCENARIO:-warehouse_loop}
VEHICLES=${VEHICLES:-8}
export GIVEWAY_CONFIG_DIR=${GIVEWAY_CONFIG_DIR:-$REPOSITORY/config}
everything=$GIVEWAY_CONFIG_DIR/faults/everything.textproto
duration_s=90
frequency=10
options=()
virtual=false
with_attacker=()
[[ ! -x $(dirname "$FLEETCTL")/attacker ]] || with_attacker=(--attacker "$(dirname "$FLEETCTL")/attacker")

usage() { sed -n 's/^# \(Usage: \|       \)\(mixtures.sh\)/\2/p' "${BASH_SOURCE[0]}" >&2 && exit 2; }

# Rules more frequent than in half an hour of everything, and as many as come.
frequent() {
  awk -v frequency="$frequency" '{
    if (match($0, /mean_between_s: [0-9.]+/)) {
      mean = substr($0, RSTART + 16, RLENGTH - 16) / frequency
      if (mean < 8) mean = 8
      $0 = substr($0, 1, RSTART + 15) mean substr($0, RSTART + RLENGTH)
    }
    sub(/ at_most: [0-9]+/, "")
    print
  }'
}

# What report.json says, in a line.
summary() {
  jq -r '
    ([.violations[].invariant] | group_by(.) | map("\(.[0]) \(length)") | join(", ")) as $broken
    | "\(.verdict); faults \(.faults | length), seen \([.faults[] | select(.observed)] | length)"
      + ", contacts \([.violations[] | select(.invariant == "contact")] | length)"
      + if $broken == "" then "" else "; broken: \($broken)" end
      + if .skipped_counted == 0 then "" else "; left out \(.skipped_counted)" end' "$1"
}

holds() {
  jq -e '.verdict != "not_run" and (.faults | all(.observed or .observed_how != ""))
    and ([.violations[] | select(.invariant == "contact")] | length == 0)' "$1" >/dev/null
}

# run NAME SEED [SOAK OPTIONS] with the rules on standard input.
run() {
  local name=$1 seed=$2 folder=$SCRATCH/$1 word=ok
  shift 2
  mkdir -p "$folder"
  { printf '\ndescription: "%s"\n' "$name" && frequent; } >"$folder/faults.textproto"
  "$FLEETCTL" soak "$SCENARIO" --vehicles "$VEHICLES" --faults "$folder/faults.textproto" --seed "$seed" \
    --skip-unsupported --report "$folder/report" --json --duration "$duration_s" "${options[@]}" "$@" \
    >"$folder/report.json" 2>"$folder/log" || true
  if [[ ! -s $folder/report.json ]]; then
    echo "FAILED  $name: $(tail -n 1 "$folder/log")"
    failures=$((failures + 1))
    return
  fi
  if ! holds "$folder/report.json"; then
    word=FAILED
    failures=$((failures + 1))
  elif [[ $(jq '.faults | length' "$folder/report.json") -eq 0 ]]; then
    word=none # of these faults virtual time has none, or none came
  fi
  printf '%-7s %s: %s\n' "$word" "$name" "$(summary "$folder/report.json")"
}

# rules_of CLASS NAME...: rules of everything.textproto by name, and those that classes.txt adds.
rules_of() {
  local class=$1 name
  shift
  for name in "$@"; do awk -v name="name: \"$name\"" 'index($0, name)' "$everything"; done
  sed -n "s/^#$class //p" "$here/classes.txt"
}

classes() {
  local row class places given rules all="$*"
  frequency=40 # so that each class comes, however rare
  mapfile -t rows <"$here/classes.txt"
  for row in "${rows[@]}"; do
    [[ -n $row && $row != \#* ]] || continue
    IFS='|' read -r class _ places given rules <<<"$row"
    read -r class <<<"$class"
    [[ -z $all || " $all " == *" $class "* ]] || continue
    read -ra given <<<"$given"
    read -ra rules <<<"$rules"
    [[ ${given[0]} != - ]] || given=()
    given+=("${with_attacker[@]}")
    if $virtual; then
      [[ $places == *virtual* ]] || continue
      given=()
    fi
    rules_of "$class" "${rules[@]}" | run "$class" 1 "${given[@]}"
  done
}

# Three rules by the seed, the same on every machine.
combination() {
  awk -v seed="$1" '
    function draw(n) { state = (state * 69069 + 1) % 4294967296; return int(state / 65536) % n }
    /^random/ { rule[rules++] = $0 }
    END {
      state = seed * 7919 + 12345
      for (i = 0; i < 5; ++i) draw(1)
      for (i = 0; i < 3; ++i) {
        at = i + draw(rules - i)
        chosen = rule[at]; rule[at] = rule[i]; rule[i] = chosen
        print chosen
      }
    }' "$everything"
}

combinations() {
  local seed rules names given=("${with_attacker[@]}")
  ! $virtual || given=()
  for ((seed = $1; seed <= $2; ++seed)); do
    rules=$(combination "$seed")
    names=$(sed -n 's/.*name: "\([^"]*\)".*/\1/p' <<<"$rules" | paste -sd+)
    run "$seed-$names" "$seed" "${given[@]}" <<<"$rules"
  done
}

while [[ ${1:-} == --* ]]; do
  case $1 in
    --virtual) virtual=true && options+=(--virtual) ;;
    --duration) duration_s=${2:-} && shift ;;
    *) usage ;;
  esac
  shift
done
case ${1:-} in
  classes) shift && classes "$@" ;;
  combinations)
    [[ ${2:-} =~ ^([0-9]+)\.\.([0-9]+)$ ]] || usage
    combinations "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}"
    ;;
  *) usage ;;
esac
[[ $failures -eq 0 ]]
