#!/usr/bin/env bash
# Prints one line a figure: `name value bound ok|short`. A figure is a measurement, not a test: the
# exit code is 0 however they come out, and 2 if one could not be taken.
#
#   bash tests/bench/run.sh            every figure
#   bash tests/bench/run.sh step       one group: step, virtual, link, world, peers, right_of_way,
#                                      reaction or rss
#
# The group peers installs Box2D and Embree, which nothing else needs. A bound of - is none.
set -euo pipefail
cd "$(dirname "$0")/../.."
source services/setup.sh
only="${1:-}"
case $only in
  "" | step | virtual | link | world | peers | right_of_way | reaction | rss) ;;
  *) sed -n '2,9s/^# \{0,1\}//p' "$0" >&2 && exit 2 ;;
esac
bin=build/release/bin
[[ -x $bin/fleetctl ]] || bash services/run.sh --setup-only
build release giveway-bench
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

wanted() { [[ -z $only || $1 == "$only" ]]; }

print_figure() { printf '%-32s %10s %10s %s\n' "$@"; }

# figure NAME VALUE BOUND: at most the bound is ok.
figure() {
  print_figure "$@" \
    "$(awk -v value="$2" -v bound="$3" 'BEGIN { print (value <= bound ? "ok" : "short") }')"
}

# figure_at_least NAME VALUE BOUND: the bound or more is ok.
figure_at_least() {
  print_figure "$@" \
    "$(awk -v value="$2" -v bound="$3" 'BEGIN { print (value >= bound ? "ok" : "short") }')"
}

# figure_alone NAME VALUE: nothing is asked of it.
figure_alone() { print_figure "$@" - ok; }

# microbench NAME FIELD: median over repetitions of one field of one benchmark.
microbench() {
  "$bin/giveway-bench" --benchmark_filter="^$1\$" --benchmark_repetitions=5 \
    --benchmark_report_aggregates_only=true --benchmark_format=json 2>"$scratch/err" |
    jq -er --arg field "$2" \
      '.benchmarks[] | select(.aggregate_name == "median") | .[$field] * 100 | round / 100' ||
    { cat "$scratch/err" >&2; exit 2; }
}

# interleaved PROGRAM NAME: runs one benchmark that compares within itself; counter reads from it.
interleaved() {
  "$bin/$1" --benchmark_filter="^$2/" --benchmark_format=json \
    >"$scratch/interleaved.json" 2>"$scratch/err" || { cat "$scratch/err" >&2; exit 2; }
}

# counter NAME DIGITS: a counter of the benchmark last run, rounded.
counter() {
  jq -er --arg name "$1" --argjson scale "1e$2" \
    '.benchmarks[0] | .[$name] * $scale | round / $scale' "$scratch/interleaved.json"
}

# Vehicle::Step with every peer received again every tick, microseconds.
if wanted step; then
  figure step_10_peers_us "$(microbench VehicleStep/10 real_time)" 1
  figure step_100_peers_us "$(microbench VehicleStep/100 real_time)" 10
  figure step_1000_peers_us "$(microbench VehicleStep/1000 real_time)" 150
fi

