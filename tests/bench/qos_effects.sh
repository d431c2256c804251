#!/usr/bin/env bash
# What each value of the profile sets in config/qos does: runs a real fleet with the shipped value and
# one with another, side by side, each in a network namespace of its own, and prints what differs.
# The comments of the sets are from here. A measurement, not a test: exit code 0 however it comes out,
# 2 if a fleet could not be run. Needs root, as namespaces do.
#
#   bash tests/bench/qos_effects.sh                     all rows, some ten minutes on two cores
#   bash tests/bench/qos_effects.sh --list              their names
#   bash tests/bench/qos_effects.sh --only 'depth'      those whose name matches
#   bash tests/bench/qos_effects.sh --rounds 3          each three times: the medians
#   bash tests/bench/qos_effects.sh --keep FOLDER       keeps logs and all figures of every fleet
#
# A line: name, figure, with the shipped value, with the other, verdict. Figures are those of
# qos_effects_trial.sh; packets, bytes and CPU are a vehicle's share, of eight. `none`: they differ by
# a tenth at most, counts of packets, bytes and threads by a fiftieth. Of a fleet that was refused its
# own words stand in place of figures.
set -euo pipefail
cd "$(dirname "$0")/../.."
source services/setup.sh
sets=$PWD/config/qos
only=. rounds=1 keep='' list=
while [[ $# -gt 0 ]]; do
  case $1 in
    --list) list=yes ;;
    --only) only=${2:?} && shift ;;
    --rounds) rounds=${2:?} && shift ;;
    --keep) keep=${2:?} && shift ;;
    *) die "unknown: $1; see the head of $0" ;;
  esac
  shift
done
scratch=${keep:-$(mktemp -d)}
mkdir -p "$scratch"
scratch=$(cd "$scratch" && pwd)
[[ -n $keep ]] || trap 'rm -rf "$scratch"' EXIT

# edited SET EDIT...: the set with xmlstarlet's edits, d: being the namespace of the profiles.
edited() {
  local set=$1
  shift
  xmlstarlet ed -N d=http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles "$@" "$sets/$set.xml"
}

# fleet FOLDER SET OPTION...: one trial, apart from everything else on this machine.
fleet() {
  unshare -nm bash tests/bench/qos_effects_trial.sh "$2" "$1" "${@:3}" >"$1.json" 2>"$1.err"
}

# median FILE...: of each figure over the rounds.
median() {
  jq -s '(map(keys) | add | unique) as $names | . as $all | [$names[] | . as $name |
    {key: $name, value: ([$all[][$name] | numbers] | sort | .[(length - 1) / 2 | floor])}]
    | from_entries' "$@"
}

# compare NAME FIGURES A.json B.json
compare() {
  jq -nr --arg name "$1" --arg figures "$2" --slurpfile a "$3" --slurpfile b "$4" '
    def text: if . == null then "-" else tostring end;
    $figures | split(",")[] | . as $figure | $a[0][$figure] as $x | $b[0][$figure] as $y
    | (if $figure | IN("packets_s", "kB_s", "threads") then 0.02 else 0.1 end) as $noise
    | (if $x == $y then "none"
       elif $x == null or $y == null then "\($x | text) -> \($y | text)"
       elif (($x - $y) | fabs) <= ([$x, $y] | max) * $noise then "none"
       elif $x == 0 or $y == 0 then "\($x) -> \($y)"
       else "x \($y / $x * 100 | round / 100)" end) as $verdict
    | [$name, $figure, ($x | text), ($y | text), $verdict] | @tsv' |
    awk -F'\t' '{ printf "%-58s %-22s %10s %10s  %s\n", $1, $2, $3, $4, $5 }'
}

# row NAME SET FIGURES 'OPTION=VALUE ...' EDIT...: the set against the set with the edits.
row() {
  local name=$1 set=$2 figures=$3 options=$4 round folder shipped other
  shift 4
  [[ $name =~ $only ]] || return 0
  [[ -z $list ]] || { echo "$name" && return; }
  folder=$scratch/${name//[^A-Za-z0-9_.]/_}
  rm -rf "$folder" && mkdir -p "$folder"
  edited "$set" "$@" >"$folder/other.xml"
  cmp -s "$folder/other.xml" <(edited "$set") && die "$name: the edit changes nothing"
  cp "$sets/$set.xml" "$folder/shipped.xml"
  shipped=() other=()
  for ((round = 1; round <= rounds; ++round)); do
    # shellcheck disable=SC2086  # options are words
    fleet "$folder/shipped_$round" "$folder/shipped.xml" $options &
    local shipped_pid=$!
    # shellcheck disable=SC2086
    if ! fleet "$folder/other_$round" "$folder/other.xml" $options; then
      printf '%-58s refused: %s\n' "$name" \
        "$(sed -n 's/.*\(QoS file [^ ]*: \|Fast DDS: \)//p' "$folder/other_$round.err" | head -n 1)"
      wait "$shipped_pid" || true
      return 0
    fi
    wait "$shipped_pid" || die "$name: $(cat "$folder/shipped_$round.err")"
    shipped+=("$folder/shipped_$round.json") other+=("$folder/other_$round.json")
  done
  median "${shipped[@]}" >"$folder/shipped.json"
  median "${other[@]}" >"$folder/other.json"
  compare "$name" "$figures" "$folder/shipped.json" "$folder/other.json"
}

[[ -n $list ]] || {
  [[ $(id -u) -eq 0 ]] || die "namespaces need root"
  mapfile -t packages < <(effect_packages)
  install_packages "${packages[@]}"
  [[ -x build/release/bin/fleetctl ]] || bash services/run.sh --setup-only
  printf '%-58s %-22s %10s %10s  %s\n' "value -> another" figure shipped other verdict
}
source tests/support/qos_effects_rows.sh
