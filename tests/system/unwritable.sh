#!/usr/bin/env bash
# World and vehicle restart in place while neither checkpoint nor recording can be written: the run continues without
# them. Regression: the process that came back ended with code 2, and the run with it.
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
take_domain
SAME_HOST=$REPOSITORY/config/qos/same_host.xml
mkdir "$SCRATCH/disk"

# Has it restart: without its own segments it has to.
take_memory_of() { # NAME
  local segments
  mapfile -t segments < <(find "/proc/${PID[$1]}/fd" "/proc/${PID[$1]}/map_files" -lname '/dev/shm/fast*' \
    -printf '%l\n' 2>/dev/null | grep -v port | sort -u)
  [[ ${#segments[@]} -gt 0 ]] || fail "$1 has no segment in /dev/shm"
  rm -f -- "${segments[@]}"
}

start world giveway-world --qos "$SAME_HOST" --checkpoint "$SCRATCH/disk/world.checkpoint"
for vehicle in a b c; do
  start "$vehicle" giveway-vehicle --qos "$SAME_HOST" --record "$SCRATCH/disk/$vehicle.recording"
done
for vehicle in a b c; do await "$vehicle drives" 15 "$vehicle" 'cruise'; done
mv "$SCRATCH/disk" "$SCRATCH/away"
take_memory_of a
await "the vehicle says so" 10 a 'drives on without a recording'
before=$(lines_of world)
take_memory_of world
await "the world says so" 10 world 'resumes from the checkpoint'
await "the checkpoint fails" 10 world 'checkpoint .*world.checkpoint'
await "the run continues with all" 15 world 'started with 3 vehicles' "$before"
for member in world a b c; do
  alive "$member" || fail "$member is gone: $(tail -n 3 "$SCRATCH/$member.log")"
done
mv "$SCRATCH/away" "$SCRATCH/disk"
await "it is written again" 10 world 'is written again'
no_contact
((failures == 0))
