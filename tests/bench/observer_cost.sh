#!/usr/bin/env bash
# The cost of observers to a driving fleet: pairs of two fleets side by side, each in a domain of its own,
# one of them observed. Which of the two starts first alternates. Prints a line a fleet, the ratio of
# each figure (described in fleet_pairs.sh) observed to unobserved, and the observer's own cost.
#
#   client    giveway-observer, and one client that follows the page's stream
#   paused    the same, stopped by SIGSTOP during the measurement
#   killed    the same, ended by kill -9 at the start and at half of that time, and restarted at once
#   unread    giveway-observer, and 16 clients that never read
#   full      fleetctl record onto a full disk, again and again; needs root
#   alone     as client, of a single fleet: the cost of an observer of many vehicles
#
# Usage: observer_cost.sh [--seconds S] [--pairs N] [--vehicles N] [WATCHED ...]   (20, 10, 8, the first five)
set -euo pipefail
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
programs=${GIVEWAY_BIN_DIR:-$project/build/release/bin}
seconds=20 pairs=10 vehicles=8 conditions=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --seconds) seconds=$2 && shift ;;
    --pairs) pairs=$2 && shift ;;
    --vehicles) vehicles=$2 && shift ;;
    client | paused | killed | unread | full | alone) conditions+=("$1") ;;
    *)
      echo "unknown argument $1" >&2
      exit 2
      ;;
  esac
  shift
done
[[ ${#conditions[@]} -gt 0 ]] || conditions=(client paused killed unread full)
work=$(mktemp -d)
source "$project/tests/bench/fleet_pairs.sh"
export GIVEWAY_CONFIG_DIR=${GIVEWAY_CONFIG_DIR:-$project/config}
folder=([with]=$programs [without]=$programs)
port=$((20000 + RANDOM % 20000))
watchers=() # processes that watch, but for the observer
observer=''
ended() {
  end_watching
  end_fleets
  umount "$work/disk" 2>/dev/null || true
  rm -rf "$work"
}
trap ended EXIT

# Crossings of eight vehicles each, too far apart to receive each other.
bash "$project/tests/deploy/fleet_scenario.sh" "$vehicles" $(((vehicles + 7) / 8)) "$vehicles" |
  sed 's/^duration_s:.*/duration_s: 3600/' >"$work/fleet.textproto"

start_observer() {
  "$programs/giveway-observer" --domain "${domain[with]}" --port "$port" --scenario "$work/fleet.textproto" \
    2>>"$work/observer.err" &
  observer=$!
}
# follow: reads the stream, and connects again by itself as the page does.
follow() {
  until curl -fsN "http://127.0.0.1:$port/api/v1/stream" >>"$work/stream"; do sleep 0.2; done
}
# ignore: asks for the stream, never reads it, and asks again after it was left.
ignore() {
  while sleep 0.2; do
    exec 5<>"/dev/tcp/127.0.0.1/$port" || continue
    printf 'GET /api/v1/stream HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n' >&5
    sleep 6
    exec 5>&-
  done 2>/dev/null
}
# record_on_full: a recording onto a disk of 256 kB, again and again; each is ended by it.
record_on_full() {
  while sleep 0.2; do
    rm -f "$work/disk"/*
    "$programs/fleetctl" record "$work/disk/full.mcap" --domain "${domain[with]}" 2>>"$work/observer.err"
  done
}
in_background() { # FUNCTION [TIMES]: in processes of their own, each the first of a session
  local i
  for ((i = 0; i < ${2:-1}; ++i)); do
    setsid bash -c "$(declare -f "$1"); port=$port programs=$programs work=$work; declare -A domain=([with]=${domain[with]}); $1" &
    watchers+=($!)
  done
}
start_watching() { # CONDITION
  case $1 in
    full)
      mkdir -p "$work/disk"
      mountpoint -q "$work/disk" || mount -t tmpfs -o size=256k none "$work/disk"
      in_background record_on_full
      ;;
    unread)
      start_observer
      in_background ignore 16
      ;;
    *)
      start_observer
      in_background follow
      ;;
  esac
}
end_watching() {
  local process
  for process in "${watchers[@]}"; do kill -- -"$process" 2>/dev/null || true; done
  [[ -z $observer ]] || kill -CONT "$observer" 2>/dev/null || true
  [[ -z $observer ]] || kill "$observer" 2>/dev/null || true
  for process in "${watchers[@]}" $observer; do wait "$process" 2>/dev/null || true; done
  watchers=() observer=''
}

observer_ns() { cat "/proc/$observer/task"/*/schedstat | awk '{sum += $1} END {printf "%.0f\n", sum}'; }
while_watched() {
  local before
  case $condition in
    paused)
      kill -STOP "$observer"
      sleep "$seconds"
      kill -CONT "$observer"
      ;;
    killed)
      for ((half = 0; half < 2; ++half)); do
        kill -KILL "$observer"
        wait "$observer" 2>/dev/null || true
        start_observer
        sleep "$(jq -n "$seconds / 2")"
      done
      ;;
    full) sleep "$seconds" ;;
    *)
      before=$(observer_ns)
      sleep "$seconds"
      awk -v condition="$condition" -v ns=$(($(observer_ns) - before)) -v seconds="$seconds" '
        /^VmRSS:/ {printf "%s observer %.1f %% of a core, %.1f MB\n", condition, ns / seconds / 1e7, $2 / 1024}' \
        "/proc/$observer/status" >>"$work/observer.$condition"
      ;;
  esac
}

(IFS=$'\t' && echo "watched	${FIGURES[*]}")
for condition in "${conditions[@]}"; do
  for ((pair = 1; pair <= pairs; ++pair)); do
    if [[ $condition == alone ]]; then
      start_fleet with "$pair" "$work/fleet.textproto"
      sleep 6
      start_watching alone
      sleep 4
      while_watched
      end_watching
      end_fleets
      continue
    fi
    order=(with without)
    ((pair % 2)) || order=(without with)
    for name in "${order[@]}"; do start_fleet "$name" "$pair" "$work/fleet.textproto"; done
    sleep 6
    start_watching "$condition"
    sleep 4 # all drive, and the announcements of the start are over
    watch "${order[@]}"
    end_watching
    end_fleets
    for name in with without; do
      line=$(figures "$name") # stops here where they do not hold
      printf '%s\t%s\n' "$name" "$line" | tee -a "$work/lines.$condition" | sed "s/^with\t/$condition\t/; s/^without/-/"
    done
  done
  echo "== $condition"
  [[ $condition == alone ]] || ratios "$work/lines.$condition"
  cat "$work/observer.$condition" 2>/dev/null || true
done
