#!/usr/bin/env bash
# What the packet filter costs a fleet of eight that drives: pairs of two fleets side by side, each in
# a domain of its own, one of them of services that were linked without the filter (unfiltered.cc).
# Which of the two starts first alternates. Prints a line a fleet, and of each figure the ratio with the
# filter to without it: the mean of the pairs and its 95 % interval.
# Usage: filter_cost.sh [--seconds S] [--pairs N] [--vehicles N]   (60, 5, 8)
#
#   cpu_ms_s      processor time of a vehicle a second, mean; world_ms_s of the world
#   taken         beacons taken of those that the others sent, %
#   age_p99_ms    age of the oldest beacon decided by, 99 %, mean of the vehicles
#   reaction_ms   from the scan of a cause to obeying wheels, mean of all reactions; reaction_p99_ms
#   turn_us       from waking on a scan to the command sent, mean
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
declare -A folder=([with]=$build/bin [without]=$work/unfiltered) pid=() domain=()
ended() {
  local name
  for name in "${!pid[@]}"; do kill -INT "${pid[$name]}" 2>/dev/null || true; done
  wait
  rm -rf "$work"
}
trap ended EXIT
# fleetctl takes the services next to it.
mkdir "${folder[without]}"
cp "$build/tests/bench/unfiltered"/giveway-{vehicle,world} "$build/bin/fleetctl" "${folder[without]}"
export GIVEWAY_CONFIG_DIR=${GIVEWAY_CONFIG_DIR:-$project/config}

children_of() { cat "/proc/$1/task"/*/children 2>/dev/null; }
# on_cpu PROGRAM FLEETCTL: nanoseconds that the fleet's processes of this program were on a processor.
on_cpu() {
  local child
  for child in $(children_of "$2"); do
    [[ $(readlink "/proc/$child/exe") == */"$1" ]] || continue
    cat "/proc/$child/task"/*/schedstat
  done | awk '{sum += $1} END {printf "%.0f\n", sum}'
}

start() { # NAME
  "${folder[$1]}/fleetctl" run patrol --vehicles "$vehicles" --duration $((seconds + 40)) --seed "$pair" --json \
    >"$work/$1.json" 2>"$work/$1.err" &
  pid[$1]=$!
  until domain[$1]=$(sed -n 's/.* on domain \([0-9]*\)$/\1/p' "$work/$1.err") && [[ -n ${domain[$1]} ]]; do
    kill -0 "${pid[$1]}" || return
    sleep 0.1
  done
}
# The newest status of each vehicle.
statuses() { # NAME
  "${folder[with]}/fleetctl" listen fleet/status --domain "${domain[$1]}" --duration 2 --json \
    2>/dev/null | jq -s 'group_by(.vehicle) | map(last)' >"$work/$1.$2"
}

line() { # NAME VEHICLES_NS WORLD_NS WINDOW_NS
  jq -nr --arg name "$1" --argjson cpu "$2" --argjson world "$3" --argjson window "$4" --argjson n "$vehicles" \
    --slurpfile a "$work/$1.first" --slurpfile b "$work/$1.last" '
    $a[0] as $a | $b[0] as $b | def mean: add / length;
    if ($b | length) != $n or ($a | length) != $n then error("not all vehicles were heard") else . end |
    if ($name == "with") != ([$b[].packets.handed_on] | min > 0) then error("is not \($name) the filter") else . end |
    (([$b[].beacons.sent] | add) - ([$a[].beacons.sent] | add)) as $sent |
    (([$b[].beacons.taken] | add) - ([$a[].beacons.taken] | add)) as $taken |
    [$name, $cpu * 1000 / $window / $n, $world * 1000 / $window, 100 * $taken / ($sent * ($n - 1)),
      ([$b[].timing.beacon_age_us.p99] | mean) / 1000,
      ([$b[].timing.reaction_us | select(.values > 0) | .p50] | mean) / 1000,
      ([$b[].timing.reaction_us | select(.values > 0) | .p99] | mean) / 1000,
      ([$b[].timing.turn_us.p50] | mean)] |
    map(if type == "number" then . * 1000 | round / 1000 else . end) | @tsv'
}

columns=(filter cpu_ms_s world_ms_s taken age_p99_ms reaction_ms reaction_p99_ms turn_us)
(IFS=$'\t' && echo "${columns[*]}")
for ((pair = 1; pair <= pairs; ++pair)); do
  order=(with without)
  ((pair % 2)) || order=(without with)
  for name in "${order[@]}"; do start "$name"; done
  sleep 8 # all drive, and the announcements of the start are over
  declare -A vehicles_ns=() world_ns=() window_ns=()
  for name in "${order[@]}"; do statuses "$name" first; done
  for name in "${order[@]}"; do
    window_ns[$name]=$(date +%s%N)
    vehicles_ns[$name]=$(on_cpu giveway-vehicle "${pid[$name]}")
    world_ns[$name]=$(on_cpu giveway-world "${pid[$name]}")
  done
  sleep "$seconds"
  for name in "${order[@]}"; do
    window_ns[$name]=$(($(date +%s%N) - window_ns[$name]))
    vehicles_ns[$name]=$(($(on_cpu giveway-vehicle "${pid[$name]}") - vehicles_ns[$name]))
    world_ns[$name]=$(($(on_cpu giveway-world "${pid[$name]}") - world_ns[$name]))
  done
  for name in "${order[@]}"; do statuses "$name" last; done
  for name in with without; do
    kill -INT "${pid[$name]}"
    wait "${pid[$name]}" || true
    unset "pid[$name]"
    line "$name" "${vehicles_ns[$name]}" "${world_ns[$name]}" "${window_ns[$name]}" | tee -a "$work/lines"
  done
done

# With two lines a pair. Student's t for 95 %, two-sided.
awk -v names="${columns[*]}" '
  NR == 1 { count = split(names, name, " ")
    split("0 12.706 4.303 3.182 2.776 2.571 2.447 2.365 2.306 2.262", t, " ") }
  $1 == "with" { for (i = 2; i <= count; ++i) with[i] = $i; next }
  $1 == "without" { ++n; for (i = 2; i <= count; ++i) { r = with[i] / $i; sum[i] += r; square[i] += r * r } }
  END { for (i = 2; i <= count; ++i) { mean = sum[i] / n
      spread = n < 2 ? 0 : t[n > 10 ? 10 : n] * sqrt((square[i] - n * mean * mean) / (n - 1) / n)
      printf "%-16s with / without %.3f  (%.3f to %.3f, %d pairs)\n", name[i], mean, mean - spread, mean + spread, n } }' \
  "$work/lines"
