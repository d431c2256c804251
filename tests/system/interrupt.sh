#!/usr/bin/env bash
# Ctrl-C is a clean stop: exit code 1, reason "interrupted", every process leaves in good order. SIGTERM is
# the same, and many in a row count as one request; a second Ctrl-C does not wait. The bound on the time
# guards against hanging, it is not a measurement: a quiet machine takes under half a second, a busy one
# longer.
source "$(dirname "${BASH_SOURCE[0]}")/fleet.sh"

now_ms() { echo $(($(date +%s%N) / 1000000)); }

# interrupt NAME SECONDS SIGNAL...: sends the signals that long after the start, 50 ms apart.
interrupt() {
  local name=$1 delay=$2 run world domain start_ms code=0 signal
  shift 2
  # The picture does not fit on the disk: the verdict is given nevertheless, and is the only one.
  (
    ulimit -f 4 # KiB
    exec "$FLEETCTL" run intersection_yield --json --picture "$SCRATCH/picture.svg"
  ) >"$SCRATCH/out.json" 2>"$SCRATCH/err" &
  run=$!
  world=$(wait_for_child "$run" world) || {
    fail "$name: never started"
    return
  }
  domain=$(domain_of "$world")
  sleep "$delay"
  start_ms=$(now_ms)
  for signal in "$@"; do
    kill -s "$signal" "$run" || true
    sleep 0.05
  done
  all_gone "$domain" 40 || fail "$name: left over: $(processes_on "$domain" | xargs)"
  local took=$(($(now_ms) - start_ms))
  wait "$run" || code=$?
  [[ $took -le 3000 ]] || fail "$name: it took $took ms until all were gone"
  [[ $code -eq 1 ]] || fail "$name: exit code $code"
  jq -se 'length == 1 and (.[0] | .verdict == "failed" and .reason == "interrupted")' \
    "$SCRATCH/out.json" >/dev/null || fail "$name: the report says $(cat "$SCRATCH/out.json")"
  grep -q 'picture.svg: cannot be written: File too large' "$SCRATCH/err" ||
    fail "$name: the picture: $(tail -n 3 "$SCRATCH/err")"
  [[ -z $(find "$SCRATCH" -name 'picture.svg*') ]] || fail "$name: half a picture"
  if [[ $# -eq 1 ]] && grep -q 'did not leave in good order' "$SCRATCH/err"; then
    fail "$name: $(tail -n 5 "$SCRATCH/err")"
  fi
  echo "$name: gone after $took ms" >&2
}

# again_and_again NAME CODES SECONDS_BETWEEN: a vehicle is sent SIGTERM until it is gone. Many in quick
# succession count as one request; a later one ends what has not left yet, as by a shell: 128 + 15.
again_and_again() {
  local vehicle code=0 signal start_ms
  "$(dirname "$FLEETCTL")/giveway-vehicle" --scenario wall_only --id 1 --domain 98 2>/dev/null &
  vehicle=$!
  sleep 0.3
  start_ms=$(now_ms)
  for ((signal = 0; signal < 300; ++signal)); do
    kill -TERM "$vehicle" 2>/dev/null || break
    [[ $3 == 0 ]] || sleep "$3"
  done
  wait "$vehicle" || code=$?
  [[ $code =~ ^($2)$ ]] || fail "$1: exit code $code"
  (($(now_ms) - start_ms < 2000)) || fail "$1: it took $(($(now_ms) - start_ms)) ms"
}

for _ in 1 2 3; do
  again_and_again "SIGTERM 300 times at once" 0 0
  again_and_again "SIGTERM again and again" '0|143' 0.001
done
interrupt "Ctrl-C at once" 0 INT
interrupt "Ctrl-C while driving" 4 INT
interrupt "SIGTERM while driving" 3 TERM
interrupt "Ctrl-C twice" 3 INT INT
[[ $failures -eq 0 ]]
