#!/usr/bin/env bash
# Eight containers cross under faults: kill -9 of a vehicle, a pause, a cut network, and kill -9 of the world.
# Unlike in the lanes of the drills they block each other all the time. Checked is that no two bodies touch, by
# the world's verdict over the whole run; not which of them arrive, and not the time the engine takes: the
# waits allow for a busy machine.
#
#   bash tests/containers/rough_crossing.sh multicast|servers
source "$(dirname "${BASH_SOURCE[0]}")/../support/composed_fleet.sh"
[[ ${1:-} == multicast || ${1:-} == servers ]] || die "say multicast or servers"
engine_up
use "$1"
once
eight 'any_arrived: true'
export GIVEWAY_SCENARIO=/drill/eight.textproto

up 8
await "up: a vehicle drives" 90 any_drives
mapfile -t vehicles < <(running vehicle)
world=$(first_of world)
seconds_in() { awk -v at="$1" -v now="$(metric "$world" world_run_seconds)" 'BEGIN {exit !(now >= at)}'; }

await "3 s into the run" 60 seconds_in 3
crash "${vehicles[0]}"
await "5 s into the run" 60 seconds_in 5
docker pause "${vehicles[1]}" >/dev/null
cut_off "${vehicles[2]}"
await "8 s into the run" 60 seconds_in 8
docker unpause "${vehicles[1]}" >/dev/null
reconnect "${vehicles[2]}"
await "10 s into the run" 60 seconds_in 10
before=$(restart_count "$world")
crash "$world"
await "the world is started again" 60 was_restarted "$world" "$before"
await "20 s into the run" 60 seconds_in 20
crash "${vehicles[3]}"

code=$(timeout 300 docker wait "$world") || code="none in 300 s"
docker logs "$world" 2>&1 | grep 'ended:' || true
[[ $code == 0 ]] || fail "the world's exit code is $code"
no_contact
[[ $failures -eq 0 ]]
