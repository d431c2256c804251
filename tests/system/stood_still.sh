#!/usr/bin/env bash
# A vehicle that uses shared memory stands still for 4 s, as where its machine is busy or it is in a debugger. Its
# peers take the ports it receives at for unhealthy and replace their files; it drives on, and no process leaves shared
# memory. An observer, which sends nothing to the vehicle, has the former files open all the while.
# Regression: the vehicle took the former files for a fault, started itself again, and stayed on UDP.
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
take_domain
SAME_HOST=$REPOSITORY/config/qos/same_host.xml

# The files of the ports that the first receives at, "INODE FILE" a line.
ports() {
  local lock
  find "/proc/${PID[first]}/fd" -lname '/dev/shm/fast*_port*_el' -printf '%l\n' | sort |
    while read -r lock; do stat -c '%i %n' "${lock%_el}"; done
}

start world giveway-world --qos "$SAME_HOST"
start first giveway-vehicle --id 1 --qos "$SAME_HOST"
start second giveway-vehicle --id 2 --qos "$SAME_HOST"
"$FLEETCTL" listen fleet/status --json --domain "$DOMAIN" --qos "$SAME_HOST" >"$SCRATCH/observer.log" 2>&1 &
PID[observer]=$!
await "the first drives" 15 first 'cruise'
await "the second hears it" 15 second 'beacon_heard: vehicle 1'
await "it is observed" 15 observer '"vehicle":1'

before=$(ports) heard=$(lines_of second)
kill -STOP "${PID[first]}"
await "the second hears no more" 5 second 'beacon_stale: vehicle 1' "$heard"
sleep 3.7
seen=$(lines_of observer)
kill -CONT "${PID[first]}"
await "it drives again" 15 observer '"vehicle":1,.*"mode":"cooperative","rule":"cruise"' "$seen"
await "the second hears it again" 15 second 'beacon_heard: vehicle 1' "$heard"
sleep 3 # three looks
[[ $(ports) != "$before" ]] || fail "no file was replaced: this shows nothing"
if grep -H 'over UDP alone' "$SCRATCH"/*.log; then fail "a process left shared memory"; fi
no_contact
((failures == 0))
