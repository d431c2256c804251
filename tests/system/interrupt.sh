#!/usr/bin/env bash
# Ctrl-C is a clean stop: exit code 1, reason "interrupted", everyone leaves in good order. SIGTERM is
# the same; a second Ctrl-C does not wait. The bound on the time is a guard against hanging, not a
# measurement: a quiet machine takes under half a second, a busy one longer.
source "$(dirname "${BASH_SOURCE[0]}")/fleet.sh"

now_ms() { echo $(($(date +%s%N) / 1000000)); }

# interrupt NAME SECONDS SIGNAL...: sends the signals that long after the start, 50 ms apart.
interrupt() {
  local name=$1 delay=$2 run world domain begun code=0 signal
  shift 2
  "$FLEETCTL" run intersection_yield --json >"$SCRATCH/out.json" 2>"$SCRATCH/err" &
  run=$!
  world=$(wait_for_child "$run" world) || {
    fail "$name: never started"
    return
  }
  domain=$(domain_of "$world")
  sleep "$delay"
  begun=$(now_ms)
  for signal in "$@"; do
    kill -s "$signal" "$run" || true
    sleep 0.05
  done
  all_gone "$domain" 40 || fail "$name: left over: $(processes_on "$domain" | xargs)"
  local took=$(($(now_ms) - begun))
  wait "$run" || code=$?
  [[ $took -le 3000 ]] || fail "$name: it took $took ms until all were gone"
  [[ $code -eq 1 ]] || fail "$name: exit code $code"
  jq -e '.verdict == "failed" and .reason == "interrupted"' "$SCRATCH/out.json" >/dev/null ||
    fail "$name: the report says $(cat "$SCRATCH/out.json")"
  if [[ $# -eq 1 ]] && grep -q 'did not leave in good order' "$SCRATCH/err"; then
    fail "$name: $(tail -n 5 "$SCRATCH/err")"
  fi
  echo "$name: gone after $took ms" >&2
}

# A vehicle that got a second SIGTERM while it was already leaving died of it instead of exiting 0.
again_and_again() {
  local vehicle code try signal
  for ((try = 0; try < 5; ++try)); do
    code=0
    "$(dirname "$FLEETCTL")/giveway-vehicle" --scenario wall_only --id 1 --domain "$1" 2>/dev/null &
    vehicle=$!
    sleep 0.3
    for ((signal = 0; signal < 300; ++signal)); do
      kill -TERM "$vehicle" 2>/dev/null || break
      sleep 0.001
    done
    wait "$vehicle" || code=$?
    [[ $code -eq 0 ]] || fail "SIGTERM again and again: exit code $code"
  done
}

again_and_again 98
interrupt "Ctrl-C at once" 0 INT
interrupt "Ctrl-C while driving" 4 INT
interrupt "SIGTERM while driving" 3 TERM
interrupt "Ctrl-C twice" 3 INT INT
[[ $failures -eq 0 ]]
