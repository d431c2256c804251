#!/usr/bin/env bash
# fleetctl run --restart: a vehicle that is killed, and the world, are started again and drive on; the
# run does not end, and no two bodies touch. Nor does it end where one cannot be started for a while.
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
cat >"$SCRATCH/two_lanes.textproto" <<'TEXT'
name: "two_lanes"
duration_s: 0
start_with: 2
spawn { start { x_m: -4 y_m: 4 heading_deg: 0 } cruise_m_s: 0.3 waypoint { x_m: 4 y_m: 4 } waypoint { x_m: -4 y_m: 4 } loop: true }
spawn { start { x_m: -4 y_m: -4 heading_deg: 0 } cruise_m_s: 0.3 waypoint { x_m: 4 y_m: -4 } waypoint { x_m: -4 y_m: -4 } loop: true }
expect { contacts: 0 any_arrived: true any_halted: true }
TEXT
"$FLEETCTL" run "$SCRATCH/two_lanes.textproto" --restart --json --logs "$SCRATCH/logs" \
  >"$SCRATCH/report.json" 2>"$SCRATCH/fleet.log" &
PID[fleet]=$!

# drives WHAT SECONDS LOG: waits until that log says so.
drives() {
  local end=$(($(date +%s%N) + $2 * 1000000000)) start_ns
  start_ns=$(date +%s%N)
  until grep -q 'cruise' "$SCRATCH/logs/$3" 2>/dev/null; do
    if (($(date +%s%N) > end)); then
      fail "$1: $3 does not drive in $2 s: $(tail -n 3 "$SCRATCH/logs/$3" "$SCRATCH/fleet.log" 2>&1)"
      return
    fi
    sleep 0.02
  done
  echo "$1: drives after $((($(date +%s%N) - start_ns) / 1000000)) ms" >&2
}
child() { wait_for_child "${PID[fleet]}" "$1"; }

drives "vehicle 1 at first" 15 vehicle-1.log
drives "vehicle 2 at first" 15 vehicle-2.log
sleep 1
kill -9 "$(child 2)"
drives "vehicle 2, killed" 6 vehicle-2+.log
kill -9 "$(child 2)"
drives "vehicle 2, killed again" 6 vehicle-2++.log

# Regression: without the folder of its log it could not be started, and the whole fleet was ended.
mv "$SCRATCH/logs" "$SCRATCH/away"
kill -9 "$(child 2)"
for _ in $(seq 300); do
  [[ $(grep -c 'vehicle 2 cannot be started again now: .*vehicle-2+++.log' "$SCRATCH/fleet.log") -gt 1 ]] && break
  sleep 0.02
done
[[ $(grep -c 'vehicle 2 cannot be started again now: .*vehicle-2+++.log' "$SCRATCH/fleet.log") -gt 1 ]] ||
  fail "a start that failed is not reported and repeated: $(tail -n 3 "$SCRATCH/fleet.log")"
mv "$SCRATCH/away" "$SCRATCH/logs"
kill -0 "$(child 1)" || fail "vehicle 1 does not drive on"
drives "vehicle 2, once it can be started" 10 vehicle-2+++.log

before=$(wc -l <"$SCRATCH/logs/vehicle-1.log")
kill -9 "$(child world)"
for _ in $(seq 300); do
  grep -q 'drives on in world' < <(tail -n "+$((before + 1))" "$SCRATCH/logs/vehicle-1.log") && break
  sleep 0.02
done
grep -q 'drives on in world' < <(tail -n "+$((before + 1))" "$SCRATCH/logs/vehicle-1.log") ||
  fail "the world was not started again: $(cat "$SCRATCH/fleet.log")"
grep -q 'resumes from the checkpoint' "$SCRATCH/logs/world+.log" || fail "the world started from scratch"
sleep 2
"$FLEETCTL" run intersection_yield --restart >"$SCRATCH/closed.log" 2>&1 && fail "a closed fleet is restarted"
grep -q 'a death is the end of its run' "$SCRATCH/closed.log" || fail "$(cat "$SCRATCH/closed.log")"

kill -INT "${PID[fleet]}"
wait "${PID[fleet]}" || true
unset 'PID[fleet]'
[[ $(grep -c 'died and is started again' "$SCRATCH/fleet.log") -eq 4 ]] ||
  fail "fleetctl does not say which processes it restarted: $(cat "$SCRATCH/fleet.log")"
[[ $(jq .contacts "$SCRATCH/report.json") == 0 ]] || fail "contacts: $(cat "$SCRATCH/report.json")"
jq -e '.reason == "interrupted"' "$SCRATCH/report.json" >/dev/null ||
  fail "the run ended by itself: $(cat "$SCRATCH/report.json")"

[[ $failures -eq 0 ]]
