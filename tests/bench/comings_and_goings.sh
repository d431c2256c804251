#!/usr/bin/env bash
# Vehicles that join and leave must cost nothing afterwards. A measurement, not a test: exit code 0 for
# any result, 2 if a process could not be run. On loopback, in a domain of its own.
#
#   bash tests/bench/comings_and_goings.sh departed [COUNT]   CPU of a world, and of a vehicle that
#       stays, before and after so many vehicles (default 64, then 200) came and left; with KILL=1
#       they die by kill -9
#   bash tests/bench/comings_and_goings.sh returns [COUNT]    memory of a world over so many kill -9 of
#       vehicles that come back (default 700), four at a time
#   bash tests/bench/comings_and_goings.sh flood [REQUESTS SECONDS]   late ticks and log lines of a
#       world that is asked for places (default 30000 in 6 s); takes the target join_flood
#
# GIVEWAY_BIN_DIR says where the programs are, DOMAIN which domain is taken (default 41).
set -euo pipefail
cd "$(dirname "$0")/../.."
bin=${GIVEWAY_BIN_DIR:?folder of the programs}
domain=${DOMAIN:-41}
what=${1:?departed, returns or flood}
scratch=$(mktemp -d)
started=()
# Only what was started here, by its id.
end_all() {
  kill -9 "${started[@]}" 2>/dev/null || true
  wait 2>/dev/null || true
  rm -rf "$scratch"
}
trap end_all EXIT

# Places far from each other; at most 32, because above that samples are sent to a dead participant for
# twenty seconds instead of ten. A dead vehicle is removed after a second, or comes back to where it
# stands.
case $what in returns) removal=30 columns="0" ;; *) removal=1 columns="0 12 24 36 48 60" ;; esac
{
  echo 'name: "comings" description: "Vehicles come and go." crossing { x_m: 0 y_m: 0 }'
  echo "start_with: 1 duration_s: 86400 remove_after_s: $removal expect {}"
  for x in $columns; do
    for y in 0 12 24 36 48; do
      echo "spawn { start { x_m: $x y_m: $y heading_deg: 0 } cruise_m_s: 0.3 }"
    done
  done
} >"$scratch/comings.textproto"

start() { # NAME PROGRAM FLAG...: its id is in $pid; NAME_beside is in a second, undisturbed fleet
  local there=$domain
  [[ $1 != *_beside ]] || there=$((domain + 1))
  "$bin/$2" --scenario "$scratch/comings.textproto" --domain "$there" "${@:3}" 2>"$scratch/$1.log" &
  pid=$!
  started+=("$pid")
}
says() { # NAME TEXT: waits until its log has it
  local turn
  for ((turn = 0; turn < 300; ++turn)); do
    grep -q "$2" "$scratch/$1.log" && return
    sleep 0.1
  done
  tail -3 "$scratch/$1.log" >&2
  echo "$1 never said: $2" >&2
  exit 2
}
cpu_ns() { awk '{all += $1} END {printf "%.0f\n", all}' /proc/"$1"/task/*/schedstat; }
# cpu SECONDS PID...: ms of processor time a second, of each
cpu() {
  local seconds=$1 before=() pid i=0
  shift
  for pid; do before+=("$(cpu_ns "$pid")"); done
  sleep "$seconds"
  for pid; do
    awk -v a="${before[i]}" -v b="$(cpu_ns "$pid")" -v s="$seconds" 'BEGIN {printf "%.1f ", (b - a) / 1e6 / s}'
    i=$((i + 1))
  done
  echo
}
memory_kib() { awk '/^Rss:/ {rss = $2} /^Anonymous:/ {anonymous = $2} END {print anonymous}' /proc/"$1"/smaps_rollup; }

port=$((18500 + domain))
start world giveway-world --health-port "$port"
world=$pid

case $what in
  departed)
    start staying giveway-vehicle --id 1
    staying=$pid
    says world 'started with'
    sleep 3
    # Where nothing comes or goes: what the machine itself changes meanwhile.
    start world_beside giveway-world
    world_beside=$pid
    start staying_beside giveway-vehicle --id 1
    control=("$world_beside" "$pid")
    says world_beside 'started with'
    sleep 3
    echo "ms/s of the world, of the vehicle that stays; and of an undisturbed world and vehicle"
    echo "before: $(cpu 20 "$world" "$staying" "${control[@]}")"
    id=1000
    for total in ${2:-64 200}; do
      while ((id < 1000 + total)); do
        batch=()
        for ((i = 0; i < 8 && id < 1000 + total; ++i, ++id)); do
          start "v$id" giveway-vehicle --id "$id"
          batch+=("$pid")
        done
        # By its own log: of many events in a second the world's names some.
        for ((i = id - ${#batch[@]}; i < id; ++i)); do says "v$i" ' cruise'; done
        sleep 1
        if [[ -n ${KILL:-} ]]; then kill -9 "${batch[@]}"; else kill "${batch[@]}"; fi
        wait "${batch[@]}" 2>/dev/null || true
      done
      sleep 15 # the leases of those that died
      echo "after $total: $(cpu 20 "$world" "$staying" "${control[@]}")"
    done
    ;;
  returns)
    start staying giveway-vehicle --id 1
    says world 'started with'
    # What is kept of those that were there fills within the first 200: 64 refusals in the roster,
    # 256 writers, 128 endpoints, and the proxies of as many participants as are ever known at once.
    echo "returns, anonymous memory of the world in KiB"
    for ((n = 0; n <= ${2:-700}; n += 4)); do
      if ((n % 100 == 0)); then
        sleep 14 # the leases of those that died
        echo "$n $(memory_kib "$world")"
      fi
      back=()
      for id in 2 3 4 5; do
        : >"$scratch/back$id.log"
        start "back$id" giveway-vehicle --id "$id"
        back+=("$pid")
      done
      for id in 2 3 4 5; do
        for ((i = 0; i < 300; ++i)); do
          grep -q ' cruise' "$scratch/back$id.log" && break
          sleep 0.05
        done
      done
      kill -9 "${back[@]}"
      wait "${back[@]}" 2>/dev/null || true
      started=("${started[@]:0:${#started[@]}-4}")
    done
    ;;
  flood)
    start staying giveway-vehicle --id 1
    says world 'started with'
    late() { curl -s "http://127.0.0.1:$port/metrics" | grep '_late_ticks' | grep -v '#'; }
    lines=$(wc -l <"$scratch/world.log")
    late
    "$bin/join_flood" "$domain" "${2:-30000}" "${3:-6}" config/qos/default.xml
    late
    echo "lines logged: $(($(wc -l <"$scratch/world.log") - lines))"
    grep -c 'joined the run' "$scratch/world.log" | sed 's/^/ghosts and others that joined: /'
    kill -TERM "$world"
    wait "$world" 2>/dev/null || true
    tail -4 "$scratch/world.log"
    tail -2 "$scratch/staying.log"
    ;;
  *)
    echo "unknown: $what; see the head of $0" >&2
    exit 2
    ;;
esac
