#!/usr/bin/env bash
# Ctrl-C is a clean stop: exit code 1, reason "interrupted", every process leaves in good order. SIGTERM is
# the same, and many in a row count as one request; a second Ctrl-C does not wait. The bound on the time
# guards against hanging, it is not a measurement: a quiet machine takes under half a second, a busy one
# longer.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"

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
  all_gone "$domain" 60 || fail "$name: left over: $(processes_on "$domain" | xargs)"
  local took=$(($(now_ms) - start_ms))
  wait "$run" || code=$?
  [[ $took -le 6000 ]] || fail "$name: it took $took ms until all were gone"
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

# Whether the process is a vehicle with its own handler of SIGTERM: before, it is a shell that has one too.
handles_sigterm() {
  local caught
  caught=$(awk '$1 == "Name:" && $2 != "giveway-vehicle" { exit 1 }
                $1 == "SigCgt:" { print $2 }' "/proc/$1/status") && ((16#$caught >> 14 & 1))
}

# A vehicle that waits for its place, in $vehicle, as soon as it handles SIGTERM.
start_vehicle() {
  local look
  "$(dirname "$FLEETCTL")/giveway-vehicle" --scenario wall_only --id 1 --domain 98 2>/dev/null &
  vehicle=$!
  for ((look = 0; look < 400; ++look)); do
    handles_sigterm "$vehicle" && return
    sleep 0.05
  done
  fail "the vehicle never handled SIGTERM"
}

# expect_left NAME CODES SINCE_MS
expect_left() {
  local code=0
  wait "$vehicle" || code=$?
  [[ $code =~ ^($2)$ ]] || fail "$1: exit code $code"
  (($(now_ms) - $3 < 2000)) || fail "$1: it took $(($(now_ms) - $3)) ms"
}

# A request sent often at once is one request. A busy machine stretches the flood, until the vehicle has
# left and is ended by what follows: such a flood judges nothing, and the next vehicle is sent another.
readonly AT_ONCE_MS=50 # of the 200 that are one request
flood() {
  local vehicle start_ms took pids try
  for try in 1 2 3 4 5; do
    start_vehicle
    printf -v pids "$vehicle %.0s" {1..300}
    start_ms=$(now_ms)
    # shellcheck disable=SC2086  # 300 words
    kill -TERM $pids 2>/dev/null || true
    took=$(($(now_ms) - start_ms))
    if ((took < AT_ONCE_MS)); then
      expect_left "SIGTERM 300 times in $took ms" 0 "$start_ms"
      return
    fi
    expect_left "SIGTERM 300 times in $took ms" '0|143' "$start_ms"
  done
  fail "no flood of SIGTERM was faster than $AT_ONCE_MS ms"
}

# A request sent for longer: a later one ends what has not left yet, as by a shell: 128 + 15.
again_and_again() {
  local vehicle start_ms signal
  start_vehicle
  start_ms=$(now_ms)
  for ((signal = 0; signal < 300; ++signal)); do
    kill -TERM "$vehicle" 2>/dev/null || break
    sleep 0.001
  done
  expect_left "SIGTERM again and again" '0|143' "$start_ms"
}

for _ in 1 2 3; do
  flood
  again_and_again
done
interrupt "Ctrl-C at once" 0 INT
interrupt "Ctrl-C while driving" 4 INT
interrupt "SIGTERM while driving" 3 TERM
interrupt "Ctrl-C twice" 3 INT INT
[[ $failures -eq 0 ]]
