#!/usr/bin/env bash
# A vehicle that uses shared memory starts again, and the files of its ports are others, as where the library found
# them unhealthy after a kill: world and peers still send into the former ones, which no process reads. The vehicle
# notices, and is found over UDP.
# Regression: after 10 to 48 kills of one vehicle no successor of it was found any more.
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
take_domain
SAME_HOST=$REPOSITORY/config/qos/same_host.xml

start world giveway-world --qos "$SAME_HOST"
start first giveway-vehicle --id 1 --qos "$SAME_HOST"
start second giveway-vehicle --id 2 --qos "$SAME_HOST"
await "the first drives" 15 first 'cruise'
await "the second drives" 15 second 'cruise'
await "the second hears the first" 15 second 'beacon_heard: vehicle 1' # who was never heard does not leave

mapfile -t locks < <(find "/proc/${PID[first]}/fd" -lname '/dev/shm/fast*_port*_el' -printf '%l\n')
[[ ${#locks[@]} -ge 2 ]] || fail "the first has ${#locks[@]} ports in shared memory"
from=$(lines_of first)
kill -TERM "${PID[first]}" # a listener that was killed stays in the file, and senders give that up after a while
wait "${PID[first]}" || true
await "the second hears no more" 5 second 'beacon_left: vehicle 1'
heard=$(lines_of second)
rm "${locks[@]%_el}"

start first giveway-vehicle --id 1 --qos "$SAME_HOST"
await "it notices" 10 first 'over UDP alone' "$from"
await "it drives again" 15 first 'cruise' "$from"
await "the second hears it" 15 second 'beacon_heard: vehicle 1' "$heard"
no_contact
((failures == 0))
