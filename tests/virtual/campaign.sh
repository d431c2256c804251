#!/usr/bin/env bash
# Runs every generator of the virtual fleet over many seeds and says what broke. Seeds go in blocks;
# a finished block is a file in the folder of results, so that a campaign cut off is taken up by the
# same command. Exit code 0: every invariant held in every run; 1: one did not; 2: bad usage.
# Usage: campaign.sh [--seeds N] [--results DIR] [--generators "NAME ..."] [--jobs J]
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
fleetctl=${GIVEWAY_BIN:-$root/build/release/bin}/fleetctl
seeds=200 results="" jobs=$(nproc)
generators="crossing roundabout corridor swarm merge convoy warehouse"
readonly kBlock=50

usage() {
  sed -n '5s/^# //p' "${BASH_SOURCE[0]}" >&2
  exit 2
}

while [[ $# -gt 0 ]]; do
  [[ $# -ge 2 ]] || usage
  case $1 in
    --seeds) seeds=$2 ;;
    --results) results=$2 ;;
    --generators) generators=$2 ;;
    --jobs) jobs=$2 ;;
    *) usage ;;
  esac
  shift 2
done
[[ $seeds =~ ^[1-9][0-9]{0,6}$ && $jobs =~ ^[1-9][0-9]{0,3}$ ]] || usage
if [[ -z $results ]]; then
  results=$(mktemp -d)
  trap 'rm -rf "$results"' EXIT
fi
# Results of another brain are no results of this one.
results+=/$(sha256sum "$fleetctl" | cut -c1-16)
mkdir -p "$results"

# block GENERATOR FIRST LAST: runs it unless its result is there; what is cut off leaves none.
block() {
  local file=$results/$1.$2-$3.json code=0
  [[ -s $file ]] && return
  "$fleetctl" virtual "$1" --seeds "$2..$3" --vehicles 2..50 --loss 0..20 --jobs "$jobs" --json \
    >"$file.part" 2>/dev/null || code=$?
  if [[ $code -gt 1 ]] || ! jq -e ".runs == $3 - $2 + 1" "$file.part" >/dev/null; then
    echo "campaign.sh: $1, seeds $2..$3: exit code $code, not a whole result" >&2
    exit 1
  fi
  mv "$file.part" "$file"
}

# sum_up GENERATOR RESULT...: one line of the table; true if everything held.
sum_up() {
  local generator=$1
  shift
  jq -s -r --arg generator "$generator" '
    (map(.violations | to_entries[] | select(.value > 0)) | group_by(.key) |
      map("\(.[0].key) \(map(.value) | add)")) as $broken |
    (map(.failing_seeds[]) | map(tostring) | .[:8]) as $seeds |
    (map(select(.delay_s) | {weight: .runs, mean: .delay_s.mean})) as $delays |
    [$generator, (map(.runs) | add), (map(.failed_runs) | add), (map(.contacts) | add),
     (map(.vehicle_hours) | add | floor),
     (($delays | map(.mean * .weight) | add) / ($delays | map(.weight) | add) * 10 | round / 10),
     ($broken + $seeds | join(" "))] | @tsv' "$@"
  jq -s -e 'all(.verdict == "passed")' "$@" >/dev/null
}

held=true
printf 'generator\truns\tfailed\tcontacts\tvehicle-hours\tmean delay, s\tbroken\n'
for generator in $generators; do
  blocks=()
  for ((first = 1; first <= seeds; first += kBlock)); do
    last=$((first + kBlock - 1 < seeds ? first + kBlock - 1 : seeds))
    block "$generator" "$first" "$last"
    blocks+=("$results/$generator.$first-$last.json")
  done
  sum_up "$generator" "${blocks[@]}" || held=false
done
$held
