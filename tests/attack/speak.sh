#!/usr/bin/env bash
# What a process without credentials can send to a driving fleet, and the result: each row of the table
# is one attack on the same fleet of four, on loopback. After each of them every process of the fleet
# runs, every vehicle drives, and nothing that the intruder wanted has happened.
# Prints a line a row, "ok" or "FAILED".
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
unset GIVEWAY_QOS GIVEWAY_INTERFACE GIVEWAY_DOMAIN GIVEWAY_ADMIN GIVEWAY_ADMIN_KEY
ATTACKER=${GIVEWAY_SPEAK_ATTACKER:-$REPOSITORY/build/release/tests/attack/speak/speak_attacker}
[[ -x $ATTACKER ]] || {
  echo "no $ATTACKER; build its target: speak_attacker" >&2
  exit 2
}
cd "$SCRATCH"
qos=$REPOSITORY/config/qos/default.xml

cp "$REPOSITORY/tests/system/rounds.textproto" .

"$FLEETCTL" run rounds.textproto --json --logs logs >run.json 2>run.err &
fleet=$!
listener=
end_all() {
  [[ -z $listener ]] || kill -INT "$listener" 2>/dev/null || true
  kill -INT "$fleet" 2>/dev/null || true
  wait "$fleet" 2>/dev/null || true
  rm -rf "$SCRATCH"
}
trap end_all EXIT
domain=$(domain_said run.err) || {
  echo "FAILED: no fleet: $(cat run.err)"
  exit 1
}
for _ in $(seq 200); do
  grep -qs 'started with 4' logs/world.log && break
  sleep 0.1
done
"$FLEETCTL" listen world/truth --json --domain "$domain" >truth 2>listen.err &
listener=$!
mapfile -t pids < <(processes_on "$domain")

# Whether every body moved, and is there, in a little less than a second.
all_moved() {
  local from
  from=$(wc -l <truth)
  sleep 0.8
  tail -n "+$((from + 1))" truth | head -n -1 | jq -se 'group_by(.vehicle) | length == 4 and
    all((all(.present)) and ((map(.world_from_body.x_m) | max - min) +
                             (map(.world_from_body.y_m) | max - min) > 0.05))' >/dev/null 2>&1
}
# Within five seconds of the end of an attack.
all_drive() {
  local _
  for _ in 1 2 3 4 5 6; do all_moved && return; done
  return 1
}
memory_kb() {
  local pid most=0 now
  for pid in "${pids[@]}"; do
    now=$(sed -n 's/^VmRSS:[^0-9]*\([0-9]*\).*/\1/p' "/proc/$pid/status" 2>/dev/null || echo 0)
    ((now <= most)) || most=$now
  done
  echo "$most"
}
row() { printf '%-7s %s\n' "$1" "$2"; }

# judge WHAT: no process ended or was restarted, and all drive.
judge() {
  local what=$1 pid why=
  for pid in "${pids[@]}"; do
    [[ -d /proc/$pid ]] || why+=" process $pid is gone;"
  done
  grep -hqs 'the run has ended\|the world refused\|drives on in world\|restarts itself' \
    logs/vehicle-*.log && why+=" a vehicle says: $(grep -h \
      'the run has ended\|the world refused\|drives on in world\|restarts itself' logs/vehicle-*.log |
      tail -n 1);"
  [[ -n $why ]] || all_drive || why+=" not all drive;"
  if [[ -z $why ]]; then
    row ok "$what"
  else
    row FAILED "$what:$why"
    failures=$((failures + 1))
  fi
}

# intrude NAME WHAT [MILLISECONDS]: false where the intruder could not.
intrude() {
  timeout 60 "$ATTACKER" "$1" "$domain" "$qos" 1 "${3:-800}" >attack.out 2>&1 && return
  row FAILED "$2: the intruder could not: $(cat attack.out)"
  failures=$((failures + 1))
  return 1
}

