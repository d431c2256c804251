#!/usr/bin/env bash
# Prints the scenario of a deployed fleet: copies of the crossing of patrol, too far apart for a vehicle of
# one to receive any of another. config/scenarios/fleet_N.textproto is its output.
# Usage: fleet_scenario.sh VEHICLES CROSSINGS START_WITH
set -euo pipefail
if [[ $# -ne 3 ]]; then
  echo "usage: fleet_scenario.sh VEHICLES CROSSINGS START_WITH" >&2
  exit 2
fi
vehicles=$1 crossings=$2 start_with=$3

# Further than a road reaches from its crossing (7 m), twice, plus the emission radius (5 m).
PITCH_M=24
# x, y, heading, cruise, and the four corners of the loop: the front four of a crossing, then those behind
# them.
PLACES='-4 -1 0 0.40 7 -1 7 1 -7 1 -7 -1
1 -4 90 0.30 1 7 -1 7 -1 -7 1 -7
4 1 180 0.45 -7 1 -7 -1 7 -1 7 1
-1 4 -90 0.35 -1 -7 1 -7 1 7 -1 7
-7 -1 0 0.35 7 -1 7 1 -7 1 -7 -1
1 -7 90 0.40 1 7 -1 7 -1 -7 1 -7
7 1 180 0.30 -7 1 -7 -1 7 -1 7 1
-1 7 -90 0.45 -1 -7 1 -7 1 7 -1 7'

cat <<TEXT
# A fleet of $vehicles as it is deployed (config/deploy). Schema: idl/scenario.proto.
# Written by tests/deploy/fleet_scenario.sh $vehicles $crossings $start_with
name: "fleet_$vehicles"
description: "Places for $vehicles vehicles that join as they come: crossings of two roads, eight places each, $PITCH_M m apart."

# Zero: until it is asked to stop.
duration_s: 0
# Images are pulled and nodes are found meanwhile: the fleet is gathered before it starts.
start_with: $start_with
start_timeout_s: 600

TEXT
columns=$(awk -v n="$crossings" 'BEGIN { c = int(sqrt(n)); while (c * c < n) ++c; print c }')
for ((crossing = 0; crossing < crossings; ++crossing)); do
  column=$((crossing % columns)) row=$((crossing / columns))
  east=$((column * PITCH_M)) north=$((row * PITCH_M))
  while read -r x y heading cruise corners; do
    printf 'spawn { start { x_m: %d y_m: %d heading_deg: %d } cruise_m_s: %s' \
      $((east + x)) $((north + y)) "$heading" "$cruise"
    # shellcheck disable=SC2086 # two numbers a corner
    set -- $corners
    while [[ $# -gt 0 ]]; do
      printf ' waypoint { x_m: %d y_m: %d }' $((east + $1)) $((north + $2))
      shift 2
    done
    printf ' loop: true }\n'
  done <<<"$PLACES"
done
cat <<'TEXT'

# Any vehicle may halt or arrive; none may touch another.
expect {
  contacts: 0
  any_halted: true
  any_arrived: true
}
TEXT
