#!/usr/bin/env bash
# kill -9 of each process of a run at several moments: fleetctl names the process that died and exits 1, and
# within two seconds nothing of the run is left: no process, no shared memory.
# Usage: kill_drill.sh [MOMENTS_PER_PROCESS] [SEED]
if [[ -z ${OWN_HOST:-} && $(id -u) -eq 0 ]] && unshare -m true 2>/dev/null; then
  # Its own /dev/shm: that of the machine has files of other fleets.
  # shellcheck disable=SC2016  # the inner shell expands it
  OWN_HOST=1 exec unshare -m bash -c 'mount -t tmpfs none /dev/shm && exec bash "$0" "$@"' "$0" "$@"
fi
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
moments=${1:-${GIVEWAY_KILLS:-2}}
RANDOM=${2:-1} # a seeded sequence: a failure can be repeated

shared_memory() { find /dev/shm -mindepth 1 2>/dev/null | sort; }

# drill PROCESS MILLISECONDS: kills that process so long after the start.
drill() {
  local process=$1 delay_ms=$2 name="$1 after $2 ms" run target domain code=0 before
  before=$(shared_memory)
  "$FLEETCTL" run intersection_yield --json >"$SCRATCH/out.json" 2>"$SCRATCH/err" &
  run=$!
  target=$(wait_for_child "$run" "$([[ $process == fleetctl ]] && echo world || echo "$process")") || {
    fail "$name: never started"
    kill -9 "$run"
    return
  }
  domain=$(domain_of "$target")
  [[ $process == fleetctl ]] && target=$run
  sleep "$((delay_ms / 1000)).$(printf '%03d' $((delay_ms % 1000)))"
  kill -9 "$target" || fail "$name: gone before it was killed"
  if [[ $process == fleetctl ]]; then
    wait "$run" 2>/dev/null || true
    all_gone "$domain" 20 || fail "$name: left over: $(processes_on "$domain" | xargs)"
  else
    all_gone "$domain" 20 || fail "$name: left over: $(processes_on "$domain" | xargs)"
    wait "$run" || code=$?
    [[ $code -eq 1 ]] || fail "$name: fleetctl's exit code is $code"
    jq -e '.verdict == "failed" and .reason == "process_died"' "$SCRATCH/out.json" >/dev/null ||
      fail "$name: the report says $(cat "$SCRATCH/out.json")"
    grep -Eq "^(the )?${process/#[0-9]/vehicle $process}.*signal 9" "$SCRATCH/err" ||
      fail "$name: stderr does not name the process that died: $(tail -n 3 "$SCRATCH/err")"
  fi
  [[ $(shared_memory) == "$before" ]] || fail "$name: new files in /dev/shm"
  echo "$name: done" >&2
}

for ((i = 0; i < moments; ++i)); do
  for process in world 1 2 fleetctl; do
    drill "$process" $((RANDOM % 6000))
  done
done
[[ $failures -eq 0 ]]
