#!/usr/bin/env bash
# A whole vehicle of another vendor's DDS among real processes: it crosses in both roles, also without ever
# granting, and killed and back; its mistakes are logged by name; and fleetctl knows it as foreign. Four runs
# in parallel, each in a domain of its own: most of the time they wait.
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
HERE=$REPOSITORY/tests/foreign
FOREIGN=$GIVEWAY_FOREIGN_VEHICLE
cd "$SCRATCH"

start_foreign() { # NAME ID CRUISE GOAL_X GOAL_Y [FAULT]
  local name=$1
  shift
  "$FOREIGN" "$DOMAIN" "$@" 2>>"$name.log" &
  PID[$name]=$!
}

ends() { # NAME: with exit code 0, in time
  local code=0
  timeout 45 tail --pid="${PID[$1]}" -f /dev/null || fail "$1 does not end: $(tail -n 3 "$1.log")"
  alive "$1" && kill -9 "${PID[$1]}"
  wait "${PID[$1]}" || code=$?
  unset "PID[$1]"
  [[ $code -eq 0 ]] || late_world "$1" || fail "$1: exit code $code: $(tail -n 3 "$1.log")"
}

# late_world NAME: true of a world whose run failed only by which vehicles halted, while a vehicle missed scans.
late_world() {
  local ended
  ended=$(sed -n 's/.*ended: .*; failed: \(.*\); late for \([0-9]*\) ticks.*/\2 \1/p' "$1.log")
  [[ $1 == world_* && -n $ended ]] &&
    only_late "${ended#* }" "${ended%% *}" "$(scans_missed <"ours_${1#world_}.log")"
}

# crossing RUN FOREIGN_ID [FAULT]: starts one; the foreign vehicle is the one with that id.
crossing() {
  local run=$1 id=$2
  take_domain
  start "world_$run" giveway-world
  if [[ $id -eq 2 ]]; then
    start "ours_$run" giveway-vehicle --id 1
    start_foreign "foreign_$run" 2 0.4 0 1.6 "${@:3}"
  else
    start_foreign "foreign_$run" 1 0.5 1.6 0 "${@:3}"
    start "ours_$run" giveway-vehicle --id 2
  fi
}

says() { # NAME CONDITION: true of the JSON in ./out
  jq -e "$2" out >/dev/null || fail "$1: not true of $(head -c 1200 out err): $2"
}

asks() { # CODE NAME ARGUMENTS...: fleetctl ARGUMENTS ends with CODE
  local wanted=$1 name=$2 code=0
  shift 2
  timeout 30 "$FLEETCTL" "$@" >out 2>err || code=$?
  [[ $code -eq $wanted ]] || fail "$name: exit code $code: $(head -c 900 out err)"
}

LANES=$HERE/crossing.textproto
crossing second 2
crossing first 1
sed 's/halted: .*/any_halted: true/' "$HERE/crossing.textproto" >any.textproto
LANES=$SCRATCH/any.textproto
crossing silent 2 never-grants

# The same crossing in an open fleet, where a killed vehicle may come back.
sed -e 's/^vehicle {/spawn {/' -e '/^  id:/d' -e '/halted:/d' -e 's/arrived: .*/any_arrived: true any_halted: true/' \
  -e '$a start_with: 2' "$HERE/crossing.textproto" >open.textproto
LANES=$SCRATCH/open.textproto
take_domain
start world giveway-world
start_foreign foreign 5 0.5 1.6 0
await "it joins" 10 foreign 'joined as 5'
start ours giveway-vehicle --log-format json
await "both drive" 20 ours 'cruise'
sleep 1.5
kill_now foreign
start_foreign back 5 0.5 1.6 0
await "killed and back" 8 back 'joined as 5'
start_foreign kept 6 0.5 1.6 0 volatile-join
start_foreign lost 7 0.5 1.6 0 no-partition

# How fleetctl shows it, while it drives.
asks 0 "its beacons are heard" why 1 5 --domain "$DOMAIN" --json
says "its beacons are heard" '.hears and .speaker_foreign == "Eclipse Cyclone DDS"
  and (.not_known[0] | test("vehicle 5 is foreign"))'
asks 0 "it hears ours" why 5 1 --domain "$DOMAIN" --json
says "it hears ours" '.hears and .hearer_foreign == "Eclipse Cyclone DDS"
  and .topics[0].samples > 0 and .topics[0].fits'
asks 0 "its endpoints" qos show --live 5 --domain "$DOMAIN" --json
says "its endpoints" '.foreign == "Eclipse Cyclone DDS" and any(.values[];
  .profile == "fleet_beacon_writer" and .policy == "deadline" and .value == "100 ms")'
asks 1 "with joins that no world reads" why world 9 --domain "$DOMAIN" --seconds 2.5 --json
says "with joins that no world reads" 'any(.findings[]; .rule == "endpoint_unfit"
  and (.values | test("fleet/join in fleet .*durability offered VOLATILE, requested TRANSIENT_LOCAL")))
  and any(.findings[]; .values | test("fleet/join with no partition"))'

# An id that no flag gives is in the log and in /proc.
[[ $(jq -s 'map(.vehicle) | max' ours.log) == 1 ]] || fail "the log does not name it: $(tail -n 1 ours.log)"
await "a join that no world takes" 5 world 'writer of fleet/join in fleet .*durability offered VOLATILE'
await "a join without a partition" 5 world 'writer of fleet/join with no partition \(Eclipse Cyclone DDS'

await "it arrives" 25 back 'rule 2 '
await "ours arrives" 25 ours 'arrived'
grep -q 'vehicle 5 joined the run' world.log || fail "it did not come back: $(tail -n 5 world.log)"
for name in second first silent; do ends "ours_$name" && ends "foreign_$name"; done
for name in second first silent; do ends "world_$name"; done
grep -q 'not_granted for 2' ours_silent.log || fail "it drove on without a grant: $(cat ours_silent.log)"
no_contact

# Regression: a foreign vehicle truncated its speed bucket instead of rounding it; ours rejected all its
# beacons, and no log said why.
LANES=$HERE/crossing.textproto
crossing cut 2 floors-bucket
await "the field is named" 20 ours_cut 'beacon of vehicle 2: order_speed_bucket is 7, must be 8'
kill -TERM "${PID[world_cut]}"

[[ $failures -eq 0 ]]
