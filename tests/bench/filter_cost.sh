#!/usr/bin/env bash
# What the packet filter costs a fleet of eight that drives: pairs of two fleets side by side, each in
# a domain of its own, one of them of services that were linked without the filter (unfiltered.cc).
# Which of the two starts first alternates. Prints a line a fleet, and the ratio of each figure
# (fleet_pairs.sh says what they are) with the filter to without it.
# Usage: filter_cost.sh [--seconds S] [--pairs N] [--vehicles N]   (60, 5, 8)
set -euo pipefail
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=${GIVEWAY_BUILD_DIR:-$project/build/release}
seconds=60 pairs=5 vehicles=8
while [[ $# -gt 0 ]]; do
  case $1 in
    --seconds) seconds=$2 ;;
    --pairs) pairs=$2 ;;
    --vehicles) vehicles=$2 ;;
    *)
      echo "unknown argument $1" >&2
      exit 2
      ;;
  esac
  shift 2
done
[[ -n ${GIVEWAY_BUILD_DIR:-} ]] || cmake --build "$build" --target unfiltered_vehicle unfiltered_world fleetctl \
  giveway-vehicle giveway-world >/dev/null
work=$(mktemp -d)
source "$project/tests/bench/fleet_pairs.sh"
trap 'end_fleets; rm -rf "$work"' EXIT
folder=([with]=$build/bin [without]=$work/unfiltered)
# fleetctl takes the services next to it.
mkdir "${folder[without]}"
cp "$build/tests/bench/unfiltered"/giveway-{vehicle,world} "$build/bin/fleetctl" "${folder[without]}"
export GIVEWAY_CONFIG_DIR=${GIVEWAY_CONFIG_DIR:-$project/config}

# shellcheck disable=SC2016  # jq's variable
declare -A filters=([with]='[$b[].packets.handed_on] | min > 0' [without]='[$b[].packets.handed_on] | min == 0')
(IFS=$'\t' && echo "filter	${FIGURES[*]}")
for ((pair = 1; pair <= pairs; ++pair)); do
  order=(with without)
  ((pair % 2)) || order=(without with)
  for name in "${order[@]}"; do start_fleet "$name" "$pair" patrol --vehicles "$vehicles"; done
  sleep 8 # all drive, and the announcements of the start are over
  watch "${order[@]}"
  end_fleets
  for name in with without; do
    line=$(TRUE_OF_IT=${filters[$name]} figures "$name") # stops here where it is not true
    printf '%s\t%s\n' "$name" "$line" | tee -a "$work/lines"
  done
done
ratios "$work/lines"