# Vehicle-hours a minute in virtual time on two cores, 50 vehicles a run with 10 or all 49 in reach;
# and what a vehicle and tick take of one core, in total and outside Vehicle::Step.
if wanted virtual; then
  fleet=VirtualFleetAdvance
  figure_at_least virtual_hours_per_min \
    "$(microbench $fleet/5/real_time/threads:2 vehicle_hours_per_minute)" 500
  figure_alone virtual_hours_per_min_49 \
    "$(microbench $fleet/100/real_time/threads:2 vehicle_hours_per_minute)"
  for part in all=$fleet/5/real_time/threads:1 world=VirtualWorld radio=VirtualRadio/5 \
    invariants=VirtualInvariants; do
    figure_alone "virtual_${part%%=*}_us" \
      "$(microbench "${part#*=}" real_time | awk '{ printf "%.2f", $1 / 50 }')"
  done
fi

# Our link against bare Fast DDS calls in the same loop; medians of the ratios of neighbours.
if wanted link; then
  for part in send take both; do
    figure "link_${part}_ratio" \
      "$(microbench 'LinkOverhead/iterations:4000/manual_time' "${part}_ratio")" 1.1
  done
  # The packet filter, microseconds a packet.
  figure link_filter_us "$(microbench PacketFilterCost packet_us)" 1
  # An impairment that asks for nothing, microseconds a packet.
  figure link_impaired_idle_us \
    "$(microbench 'ImpairedIdle/iterations:500/manual_time' extra_us)" 2
fi

# World::Advance with all 16 ultrasonics, one vehicle per 4 m^2, vehicle-steps a second on one core.
if wanted world; then
  interleaved giveway-bench WorldSizes
  figure_at_least world_steps_per_s "$(counter steps_per_s_1000 0)" 1000000
  figure_alone world_steps_per_s_100 "$(counter steps_per_s_100 0)"
  figure_alone world_steps_per_s_10000 "$(counter steps_per_s_10000 0)"
  figure world_cost_flatness "$(counter flatness 2)" 1.5
  interleaved giveway-bench WorldTiers
  for tier in typical p3dx crosstalk; do
    figure_alone "world_steps_per_s_$tier" "$(counter "steps_per_s_$tier" 0)"
  done
fi

# Against general engines that cast seven rays a cone over the same bodies: their time over ours, of
# the whole world against Box2D and of its sensing alone against Embree, which only senses; how many
# ranges differ by what the sampling does not explain, and by what only grazing does.
if wanted peers; then
  if [[ ! -x $bin/giveway-peers-bench ]]; then
    mapfile -t packages < <(bench_packages)
    install_packages "${packages[@]}"
    cmake --preset release >&2
  fi
  build release giveway-peers-bench
  interleaved giveway-peers-bench WorldAgainstPeers
  figure_at_least world_vs_box2d "$(counter world_vs_box2d 1)" 30
  figure_at_least sonar_vs_embree "$(counter sonar_vs_embree 2)" 5
  figure_alone world_vs_embree "$(counter world_vs_embree 2)"
  for peer in Box2d Embree; do
    interleaved giveway-peers-bench "Agree/$peer"
    figure "range_disagreements_${peer,}" "$(counter disagreements 0)" 0
    figure "range_grazing_ppm_${peer,}" "$(counter grazing_ppm 0)" 1000
  done
fi

# Mean delay beyond the time alone and arrivals a minute, of our vehicles, of a reservation scheme in
# order of arrival and of reciprocal velocity obstacles; contacts, and how many are missing at the end.
# Simulated time. GIVEWAY_CASES sets the seeds a size; with all 40 it takes minutes.
if wanted right_of_way; then
  for place in crossing swarm; do
    echo "driving through the $place" >&2
    interleaved giveway-bench "RightOfWay${place^}"
    if [[ $place == crossing ]]; then
      figure right_of_way_delay_ratio "$(counter delay_ratio 2)" 1.2
      for size in 2 4 8 16 32 50; do
        figure_alone "right_of_way_delay_ratio_$size" "$(counter "delay_ratio_$size" 2)"
      done
    fi
    for driver in cooperative reservation rvo; do
      for size in 2 4 8 16 32 50; do
        figure_alone "${place}_${driver}_delay_s_$size" "$(counter "${driver}_delay_s_$size" 2)"
      done
      figure_alone "${place}_${driver}_delay_s" "$(counter "${driver}_delay_s" 2)"
      figure_alone "${place}_${driver}_per_min" "$(counter "${driver}_per_min" 1)"
      figure "${place}_${driver}_contacts" "$(counter "${driver}_contacts" 0)" 0
      figure "${place}_${driver}_missing" "$(counter "${driver}_missing" 0)" 0
    done
  done
fi

# Publication of the scan or beacon that first shows the cause to application of the command that
# answers it, from real runs of the crossing; at most two ticks plus 2 ms.
if wanted reaction; then
  for run in intersection_yield:1 intersection_yield:2 intersection_equal:1 intersection_equal:2 \
    intersection_avoid:1; do
    echo "running ${run/:/ with seed }" >&2
    "$bin/fleetctl" run "${run%:*}" --seed "${run#*:}" --json \
      >>"$scratch/runs.json" 2>"$scratch/err" || { cat "$scratch/err" >&2; exit 2; }
  done
  worst=$(jq -s 'map(.reaction_ms.p99) | max * 100 | round / 100' "$scratch/runs.json")
  figure reaction_p99_ms "$worst" 102
fi

# Resident memory of vehicle processes with eight peers, ten seconds after the start.
if wanted rss; then
  echo "running nine vehicles" >&2
  "$bin/fleetctl" run tests/bench/nine.textproto --json >"$scratch/nine.json" 2>"$scratch/err" &
  fleet=$!
  sleep 14  # starting and matching takes up to 4 s
  largest=0
  for process in $(pgrep -P "$fleet" -f giveway-vehicle); do
    rss_kib=$(awk '/^VmRSS/ { print $2 }' "/proc/$process/status")
    largest=$((rss_kib > largest ? rss_kib : largest))
  done
  wait "$fleet" || { cat "$scratch/err" >&2; exit 2; }
  figure rss_8_peers_mb "$(awk -v kib="$largest" 'BEGIN { printf "%.1f", kib * 1.024 / 1000 }')" 25
fi
