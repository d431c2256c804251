#!/usr/bin/env bash
# Containers end within one second of SIGTERM, with exit code 0; and kill -9, again and again,
# leaves neither files nor memory behind.
#
#   bash tests/containers/shutdown.sh [KILLS]
source "$(dirname "${BASH_SOURCE[0]}")/../support/composed_fleet.sh"
KILLS=${1:-20}
export GIVEWAY_SCENARIO=/drill/lanes.textproto
engine_up
use multicast

stops_in_time() { # CONTAINER
  local pid start_ns code took
  docker update --restart no "$1" >/dev/null
  pid=$(pid_of "$1")
  # Of the process, from the host: the engine takes its time to send the signal and with the rest of the container.
  start_ns=$(date +%s%N)
  kill -TERM "$pid"
  while [[ -n $(start_of "$pid") ]] && (($(date +%s%N) - start_ns < 20000000000)); do sleep 0.01; done
  took=$((($(date +%s%N) - start_ns) / 1000000))
  code=$(timeout 20 docker wait "$1") || code="none in 20 s"
  echo "$(name_of "$1"): exit code $code, $took ms after SIGTERM"
  [[ $code == 0 ]] || fail "$(name_of "$1"): exit code $code"
  [[ $took -le 1000 ]] || fail "$(name_of "$1"): $took ms"
}

shared_files() { find /dev/shm -type f | wc -l; }
shared_files_in() { docker exec "$1" find /dev/shm -type f | wc -l; }
world_bytes() {
  metrics "$(running world)" | awk '$1 == "process_resident_memory_bytes" {printf "%d", $2}'
}

kill_and_start() { # CONTAINER TIMES
  local i
  for i in $(seq "$2"); do
    docker kill "$1" >/dev/null
    docker start "$1" >/dev/null
    await "restart $i" 10 drives "$1" >>"$SCRATCH/restarts"
  done
}

up 3
await "up: all drive" 30 all_drive 3
read -r target other third <<<"$(running vehicle | tr '\n' ' ')"
kill_and_start "$target" 10 # what grows once is not a leak
files=$(shared_files) bytes=$(world_bytes)
[[ $bytes -gt 1000000 ]] || fail "the world does not report its memory: $bytes"
kill_and_start "$target" "$KILLS"
after=$(world_bytes)
[[ $after -gt 1000000 ]] || fail "the world does not report its memory at the end: $after"
grown=$((after - bytes))
echo "$KILLS kill -9 restarts: the world's memory went from $((bytes / 1024)) KiB by $((grown / 1024)) KiB"
sort -t: -k2 -n "$SCRATCH/restarts" | tail -n 1
# Measured over 200: 6 KiB each.
[[ $grown -le $((KILLS * 8192 + 1048576)) ]] || fail "the world's memory grew by $grown bytes"
[[ $(shared_files) -le $files ]] || fail "files were left in /dev/shm of the host"
[[ $(shared_files_in "$target") -eq 0 ]] || fail "files were left in /dev/shm of the container"

stops_in_time "$target"
await "one has left: the others drive on" 5 all_drive 2
stops_in_time "$other"
stops_in_time "$third"
stops_in_time "$(running world)"
no_contact
[[ $failures -eq 0 ]]
