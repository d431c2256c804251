#!/usr/bin/env bash
# What a fleet of N vehicles costs, measured: the figures that fleetctl plan uses.
# Every fleet drives parallel lanes in a network namespace of its own, where all hear all.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"

usage() {
  cat <<'TEXT'
Usage: bash tests/bench/fleet_costs.sh [--seconds S] [--qos SET] [N ...]

Runs a fleet of each size (2 8 16 32), waits until it drives, watches it for S seconds (20), and
prints a line a size:
  vehicle_cpu_ms_s    processor time of a vehicle a second, mean
  world_cpu_ms_s      of the world
  observer_cpu_ms_s   of fleetctl run, which watches
  vehicle_mib         private memory of a vehicle, mean
  world_mib, observer_mib   of the world, of fleetctl
  threads, sockets, files   of a vehicle; UDP sockets, open descriptors
  packets_s           on the loopback interface, all, while driving
  kbytes_s            of these
  start_packets       from the start until all drive, above those of driving
  start_s             how long that took
Needs root, for the namespaces.
TEXT
}

seconds=20 qos=default sizes=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --seconds) seconds=$2 && shift ;;
    --qos) qos=$2 && shift ;;
    --help | -h) usage && exit 0 ;;
    *[!0-9]* | '') usage >&2 && exit 2 ;;
    *) sizes+=("$1") ;;
  esac
  shift
done
[[ ${#sizes[@]} -gt 0 ]] || sizes=(2 8 16 32)

if [[ -z ${FLEET_COSTS_INSIDE:-} ]]; then
  FLEET_COSTS_INSIDE=1 exec unshare -n bash "$0" --seconds "$seconds" --qos "$qos" "${sizes[@]}"
fi
ip link set lo up multicast on
ip route add multicast 224.0.0.0/4 dev lo 2>/dev/null || true

lanes() {
  local i
  cat <<'TEXT'
name: "fleet_costs"
description: "Parallel lanes at low speed: all vehicles receive each other, none conflicts."
duration_s: 3600
start_timeout_s: 120
emission_radius_m: 1000
expect { any_halted: true any_arrived: true }
TEXT
  for ((i = 1; i <= $1; ++i)); do
    echo "vehicle { id: $i start { x_m: 0 y_m: $((3 * i)) heading_deg: 0 } cruise_m_s: 0.05" \
      "goal { x_m: 1000 y_m: $((3 * i)) } }"
  done
}

# Packets and bytes received on lo so far.
wire() { awk '/^ *lo:/ {print $3, $2}' /proc/net/dev; }

# Ticks of a hundredth of a second, user and system, of the processes named.
ticks_of() {
  local pid stat sum=0
  for pid in "$@"; do
    stat=$(<"/proc/$pid/stat")
    # shellcheck disable=SC2086  # fields behind the name
    set -- ${stat##*) }
    sum=$((sum + ${12} + ${13}))
  done
  echo "$sum"
}

private_kib() {
  awk '/^Private_(Clean|Dirty):/ {sum += $2} END {print sum}' "/proc/$1/smaps_rollup"
}

mean_of() {
  local pid sum=0 count=0 command=$1
  shift
  for pid in "$@"; do
    sum=$((sum + $("$command" "$pid")))
    count=$((count + 1))
  done
  echo $((sum / count))
}

# shellcheck disable=SC2317  # mean_of calls these by their names
threads_of() { awk '/^Threads:/ {print $2}' "/proc/$1/status"; }
# shellcheck disable=SC2317
files_of() { find "/proc/$1/fd" -mindepth 1 | wc -l; }
# shellcheck disable=SC2317
udp_sockets_of() {
  local inodes
  inodes=$(find "/proc/$1/fd" -lname 'socket:*' -printf '%l\n' | tr -dc '0-9\n')
  awk 'NR == FNR {mine[$1]; next} $10 in mine' <(echo "$inodes") "/proc/$1/net/udp" | wc -l
}

# Until all say that they drive.
wait_until_running() {
  local deadline=$((SECONDS + 120))
  until [[ $(grep -l ': cruise (' "$1"/vehicle*.log 2>/dev/null | wc -l) -eq $2 ]]; do
    ((SECONDS < deadline)) || return 1
    sleep 0.1
  done
}

measure() {
  local count=$1 logs="$SCRATCH/logs-$1" started_ns world vehicles pid arguments
  lanes "$count" >"$SCRATCH/lanes-$count.textproto"
  started_ns=$(date +%s%N)
  read -r packets_0 _ <<<"$(wire)"
  "$FLEETCTL" run "$SCRATCH/lanes-$count.textproto" --qos "$qos" --logs "$logs" \
    >"$SCRATCH/out" 2>&1 &
  fleet=$!
  wait_until_running "$logs" "$count" || {
    fail "$count vehicles do not all drive: $(tail -n 3 "$SCRATCH/out")"
    kill "$fleet"
    return
  }
  start_ms=$((($(date +%s%N) - started_ns) / 1000000))
  read -r packets_1 _ <<<"$(wire)"
  sleep 3 # the announcements of the start are over
  world='' vehicles=()
  for pid in $(children_of "$fleet"); do
    read_arguments "$pid"
    case $arguments in
      */giveway-world\ *) world=$pid ;;
      */giveway-vehicle\ *) vehicles+=("$pid") ;;
    esac
  done
  local cpu_v cpu_w cpu_o packets bytes packets_end bytes_end span
  cpu_v=$(ticks_of "${vehicles[@]}") cpu_w=$(ticks_of "$world") cpu_o=$(ticks_of "$fleet")
  read -r packets bytes <<<"$(wire)"
  span=$(date +%s%N)
  sleep "$seconds"
  cpu_v=$(($(ticks_of "${vehicles[@]}") - cpu_v)) cpu_w=$(($(ticks_of "$world") - cpu_w))
  cpu_o=$(($(ticks_of "$fleet") - cpu_o))
  read -r packets_end bytes_end <<<"$(wire)"
  span=$((($(date +%s%N) - span) / 1000000))
  awk -v n="$count" -v v="$cpu_v" -v w="$cpu_w" -v o="$cpu_o" -v ms="$span" -v p=$((packets_end - packets)) \
    -v b=$((bytes_end - bytes)) -v mem="$(mean_of private_kib "${vehicles[@]}")" \
    -v wmem="$(private_kib "$world")" -v omem="$(private_kib "$fleet")" -v threads="$(mean_of threads_of "${vehicles[@]}")" \
    -v sockets="$(mean_of udp_sockets_of "${vehicles[@]}")" \
    -v files="$(mean_of files_of "${vehicles[@]}")" -v start=$((packets_1 - packets_0)) \
    -v start_ms="$start_ms" 'BEGIN {
      s = ms / 1000
      printf "%8d %16.1f %14.1f %17.1f %11.1f %9.1f %12.1f %7d %7d %5d %9.0f %8.0f %13d %7.1f\n",
        n, v * 10 / n / s, w * 10 / s, o * 10 / s, mem / 1024, wmem / 1024, omem / 1024, threads,
        sockets, files, p / s, b / 1024 / s, start, start_ms / 1000
    }'
  kill -INT "$fleet"
  wait "$fleet" || true
}

printf '%8s %16s %14s %17s %11s %9s %12s %7s %7s %5s %9s %8s %13s %7s\n' vehicles \
  vehicle_cpu_ms_s world_cpu_ms_s observer_cpu_ms_s vehicle_mib world_mib observer_mib threads \
  sockets files packets_s kbytes_s start_packets start_s
for size in "${sizes[@]}"; do measure "$size"; done
exit $((failures > 0))
