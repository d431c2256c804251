#!/usr/bin/env bash
# A fleet started as the README says, for as long as wanted: it drives until it is asked to stop, whatever
# happens meanwhile. Its world is restarted three times, two vehicles are killed, one network is cut; after
# each every vehicle drives again, no two bodies touch, and in the quiet last third no process's memory grows.
#
#   bash tests/containers/patrol.sh [MINUTES [VEHICLES]]   default: each of the three once, at once
#
# GIVEWAY_NO_BUILD=1 takes the images as they are, GIVEWAY_KEEP_SAMPLES=FILE keeps what was looked at.
source "$(dirname "${BASH_SOURCE[0]}")/../support/composed_fleet.sh"
MINUTES=${1:-0}
VEHICLES=${2:-4}
LIMIT_S=30 # to drive again, including the time to give way at a crossing
KIB_MORE=2048 # what a process may grow by in the quiet time
SAMPLES=$SCRATCH/samples
export COMPOSE_PROJECT_NAME=$PROJECT
engine_up
use multicast
unset GIVEWAY_SCENARIO

# The command of the README, with this number of vehicles.
README_UP=$(grep -Eo '^bash config/deploy/up\.sh --vehicles [0-9]+' "$GIVEWAY_ROOT/config/deploy/README.md" | head -n 1)
[[ -n $README_UP ]] || die "the README does not say how a fleet is started"
up_as_the_readme_says() {
  local as_it_is=()
  [[ -z ${GIVEWAY_NO_BUILD:-} ]] || as_it_is=(--no-build)
  (cd "$GIVEWAY_ROOT" && ${README_UP% *} "$VEHICLES" "${as_it_is[@]}") >"$SCRATCH/up.log" 2>&1 ||
    fail "$README_UP: exit code $?: $(tail -n 5 "$SCRATCH/up.log")"
}

refuses() { # ARGUMENTS...
  local code=0
  bash "$GIVEWAY_ROOT/config/deploy/up.sh" "$@" >"$SCRATCH/up.log" 2>&1 || code=$?
  [[ $code -eq 2 ]] || fail "up.sh $*: exit code $code"
}

# Every vehicle was seen driving since the last call of begin_looking: at any moment some stand to give way.
begin_looking() { declare -gA DRIVEN=(); }
each_drove() {
  local container
  for container in $(running vehicle); do
    [[ -n ${DRIVEN[$container]:-} ]] || ! drives "$container" || DRIVEN[$container]=yes
  done
  [[ ${#DRIVEN[@]} -eq $VEHICLES ]]
}
drive_again() { # WHAT
  begin_looking
  await "$1: each of $VEHICLES drives" "$LIMIT_S" each_drove
}

# Seconds, container, KiB, ticks late of the world or scans late of a vehicle, speed.
sample() {
  local container
  for container in $(running world) $(running vehicle); do
    metrics "$container" | awk -v at="$((SECONDS - start_s))" -v name="$(name_of "$container")" '
      $1 == "process_resident_memory_bytes" {kib = $2 / 1024}
      $1 ~ /^giveway_(world_late_ticks|vehicle_late_scans)_total$/ {late = $2}
      $1 == "giveway_vehicle_speed_meters_per_second" {speed = $2}
      END {if (kib) printf "%d %s %d %d %.2f\n", at, name, kib, late, speed}' >>"$SAMPLES"
  done
}
# until SECONDS: samples every ten seconds until so long after the start.
until_then() {
  while ((SECONDS - start_s < $1)); do
    sample
    sleep "$(($1 - (SECONDS - start_s) < 10 ? 1 : 10))"
  done
}

placed() { [[ $(places) -ge $1 ]]; }
restart_world() {
  local placed_before
  placed_before=$(places)
  # As the README says, not by docker: the world is asked to stop, and its run is over.
  compose restart -t 5 world >"$SCRATCH/restart.log" 2>&1 || fail "restart: $(tail -n 3 "$SCRATCH/restart.log")"
  await "world restarted: all are given a place" 20 placed $((placed_before + VEHICLES))
  drive_again "world restarted"
}
kill_vehicle() {
  local vehicle before
  vehicle=$(running vehicle | sed -n "${1}p")
  before=$(restart_count "$vehicle")
  crash "$vehicle"
  await "vehicle killed: its container is started again" 5 was_restarted "$vehicle" "$before"
  drive_again "vehicle killed"
}
joined() { [[ $(metric "$(first_of world)" world_vehicles_joined) -eq $1 ]]; }
cut_network() {
  local vehicle
  vehicle=$(first_of vehicle)
  cut_off "$vehicle"
  await "network cut: the world takes it away" 10 joined $((VEHICLES - 1))
  reconnect "$vehicle"
  drive_again "network restored"
}

# Of each process that ran throughout the quiet time.
judge_memory() { # FROM_SECONDS
  awk -v from="$1" -v most="$KIB_MORE" '
    $1 >= from {
      if (!($2 in first)) first[$2] = $3
      last[$2] = $3
      if ($4 > late[$2]) late[$2] = $4
      ++seen[$2]
      if ($5 > 0.05) ++driven[$2]
    }
    END {
      for (name in first) {
        grown = last[name] - first[name]
        printf "%s: %d KiB, %+d in the quiet time; late %d; drove at %d of %d looks\n", name, last[name], grown, late[name], driven[name], seen[name]
        if (grown > most) bad = 1
      }
      exit bad
    }' "$SAMPLES" | sort
  [[ ${PIPESTATUS[0]} -eq 0 ]] || fail "memory grew by more than $KIB_MORE KiB"
}

refuses --vehicles 0
refuses --vehicles 9 # of patrol, which has places for 8
refuses --vehicle 2
up_as_the_readme_says
start_s=$SECONDS
drive_again "up"
whole=$((MINUTES * 60))
if [[ $whole -eq 0 ]]; then
  restart_world
  kill_vehicle 1
  cut_network
else
  drills=(restart_world "kill_vehicle 1" restart_world cut_network "kill_vehicle 2" restart_world)
  for i in "${!drills[@]}"; do
    until_then $((whole * (i + 1) / 10))
    echo "at $((SECONDS - start_s)) s:"
    ${drills[i]}
  done
  quiet=$((SECONDS - start_s + 30))
  until_then "$whole"
  judge_memory "$quiet"
  drive_again "at the end, after $((SECONDS - start_s)) s"
fi
for container in $(all_containers); do
  echo "$(name_of "$container"): restarted by its policy $(restart_count "$container") times"
done
no_contact
[[ -z ${GIVEWAY_KEEP_SAMPLES:-} ]] || cp "$SAMPLES" "$GIVEWAY_KEEP_SAMPLES"
[[ $failures -eq 0 ]]
