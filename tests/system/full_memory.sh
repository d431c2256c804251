#!/usr/bin/env bash
# /dev/shm is full while a fleet runs with a set that uses it: a vehicle that starts then, and processes that the
# library ends by SIGBUS since it has to write a new file there, come back over UDP alone, and all drive.
# Regression: a full /dev/shm ended the world of a soak, and no vehicle drove again.
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
[[ $(id -u) -eq 0 ]] || exit 0 # a /dev/shm apart needs root
if [[ ${1:-} != apart ]]; then exec unshare --mount bash "$0" apart; fi
mount -t tmpfs -o size=16m,mode=1777 tmpfs /dev/shm
take_domain
SAME_HOST=$REPOSITORY/config/qos/same_host.xml

start world giveway-world --qos "$SAME_HOST" --checkpoint "$SCRATCH/checkpoint"
start first giveway-vehicle --id 1 --qos "$SAME_HOST"
await "the first drives" 15 first 'cruise'
cat /dev/zero >/dev/shm/filler 2>/dev/null || true

start second giveway-vehicle --id 2 --qos "$SAME_HOST"
await "one that starts has no memory" 10 second 'over UDP alone.*signal 7'
await "it drives" 15 second 'cruise'

# As a port that the library makes again would.
from=$(lines_of first)
kill -BUS "${PID[first]}"
await "one that drives comes back" 5 first 'over UDP alone.*signal 7' "$from"
await "it drives again" 15 first 'cruise' "$from"
from=$(lines_of second)
kill -BUS "${PID[world]}"
await "the world comes back" 5 world 'over UDP alone.*signal 7'
await "from where it was" 10 world 'resumes from the checkpoint with 2 '
await "the fleet drives again" 20 second 'cruise' "$from"
no_contact

# Over UDP such a signal is no matter of shared memory.
kill -BUS "${PID[first]}"
code=0
wait "${PID[first]}" || code=$?
[[ $code -eq 135 ]] || fail "a second one ends with $code, expected SIGBUS"
((failures == 0))
