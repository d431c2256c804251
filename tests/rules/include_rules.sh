#!/usr/bin/env bash
# Checks what a compiler does not: which room may include which, that the pure rooms know no thread
# and no clock, and that files stay small and named after an idea.
# Usage: include_rules.sh [ROOT]; a line for each violation; exit code 1 if there is one.
set -euo pipefail
root=${1:-$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)}
cd "$root"

LONGEST_FILE=500
PURE_ROOMS='types vehicle sim_world virtual qos'
# Standard headers the pure rooms do without: threads, clocks of the wall, files, and the streams
# nobody there has anything to say to.
IMPURE='^(thread|mutex|shared_mutex|atomic|condition_variable|future|semaphore|latch|barrier)$'
IMPURE+='|^(stop_token|coroutine|filesystem|fstream|iostream|ctime|random|time\.h|csignal)$'
# These differ from one C library or CPU to the next; services/types has its own.
INEXACT='std::(sin|cos|tan|asin|acos|atan|atan2|exp|exp2|expm1|log|log2|log10|log1p|pow|hypot|cbrt)\('

violations=0
violation() {
  printf '%s\n' "$*"
  violations=$((violations + 1))
}

# The room a file belongs to, by its path.
room_of() {
  case $1 in
    services/types/*) echo types ;;
    services/vehicle/*) echo vehicle ;;
    services/link/*) echo link ;;
    services/qos/*) echo qos ;;
    services/app/*) echo app ;;
    services/fleetctl/*) echo fleetctl ;;
    services/*/*) echo nowhere ;;
    services/*) echo vehicle_main ;; # the wiring of giveway-vehicle, and what the mains share
    sim_world/world_main.cc | sim_world/world_loop.*) echo world_main ;; # wires giveway-world
    sim_world/virtual/*) echo virtual ;;
    sim_world/*) echo sim_world ;;
    tests/*) echo tests ;;
    *) echo nowhere ;;
  esac
}

# Which of our own headers a room may include. Paths are those of the include line.
may_include() {
  case $1 in
    types) [[ $2 == services/types/* ]] ;;
    vehicle) [[ $2 == services/@(vehicle|types)/* ]] ;;
    sim_world) [[ $2 == services/types/* || ($2 == sim_world/* && $2 != sim_world/virtual/*) ]] ;;
    virtual) [[ $2 == services/@(types|vehicle)/* || $2 == sim_world/* ]] ;;
    link) [[ $2 == services/@(link|types)/* || $2 == fleet*.h || $2 == idl/* ]] ;;
    qos) [[ $2 == services/@(qos|types)/* ]] ;;
    app) [[ $2 == services/@(app|types)/* || $2 == *.pb.h ]] ;;
    fleetctl) [[ $2 == services/@(fleetctl|vehicle|link|app|qos|types)/* || $2 == sim_world/virtual/* ]] ;;
    vehicle_main)
      [[ $2 == services/@(vehicle|link|qos|app|types)/* ||
        $2 == services/@(beacon_news|deaf_watch|service_admin|vehicle_health|vehicle_hearing|vehicle_join|vehicle_report|service_main|service_run|server_wait|qos_at_start|world_time).h ]]
      ;;
    world_main)
      [[ $2 == services/@(link|qos|app|types)/* || $2 == sim_world/* || $2 == services/@(service_admin|service_main|service_run|server_wait|qos_at_start).h ]]
      ;;
    tests) true ;;
    *) false ;;
  esac
}

check_system_include() {
  local file=$1 room=$2 header=$3
  case $header in
    fastdds/* | fastrtps/* | fastcdr/*)
      [[ $room == link || $room == tests ]] ||
        violation "$file: <$header>: only services/link knows Fast DDS"
      return
      ;;
    google/protobuf/* | spdlog/*)
      [[ $room == app || $room == tests ]] ||
        violation "$file: <$header>: only services/app knows Protobuf and spdlog"
      return
      ;;
    httplib.h | prometheus/*)
      [[ $file == services/app/health_@(server|metrics).cc || $room == tests ]] ||
        violation "$file: <$header>: only services/app/health_server.cc and _metrics.cc know it"
      return
      ;;
    CLI/*)
      [[ $room == @(app|fleetctl|vehicle_main|world_main|tests) ]] ||
        violation "$file: <$header>: only the edges know the command line"
      return
      ;;
  esac
  # How XML is read, and the values in it, is the concern of two files.
  [[ $file == services/qos/xml_@(tree|value).cc && $header == tinyxml2.h ]] && return
  [[ $file == services/qos/compose.cc && $header == yaml-cpp/* ]] && return
  # Vector registers are the language's concern, not another room's; one file may name them.
  [[ $file == sim_world/sonar_kernel.cc && $header == immintrin.h ]] && return
  [[ " $PURE_ROOMS " == *" $room "* ]] || return 0
  if [[ $header =~ $IMPURE ]]; then
    violation "$file: <$header>: $room is pure"
  elif [[ $header == */* && $header != Eigen/* || $header == *.h ]]; then
    violation "$file: <$header>: $room uses the standard library and Eigen alone"
  fi
}

check_includes() {
  local file=$1 room=$2 kind header
  while read -r kind header; do
    if [[ $kind == '"' ]]; then
      may_include "$room" "$header" || violation "$file: \"$header\": no arrow from $room to there"
    else
      check_system_include "$file" "$room" "$header"
    fi
  done < <(sed -nE 's/^[[:space:]]*#[[:space:]]*include[[:space:]]*(["<])([^">]+)[">].*/\1 \2/p' \
    "$file")
}

check_text() {
  local file=$1 room=$2
  if [[ " $PURE_ROOMS " == *" $room "* ]]; then
    if grep -q '_clock::now' "$file"; then
      violation "$file: reads a clock: time is an argument in $room"
    fi
    if grep -Eq "$INEXACT" "$file"; then
      violation "$file: a C library function whose bits differ by CPU: see services/types/math.h"
    fi
  fi
  if [[ $file == tests/unit/* ]] && grep -Eq 'sleep_for|sleep_until|usleep' "$file"; then
    violation "$file: a unit test sleeps"
  fi
  local lines
  lines=$(wc -l <"$file")
  if ((lines > LONGEST_FILE)); then
    violation "$file: $lines lines; more than $LONGEST_FILE are more than one idea"
  fi
}

shopt -s extglob
count=0
while IFS= read -r file; do
  file=${file#./}
  room=$(room_of "$file")
  [[ $room != nowhere ]] || violation "$file: belongs to no room"
  [[ $file =~ (^|/|_)(utils?|common|helpers?|managers?)(/|_|\.) ]] &&
    violation "$file: named after nothing; name the idea"
  check_includes "$file" "$room"
  check_text "$file" "$room"
  count=$((count + 1))
done < <(find . -path ./build -prune -o -path ./.git -prune -o \
  -type f \( -name '*.h' -o -name '*.cc' \) -print | sort)

printf '%d files, %d violations\n' "$count" "$violations"
[[ $violations -eq 0 && $count -gt 0 ]]
