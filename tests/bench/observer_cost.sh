#!/usr/bin/env bash
# What an observer costs a fleet, side by side: pairs of runs without one and with one that a client
# follows; and what it takes itself. Prints a line a run and the medians.
# Usage: observer_cost.sh [--scenario NAME] [--seconds S] [--pairs N]   (fleet_20, 20, 3)
set -euo pipefail
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
programs=${GIVEWAY_BIN_DIR:-$project/build/release/bin}
scenario=fleet_20 seconds=20 pairs=3
while [[ $# -gt 0 ]]; do
  case $1 in
    --scenario) scenario=$2 ;;
    --seconds) seconds=$2 ;;
    --pairs) pairs=$2 ;;
    *)
      echo "unknown argument $1" >&2
      exit 2
      ;;
  esac
  shift 2
done
work=$(mktemp -d)
port=$((20000 + RANDOM % 20000))
trap 'rm -rf "$work"' EXIT

# Clock ticks of processor time that a process has taken.
ticks_of() { awk '{print $14 + $15}' "/proc/$1/stat"; }

# one WITH: a line "WITH misses vehicle_cpu_ms_s observer_cpu_percent observer_rss_MB kB_s".
one() {
  local with=$1 run domain observer='' client='' before=0 after=0 rss=0 kilobytes=0
  "$programs/fleetctl" run "$scenario" --duration "$seconds" --json >"$work/run.json" 2>"$work/run.err" &
  run=$!
  until domain=$(sed -n 's/.* on domain \([0-9]*\)$/\1/p' "$work/run.err") && [[ -n $domain ]]; do sleep 0.1; done
  if [[ $with == with ]]; then
    "$programs/giveway-observer" --domain "$domain" --port "$port" --scenario "$scenario" 2>"$work/observer.err" &
    observer=$!
    until curl -fs "http://127.0.0.1:$port/livez" >/dev/null; do sleep 0.1; done
    curl -sN "http://127.0.0.1:$port/api/v1/stream" >"$work/stream" &
    client=$!
  fi
  sleep $((seconds / 2))
  if [[ -n $observer ]]; then
    before=$(ticks_of "$observer") kilobytes=$(stat -c %s "$work/stream")
    sleep 5
    after=$(ticks_of "$observer") kilobytes=$((($(stat -c %s "$work/stream") - kilobytes) / 5000))
    rss=$(awk '/^VmRSS:/ {print int($2 / 1024)}' "/proc/$observer/status")
  fi
  wait "$run" || true
  [[ -z $client ]] || kill "$client" 2>/dev/null || true
  [[ -z $observer ]] || kill "$observer"
  wait || true
  jq -r --arg with "$with" --argjson cpu $(((after - before) * 200 / $(getconf CLK_TCK))) \
    --argjson rss "$rss" --argjson kb "$kilobytes" \
    '"\($with) misses=\([.. | .deadline_missed? // empty] | add // 0) verdict=\(.verdict) observer_cpu=\($cpu / 10)% rss=\($rss)MB stream=\($kb)kB/s"' \
    "$work/run.json"
}

for ((i = 0; i < pairs; ++i)); do
  one without
  one with
done
