#!/usr/bin/env bash
# fleetctl top and fleetctl listen on a fleet that another fleetctl runs: what they show, that a killed
# vehicle stays and is marked, how they end, and what they say without a fleet.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
unset GIVEWAY_QOS GIVEWAY_INTERFACE GIVEWAY_DOMAIN
cd "$SCRATCH"

# observe CODE NAME ARGUMENTS...: fleetctl ARGUMENTS ends with CODE, in time; output in ./out, ./err.
observe() {
  local wanted=$1 name=$2 code=0
  shift 2
  timeout 30 "$FLEETCTL" "$@" >out 2>err || code=$?
  [[ $code -eq $wanted ]] || fail "$name: exit code $code: $(head -c 400 out err)"
}

# says NAME CONDITION: true of the JSON of the last command, all of its objects in one list.
says() { jq -es "$2" out >/dev/null || fail "$1: not true of $(head -c 600 out): $2"; }

# until_true SECONDS COMMAND...: tries again until it succeeds.
until_true() {
  local end=$((SECONDS + $1))
  shift
  until "$@"; do
    ((SECONDS < end)) || return 1
    sleep 0.1
  done
}

# Starts a run; sets $domain to its domain.
start_run() {
  : >run.err # that of the run before names a domain too
  "$FLEETCTL" run "$1" --json --logs logs >run.json 2>run.err &
  fleet=$!
  domain=$(domain_said run.err) || fail "$1: no domain in $(cat run.err)"
  until_true 20 spoken || fail "$1: no truth on $domain: $(cat err)"
}
spoken() { timeout 30 "$FLEETCTL" listen world/truth --domain "$domain" --count 1 >out 2>err; }

ended() { ! kill -0 "$1" 2>/dev/null; }

# interrupted NAME ARGUMENTS...: it shows something, then SIGINT ends it with exit code 0.
interrupted() {
  local name=$1 pid code=0
  shift
  : >live # before there is anything to grep
  "$FLEETCTL" "$@" >live 2>err &
  pid=$!
  until_true 20 grep -q 'vehicle' live || fail "$name: shows nothing: $(cat err)"
  kill -INT "$pid"
  until_true 10 ended "$pid" || fail "$name: does not end by Ctrl-C"
  wait "$pid" || code=$?
  [[ $code -eq 0 ]] || fail "$name: exit code $code by Ctrl-C"
}

# Longer than all that is looked at, also on a slow machine.
sed 's/m: 2\.5/m: 9/' "$REPOSITORY/config/scenarios/intersection_yield.textproto" >long.textproto
start_run long.textproto
observe 0 "top" top --domain "$domain" --once
grep -q '^world running' out || fail "top: no world in $(cat out)"
grep -Eq '^ +1  cooperative' out || fail "top: no vehicle in $(cat out)"
observe 0 "top as JSON" top --domain "$domain" --once --json
says "top as JSON" '.[0] | .world.state == "running" and .world.fleet_size == 2
  and ([.vehicles[].id] == [1, 2]) and all(.vehicles[]; .hearing == "heard"
    and .beacon_age_s < 1 and .status.mode and .status.beacons.sent > 0
    and .status.last_qos_event.kind != null and .status.last_qos_event.vehicle == 3 - .id)'
observe 0 "five beacons" listen fleet/beacon --domain "$domain" --count 5 --json
says "five beacons" 'length == 5 and all(.[]; .topic == "fleet/beacon" and .crc_valid
  and .name_valid and .seq > 0 and .left_rad_s != null)'
observe 0 "of one vehicle" listen fleet/status --domain "$domain" --vehicle 2 --count 2 --json
says "of one vehicle" 'length == 2 and all(.[]; .vehicle == 2 and .qos.matched == 1)'
observe 0 "a latecomer" listen world/event --domain "$domain" --count 1 --json
says "a latecomer" '.[0].kind == "started"'
observe 1 "nothing yet" listen world/figures --domain "$domain" --duration 2
grep -q 'a fleet is there' err || fail "nothing yet: $(cat err)"

statuses=0,0
timeout 30 "$FLEETCTL" listen fleet/beacon --domain "$domain" 2>err | head -n 1 >out ||
  statuses=$(IFS=,; echo "${PIPESTATUS[*]}")
[[ $statuses == 0,0 ]] || fail "head -n 1: exit codes $statuses"
grep -q 'vehicle [12]  #' out || fail "head -n 1: $(cat out)"
[[ ! -s err ]] || fail "head -n 1: complains: $(cat err)"
timeout 10 "$FLEETCTL" listen fleet/beacon --domain "$domain" >&- 2>err || fail "no stdout: $(cat err)"

observe 2 "no such topic" listen fleet/beacons --domain "$domain"
grep -q 'fleet/beacon, fleet/status' err || fail "no such topic: $(cat err)"
observe 2 "signals of a vehicle" listen world/signal --vehicle 1 --domain "$domain"
observe 2 "wait without once" top --domain "$domain" --wait 1
observe 2 "no such interface" top --domain "$domain" --once --interface no_such_0
observe 2 "no such profiles" listen fleet/beacon --domain "$domain" --qos no_such.xml
[[ ! -w /dev/full ]] || {
  code=0
  timeout 30 "$FLEETCTL" listen fleet/beacon --domain "$domain" >/dev/full 2>err || code=$?
  [[ $code -eq 2 ]] || fail "a full disk: exit code $code"
}
interrupted "top" top --domain "$domain"
interrupted "listen" listen fleet/beacon --domain "$domain"
wait "$fleet" || excused run.json logs || fail "watching changed the run: $(cat run.json)"
# Kept: the next run would take it, the lowest that is free.
exec {kept}<"/tmp/giveway-domain-$domain.lock"
flock "$kept"
grep -q 'matched: vehicle 1' logs/vehicle-2.log || fail "the log has no event: $(cat logs/*2.log)"

# The domain is free now: there is no fleet.
observe 1 "no fleet" top --domain "$domain" --once --wait 1 --area elsewhere
grep -q "domain $domain on interface 127.0.0.1 in area elsewhere" err || fail "no fleet: $(cat err)"
observe 1 "no fleet, as JSON" top --domain "$domain" --once --wait 1 --json
says "no fleet, as JSON" '.[0] | .world.heard == false and .vehicles == []'
observe 1 "nothing to listen to" listen fleet/beacon --domain "$domain" --duration 0.5

# One of two is killed by a planned fault: it stays in the table, and the other names it.
marked() {
  "$FLEETCTL" top --domain "$domain" --json >live 2>err &
  local watching=$! code=0
  until_true 40 silent_in live || code=1
  kill -INT "$watching"
  wait "$watching" || true
  return $code
}
silent_in() {
  jq -es 'any(.[]; any(.vehicles[]; .hearing == "silent" and .heard_s_ago > 1)
    and any(.vehicles[]; .hearing == "heard" and .status.last_deadline_missed != null
      and .status.last_liveliness_lost != null))' "$1" >/dev/null 2>&1
}
start_run peer_dies
marked || fail "a killed vehicle: $(tail -n 1 live)"
kill -INT "$fleet" || fail "the run ended before its time"
wait "$fleet" || true
grep -Eq 'warning.* deadline_missed: vehicle [12]' logs/*.log || fail "no miss in a log"
grep -Eq 'warning.* liveliness_lost: vehicle [12]' logs/*.log || fail "no loss in a log"

[[ $failures -eq 0 ]]