# attack NAME WHAT: for three seconds, for no line says that the target's reader has matched the intruder's writer.
attack() { if intrude "$1" "$2" 3000; then judge "$2"; fi; }

# refused NAME WHAT LOG PATTERN: the refusal is in the log. The writer of the intruder is matched by
# readers one after the other: what is sent before the target's has matched it is lost, so it is sent again.
refused() {
  local _ from
  from=$(wc -l <"logs/$3.log") # an attack before may have had the same answer
  for _ in 1 2 3 4 5 6; do
    intrude "$1" "$2" || return 0
    grep -qs "$4" < <(tail -n "+$((from + 1))" "logs/$3.log") && judge "$2" && return
  done
  row FAILED "$2: $3 did not say that it refused"
  failures=$((failures + 1))
}

all_drive || {
  row FAILED "the fleet does not drive before any attack"
  exit 1
}
refused roster-id "a roster entry with a new epoch and another id of the scenario" \
  vehicle-1 'vehicle is 2, must be 1'
refused roster-nan "a roster entry with a place that is no number" \
  vehicle-1 'start_world.x_m is nan'
refused roster-far "a roster entry 100 m off" \
  vehicle-1 'another world is there'
attack roster-ended "a roster entry that says the run has ended"
attack roster-refused "a roster entry that refuses"
refused leave "a leave with every session of the roster" \
  world "another participant's"
refused command "motor commands at 200 Hz under another's id, of now and of ticks to come" \
  world 'another participant joined with this id'
attack scan-ahead "a scan with tick +2^31"
refused scan-ended "scans that say the run has ended" \
  vehicle-1 "is not the world's"
refused order "an order with the discovery server of the intruder" \
  vehicle-1 'refused an order'

# An order of the operator, said again and again by another.
"$ATTACKER" replay "$domain" "$qos" 1 6000 >replay.out 2>&1 &
replay=$!
for _ in $(seq 100); do
  grep -qs listens replay.out && break
  sleep 0.05
done
sleep 1
sed '/profile_name="fleet_beacon_reader"/,/<\/data_/ s/<nanosec>150000000/<nanosec>180000000/' \
  "$qos" >deadline.xml
"$FLEETCTL" qos apply deadline.xml --to 1 --domain "$domain" >apply.out 2>&1 ||
  { row FAILED "the operator's own order: $(tail -n 3 apply.out)" && failures=$((failures + 1)); }
wait "$replay" || true
grep -qs 'replayed [1-9]' replay.out || {
  row FAILED "no order was there to be replayed: $(cat replay.out)"
  failures=$((failures + 1))
}
grep -qs 'not above those before' logs/vehicle-1.log || {
  row FAILED "a replayed order: vehicle-1 did not say that it refused"
  failures=$((failures + 1))
}
judge "an operator's order, replayed"
runs=$(grep -c 'runs with the QoS of deadline.xml' logs/vehicle-1.log || true)
[[ $runs -eq 1 ]] || {
  row FAILED "the replayed order was carried out: $runs times in all"
  failures=$((failures + 1))
}

before=$(memory_kb)
attack ids "up to 100 000 ids of one process, of beacons and commands"
row "" "        $(tail -n 1 attack.out)"
attack sybil "up to 30 000 joins of ten participants"
row "" "        $(tail -n 1 attack.out)"
after=$(memory_kb)
if ((after - before > 16 * 1024)); then
  row FAILED "memory: the largest process took $((after - before)) kB more"
  failures=$((failures + 1))
else
  row ok "memory: the largest process took $((after - before)) kB more"
fi

kill -INT "$fleet" 2>/dev/null || true
wait "$fleet" || true
contacts=$(jq .contacts run.json 2>/dev/null || echo none)
if [[ $contacts == 0 ]]; then
  row ok "no contact in the whole of it"
else
  row FAILED "contacts: $contacts"
  failures=$((failures + 1))
fi
[[ $failures -eq 0 ]]
