#!/usr/bin/env bash
# fleetctl qos apply on a fleet that another fleetctl runs: a deadline while it drives, a restart,
# a canary that is promoted and one that is rolled back, and what is refused.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
source "$(dirname "${BASH_SOURCE[0]}")/../support/lateness.sh"
unset GIVEWAY_QOS GIVEWAY_INTERFACE GIVEWAY_DOMAIN
cd "$SCRATCH"
default=$REPOSITORY/config/qos/default.xml

# apply CODE NAME ARGUMENTS...: fleetctl qos apply ends with CODE; output in ./out, ./err. A machine that stands
# still raises alarms which no profile causes: where it was late for a deadline meanwhile, the order is given again.
apply() {
  local wanted=$1 name=$2 code late_before attempt
  shift 2
  for attempt in 1 2 3; do
    code=0 late_before=$(late_us late)
    timeout 100 "$FLEETCTL" qos apply "$@" >out 2>err || code=$?
    [[ $code -ne $wanted && $(($(late_us late) - late_before)) -ge 100000 ]] || break
    echo "$name: exit code $code at attempt $attempt, on a machine that was late" >&2
  done
  [[ $code -eq $wanted ]] || fail "$name: exit code $code: $(head -c 600 out err)"
}
# says NAME CONDITION: true of the JSON object of the last command.
says() { jq -e "$2" out >/dev/null || fail "$1: not true of $(jq -c 'del(.vehicles[]?.changes)' out || head -c 900 out): $2"; }

# with FILE PROFILE SED...: a copy of the default in which one profile is edited.
with() {
  local file=$1 profile=$2
  shift 2
  sed "/profile_name=\"$profile\"/,/<\/data_/ { $* }" "$default" >"$file"
  ! cmp -s "$file" "$default" || fail "$file is the default"
}
with deadline.xml fleet_beacon_reader 's/<nanosec>150000000/<nanosec>180000000/'
with depth.xml fleet_beacon_reader 's/<depth>[0-9]*/<depth>9/'
# First the offered value, then the requested one.
with offered.xml fleet_beacon_writer 's/<nanosec>100000000/<nanosec>60000000/'
sed '/profile_name="fleet_beacon_reader"/,/<\/data_/ s/<nanosec>150000000/<nanosec>60000000/' \
  offered.xml >tight.xml
with mismatch.xml fleet_beacon_writer 's/<nanosec>250000000/<nanosec>500000000/'
printf '<dds><profiles>' >cut.xml


cp "$REPOSITORY/tests/system/rounds.textproto" .

# With one beacon in ten lost, a deadline only slightly above the period is missed again and again.
"$FLEETCTL" run rounds.textproto --impair loss=0.1 --json --logs logs >run.json 2>run.err &
fleet=$!
keep_time late
time=$!
trap 'end_listening; kill "$time"; kill -INT "$fleet" 2>/dev/null || true; wait "$fleet" 2>/dev/null || true; rm -rf "$SCRATCH"' EXIT
domain=$(domain_said run.err) || {
  fail "no domain in $(cat run.err)"
  exit 1
}
for _ in $(seq 200); do
  grep -q running run.err && break
  sleep 0.1
done
pid=$(find_child "$fleet" 2)
listen_places two "$domain" 2
await_places two 1 21

apply 0 "dry run" depth.xml --to 1,2,3,4 --domain "$domain" --dry-run
grep -q 'depth  *[0-9] -> 9  (restart)' out || fail "dry run: $(cat out)"

apply 0 "a deadline" deadline.xml --to 1,2 --domain "$domain" --json
says "a deadline" '.verdict == "applied" and all(.vehicles[]; .in_effect and .checked > 0 and
  .seen == .checked and all(.changes[]; .effect == "now"))'
! grep -q 'restarts itself' logs/vehicle-2.log || fail "a deadline: vehicle 2 restarted"

apply 0 "the same again" deadline.xml --to 1 --domain "$domain" --json
says "the same again" '.verdict == "nothing_to_do"'
apply 1 "no restart" depth.xml --to 1 --domain "$domain" --no-restart --json
says "no restart" '.verdict == "refused"'

# The example of the help, as printed except for the domain: to every vehicle and the world.
example=$("$FLEETCTL" qos apply --help | sed -n "s/^ *fleetctl qos apply \(.*--canary.*\)/\1/p" |
  sed "s/--domain 7/--domain $domain/")
[[ $example == *"--to all"* ]] || fail "the help has no such example: $example"
# shellcheck disable=SC2086  # words of a command line
apply 0 "the example of the help" $example --json
says "the example of the help" '.verdict == "applied" and .vehicles[0].id == 2 and
  .trial.worse == "" and (.vehicles | length == 5) and any(.vehicles[]; .process == "the world") and
  all(.vehicles[]; .in_effect and .checked > 0 and .seen == .checked) and
  (.order[0] == "vehicle 2 (between)")'
