#!/usr/bin/env bash
# The tests on Debian 13: g++ 14 and Fast DDS 3.1.2, in a container without any network but loopback.
#
#   bash tests/containers/debian13.sh STAGE ...   stages of tests/run.sh, built there
#   bash tests/containers/debian13.sh --system SCRIPT[:ARGUMENT] ...   scripts of tests/system with the
#                                                 programs as they are installed; a line each
#   bash tests/containers/debian13.sh --exposure  known vulnerabilities against its packages' changelogs
GIVEWAY_SUITE=trixie # whatever the other containers stand on
source "$(dirname "${BASH_SOURCE[0]}")/../support/engine.sh"
[[ $# -gt 0 ]] || die "name stages of tests/run.sh, or --system and scripts of tests/system, or --exposure"
mapfile -t packages < <(container_packages)
install_packages "${packages[@]}"
engine_up
trap engine_down EXIT
base_image "$SUITE"
build_image check

# The compiler cache outlives the container; the build outlives it only until the end of this tests/run.sh:
# another checkout's files may be older than what was built of this one's.
mkdir -p "$GIVEWAY_ROOT/build" # where the volume is mounted
BUILT=${GIVEWAY_RUN:+giveway-build13-$GIVEWAY_RUN:}/src/build
# At idle priority where this script is. The engine's daemon starts the container, not this script, and in
# a group of processes that has the usual share of the processor whatever the priorities within: hence a
# group of our own, where there is a folder for it (version 1, 2 of control groups).
place=()
idle_group() {
  local folder
  [[ $(docker info -f '{{.CgroupDriver}}') == cgroupfs ]] || return 0
  for folder in /sys/fs/cgroup/cpu /sys/fs/cgroup; do
    [[ -e $folder/cgroup.procs && -w $folder ]] || continue
    mkdir -p "$folder/giveway-idle"
    echo 1 >"$folder/giveway-idle/cpu.idle" || return 0
    place=(--cgroup-parent /giveway-idle)
    trap 'rmdir /sys/fs/cgroup{,/*}/giveway-idle 2>/dev/null || true; engine_down' EXIT
    return
  done
}
if chrt -p $$ | grep -q SCHED_IDLE; then idle_group; fi
in_container() {
  docker run --rm "${place[@]}" --network none --shm-size 1g --cap-add SYS_PTRACE --cap-add NET_ADMIN \
    --cap-add SYS_ADMIN --security-opt seccomp=unconfined --security-opt apparmor=unconfined \
    -e CI="${CI:-}" -e GIVEWAY_FUZZ_SECONDS -e GIVEWAY_REPEATS -e GIVEWAY_KILLS \
    -e GIVEWAY_ATTACK_SECONDS -e GIVEWAY_ATTACK_FUZZ_SECONDS \
    -v "$GIVEWAY_ROOT:/src:ro" -v "$BUILT" -v giveway-ccache13:/ccache -e CCACHE_DIR=/ccache \
    giveway-check bash -c 'ip link set lo up; exec "$@"' bash "$@"
}

# one_system SCRIPT[:ARGUMENT]: its line; where it failed, the end of what it printed too, marked for
# tests/run.sh, which prints it again at its end.
one_system() {
  local named=$1 script argument log
  log=$SCRATCH/${named//:/-}
  IFS=: read -r script argument <<<"$named"
  if in_container env GIVEWAY_BIN_DIR=/usr/bin bash "tests/system/$script.sh" \
    ${argument:+"$argument"} >"$log" 2>&1; then
    echo "ok      $named on Debian 13"
  else
    sed "s/^/| $script: /" "$log" | tail -n 30
    echo "FAILED  $named on Debian 13"
    return 1
  fi
}

# system SCRIPT[:ARGUMENT]...: three at a time, each in a container and so on a network of its own.
system() {
  local named running=0
  for named in "$@"; do
    if ((running == 3)); then
      wait -n || failures=1
      running=$((running - 1))
    fi
    one_system "$named" &
    running=$((running + 1))
  done
  for (( ; running > 0; --running)); do wait -n || failures=1; done
}

if [[ $1 == --system ]]; then
  shift
  failures=0
  SCRATCH=$(mktemp -d)
  trap 'rm -rf "$SCRATCH"; engine_down' EXIT
  system "$@"
  exit "$failures"
fi
if [[ $1 == --exposure ]]; then
  in_container bash tests/rules/exposure.sh --all-changelogs
  exit
fi
in_container bash tests/run.sh "$@"
