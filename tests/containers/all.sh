#!/usr/bin/env bash
# The container tests of one stage of tests/run.sh, one engine for all of them: a line "ok NAME" or
# "FAILED NAME" each, or as many as a line "N passed, N failed" counts.
#
#   bash tests/containers/all.sh images|asan13|debian13|containers
#
# images leaves the process of an engine that it started in the file GIVEWAY_ENGINE_FILE, for the script that
# ends it.
# asan13 and debian13 of one tests/run.sh share one build folder, by its number in GIVEWAY_RUN.
#
# GIVEWAY_SUITE=bookworm puts the containers on Debian 12 with Fast DDS 2.9.1, without discovery
# servers: those of compose.yaml have no number, and 2.9.1 starts none without.
source "$(dirname "${BASH_SOURCE[0]}")/../support/engine.sh"
HERE=$GIVEWAY_ROOT/tests/containers

# case_of NAME SCRIPT ARGUMENTS...
case_of() {
  local name=$1 script=$2
  shift 2
  if bash "$HERE/$script.sh" "$@" >&2; then echo "ok      $name"; else echo "FAILED  $name"; fi
}

# What asan13 and the container tests need.
images() {
  base_image "$SUITE"
  for target in world vehicle tools; do build_image "$target"; done
  SUITE=trixie
  base_image "$SUITE"
  build_image check
  echo "ok      images are built"
}

# run_of STAGE...: stages of tests/run.sh in the container of Debian 13; prints the count and what failed.
run_of() {
  bash "$HERE/debian13.sh" "$@" | tee >(cat >&2) | grep -E '^([0-9]+ passed, [0-9]+ failed$|failed: )' ||
    echo "FAILED  $* on Debian 13"
}

# Fuzzing takes a given time, and only computes.
asan13() {
  local extent=()
  [[ ${GIVEWAY_FULL:-} != true ]] || extent=(--full)
  run_of asan "${extent[@]}"
  run_of fuzz
}

# in_background FILE COMMAND...: starts it as the process `meanwhile`, which writes to FILE and FILE.log. In a
# process group of its own, so that it can be ended with all its children; without one it would ignore Ctrl-C.
meanwhile=''
in_background() {
  local file=$1
  shift
  set -m
  "$@" >"$file" 2>"$file.log" &
  meanwhile=$!
  set +m
}

# end_of_background FILE: waits for `meanwhile` (the engine is in the background too), and prints what it wrote.
end_of_background() {
  wait "$meanwhile" || echo "FAILED  what ran in the background ended with exit code $?"
  meanwhile=''
  cat "$1.log" >&2
  cat "$1"
  rm -f "$1" "$1.log"
}

# Its drills remove their containers as they end, so the engine goes last.
stop_all() {
  if [[ -n $meanwhile ]]; then
    kill -- "-$meanwhile" 2>/dev/null || true
    wait "$meanwhile" 2>/dev/null || true
  fi
  engine_down
}

# The link tests come last: what they need of asan13's build folder may still be built in the background.
debian13() {
  local scripts=(crossing:intersection_yield crossing:peer_dies crossing:four_way rejoin
    world_restart qos) script
  [[ ${GIVEWAY_FULL:-} != true ]] || scripts+=(repeat:intersection_yield repeat:intersection_equal
    bad_input impaired observers apply stopwatch why doctor tune replay kill_drill)
  export GIVEWAY_SUITE=trixie
  SUITE=$GIVEWAY_SUITE
  base_image "$SUITE"
  case_of "known vulnerabilities against the packages of Debian 13" debian13 --exposure
  bash "$HERE/debian13.sh" --system "${scripts[@]}" || echo "FAILED  system tests on Debian 13: exit code $?"
  # What holds stops to a second runs alone.
  for script in interrupt health; do
    bash "$HERE/debian13.sh" --system "$script" || echo "FAILED  $script on Debian 13: exit code $?"
  done
  build_image vehicle
  build_image world
  bash "$HERE/mixed.sh" || [[ $? -eq 2 ]] || echo "FAILED  a mixed fleet" # 2: nothing is mixed
  run_of asan_link
}

# drills DISCOVERY: a composed fleet whose vehicles discover each other so.
drills() {
  [[ $1 != multicast ]] || case_of "a fleet as the README starts it" patrol
  case_of "crossings of 2 and 8, $1" crossing "$1"
  case_of "drills, $1" fault_drills "$1"
  case_of "eight cross while things happen, $1" rough_crossing "$1"
}

second_half() {
  [[ $SUITE != bookworm ]] || return 0
  export GIVEWAY_DRILL=2
  drills servers
}

# Two fleets at a time, each on a network of its own: most of a drill is waiting. What holds stops to a second
# runs alone.
containers() {
  local kills=20 printed
  [[ ${GIVEWAY_FULL:-} != true ]] || kills=200
  base_image "$SUITE"
  for target in world vehicle tools; do build_image "$target"; done
  case_of "images" images
  printed=$(mktemp)
  in_background "$printed" second_half
  drills multicast
  case_of "bad input" bad_input
  end_of_background "$printed"
  case_of "stops, and $kills kill -9 restarts" shutdown "$kills"
}

mapfile -t wanted < <(container_packages)
install_packages "${wanted[@]}"
engine_up
if [[ $1 == images && -n ${GIVEWAY_ENGINE_FILE:-} ]]; then
  printf '%s' "${ENGINE:-}" >"$GIVEWAY_ENGINE_FILE"
else
  trap stop_all EXIT
fi
"$1"