grep -q 'restarts itself' logs/world.log || fail "the example of the help: the world did not restart"
grep -q 'restarts itself' logs/vehicle-2.log || fail "a canary: vehicle 2 did not restart"
[[ $(find_child "$fleet" 2) == "$pid" ]] || fail "a canary: vehicle 2 is another process"

"$FLEETCTL" why 1 2 --domain "$domain" >out 2>err || fail "why, after a restart: $(cat out err)"

apply 0 "back to the default" default --to all --domain "$domain" --json
says "back to the default" '.verdict == "applied" and (.vehicles | length == 5) and
  .order[0] == "the world"'

# With data sharing the library creates none of our endpoints, which no rule reports as an error.
restarts=$(grep -c 'restarts itself' logs/vehicle-1.log)
with no_participant.xml fleet_beacon_writer '/<data_sharing>/,/<\/data_sharing>/ s/OFF/ON/'
apply 1 "a set without a participant" no_participant.xml --to 1 --domain "$domain" --json
says "a set without a participant" '.verdict == "refused" and
  (.vehicles[0].refusal | contains("a participant with it cannot be made"))'
[[ $(grep -c 'restarts itself' logs/vehicle-1.log) -eq $restarts ]] ||
  fail "a set without a participant: vehicle 1 restarted"
# A vehicle that restarts all the same, and finds its new set unusable, takes the former one.
code=0
timeout 20 "$GIVEWAY_BIN_DIR/giveway-vehicle" --scenario rounds.textproto --domain "$domain" --id 3 \
  --qos cut.xml --former-qos "$default" 2>err || code=$?
if [[ $code -ne 2 ]] || ! grep -q 'comes back with the QoS it had before: .*cut.xml' err ||
  ! grep -q 'the world refused this vehicle' err; then
  fail "no fallback: exit code $code: $(cat err)"
fi
sed '0,/<.transport_id>/ s/<.transport_id>/&<output_port>7777<\/output_port>/' "$default" >door.xml
apply 1 "an element that is no QoS" door.xml --to 1 --domain "$domain" --json
says "an element that is no QoS" 'any(.findings[]; .rule == "not_by_order" and .line > 0)'

apply 1 "a mismatch" mismatch.xml --to 1 --domain "$domain" --json
says "a mismatch" '.verdict == "refused" and any(.findings[]; .rule == "liveliness_lease_mismatch")'

apply 0 "offered first" offered.xml --to 1,2,3,4 --domain "$domain" --json
apply 1 "a canary that serves worse" tight.xml --to 1,2 --domain "$domain" --canary 1 --watch 6 --json
says "a canary that serves worse" '.verdict == "rolled_back" and (.trial.worse | contains("alarms"))'
"$FLEETCTL" qos show --live 1 --domain "$domain" --qos offered.xml >out 2>err ||
  fail "rolled back to something else: $(grep not out; cat err)"

apply 2 "no vehicle of that id" deadline.xml --to 9 --domain "$domain"
grep -q 'no fleet/admin reader of vehicle 9' err || fail "no vehicle of that id: $(cat err)"
code=0
timeout --foreground --preserve-status --signal INT 1 \
  "$FLEETCTL" qos apply deadline.xml --to 9 --domain "$domain" >out 2>err || code=$?
[[ $code -eq 1 ]] || fail "not waited for: exit code $code: $(cat err)"
grep -q 'interrupted before vehicle 9' err || fail "not waited for: $(cat err)"
for bad in "cut.xml --to 1" "/no/such.xml --to 1" "deadline.xml --to 0" "deadline.xml --to 1,1" \
  "deadline.xml" "deadline.xml --to 1 --canary 2" "deadline.xml --to 1 --watch 3"; do
  # shellcheck disable=SC2086  # words of a command line
  apply 2 "refused: $bad" $bad --domain "$domain"
  [[ -s err ]] || fail "refused without a word: $bad"
done

# Before and after each restart it knew its position, and it continued to the corner it was driving to.
end_listening
places two >two.json
jq -e 'length >= 2 and all(.[]; .beacons > 20 and .beyond_m < 0.1) and
  all(.[]; .continues)' two.json >/dev/null ||
  fail "where vehicle 2 took itself to be: $(tr -d '\n ' <two.json)"

kill -INT "$fleet"
wait "$fleet" && fail "an interrupted run passed"
jq -e '.reason == "interrupted" and .contacts == 0 and .violations.pose == 0' run.json >/dev/null || fail "run: $(cat run.json)"
((failures == 0)) && echo "qos apply: ok"
exit $((failures > 0))
