#!/usr/bin/env bash
# A crossing received through an impaired channel: the vehicles pass, no two bodies touch, and what was
# injected is what was configured.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"

# count VEHICLE NAME: a number from the line in which the vehicle's log reports what was injected.
count() { sed -n "s/.* impairment: .*\b$2=\([0-9]*\).*/\1/p" "$SCRATCH/logs/vehicle-$1.log"; }

# crosses NAME ARGUMENTS...: the run passes, and no two bodies touch.
crosses() {
  local name=$1 code=0
  shift
  judged_run "$SCRATCH/run.json" "$SCRATCH/logs" "$@" || code=$?
  cat "$SCRATCH/run.json"
  [[ $code -eq 0 ]] || fail "$name: exit code $code: $(tail -n 5 "$SCRATCH/run.json.err")"
  jq -e '.verdict == "passed" and .contacts == 0 and .arrived == [1, 2]
    and (.violations | all(. == 0))' "$SCRATCH/run.json" >/dev/null || fail "$name: $(<"$SCRATCH/run.json")"
}

# Some 1300 packets a vehicle: a tenth is 0.1 with a deviation of 0.008. Four beacons lost in a row, or three
# and a late one, are too old to decide by: then the vehicle with priority may stand for a moment, too.
sed 's/^\( *\)halted: \[2\]$/\1any_halted: true/' \
  "$REPOSITORY/config/scenarios/intersection_yield.textproto" >"$SCRATCH/whoever_halts.textproto"
crosses "10 % loss and 20 ms" "$SCRATCH/whoever_halts.textproto" --impair loss=0.1,delay=20ms,jitter=5ms,seed=7
for vehicle in 1 2; do
  packets=$(count $vehicle packets)
  lost=$(count $vehicle dropped_loss)
  [[ ${packets:-0} -gt 500 ]] || fail "vehicle $vehicle: '$packets' packets"
  awk -v lost="${lost:-0}" -v of="${packets:-1}" \
    'BEGIN { exit !(lost / of > 0.05 && lost / of < 0.15) }' ||
    fail "vehicle $vehicle: $lost of $packets lost, expected a tenth"
  [[ $(count $vehicle delayed) == $(count $vehicle passed) ]] || fail "vehicle $vehicle: not all late"
done

# By the scenario: vehicle 1 receives nothing from vehicle 2 for two seconds, and vehicle 2 everything from
# it.
sed '$a impair { from: vehicles to_vehicle: 1 blackout { from_s: 3 to_s: 5 } }' \
  "$REPOSITORY/config/scenarios/intersection_yield.textproto" >"$SCRATCH/one_way.textproto"
crosses "a blackout one way" "$SCRATCH/one_way.textproto"
[[ $(count 1 dropped_blackout) -ge 30 ]] || fail "vehicle 1: no blackout"
[[ $(count 2 dropped_blackout) == 0 ]] || fail "vehicle 2: a blackout that was another's"

# The same by a rule with a time span, from a file.
echo 'from=vehicles,to=1,loss=1,during=3s..5s' >"$SCRATCH/rules"
crosses "a rule for a time" intersection_yield --impair "@$SCRATCH/rules"
[[ $(count 1 dropped_loss) -ge 30 ]] || fail "vehicle 1: lost $(count 1 dropped_loss)"
[[ $(count 2 dropped_loss) == 0 ]] || fail "vehicle 2: a loss that was another's"

# The environment variable of the flag, and what is refused.
GIVEWAY_IMPAIR=none crosses "none instead of the scenario's" "$SCRATCH/one_way.textproto"
[[ -z $(count 1 packets) ]] || fail "impaired, though none was asked for"
code=0
"$FLEETCTL" run intersection_yield --impair loss=2,delay=5 >"$SCRATCH/out" 2>"$SCRATCH/err" || code=$?
[[ $code -eq 2 ]] || fail "a loss of 2: exit code $code"
grep -q 'loss = 2: must be a number between 0 and 1' "$SCRATCH/err" || fail "$(<"$SCRATCH/err")"
grep -q 'delay = 5: must be a time with its unit' "$SCRATCH/err" || fail "$(<"$SCRATCH/err")"
code=0
"$FLEETCTL" run intersection_yield --lockstep --impair loss=0.1 >"$SCRATCH/out" 2>"$SCRATCH/err" ||
  code=$?
[[ $code -eq 2 ]] || fail "in lockstep: exit code $code"

[[ $failures -eq 0 ]]
