#!/usr/bin/env bash
# Two and eight containers cross, and the world's verdict is its exit code: by multicast, and by
# discovery servers with multicast blocked.
#
#   bash tests/containers/crossing.sh multicast|servers
source "$(dirname "${BASH_SOURCE[0]}")/../support/composed_fleet.sh"
[[ ${1:-} == multicast || ${1:-} == servers ]] || die "say multicast or servers"
engine_up
DISCOVERY=$1
use "$DISCOVERY"
once

# crossing VEHICLES SCENARIO: repeated, twice at most, where the machine stalled.
crossing() {
  local vehicles=$1 world code vehicle why try
  export GIVEWAY_SCENARIO=$2
  for try in 1 2 3; do
    up "$vehicles"
    world=$(members world)
    [[ $DISCOVERY == multicast || $vehicles == 2 ]] || multicast_finds_nobody
    code=$(timeout 300 docker wait "$world") || code="none in 300 s"
    docker logs "$world" 2>&1 | grep 'ended:' || true
    [[ $code != 0 && $try -lt 3 ]] || break
    why=$(excused "$world") || break
    echo "made again: $why"
    down
  done
  [[ $code == 0 ]] || fail "$vehicles vehicles: the world's exit code is $code"
  for vehicle in $(members vehicle); do
    code=$(timeout 10 docker wait "$vehicle") || code="none in 10 s"
    [[ $code == 0 ]] || fail "$vehicles vehicles: exit code $code of $(name_of "$vehicle")"
  done
  down
}

crossing 2 intersection_yield
eight 'arrived: [1, 2, 3, 4, 5, 6, 7, 8]'
crossing 8 /drill/eight.textproto
[[ $failures -eq 0 ]]
