#!/usr/bin/env bash
# World and vehicle restart in place while neither checkpoint nor recording can be written: the run continues without
# them. Regression: the process that came back ended with code 2, and the run with it. The same for a world that was
# killed: it resumes from what was written last. Only one that has nothing to resume ends.
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
await "the world says so" 10 world 'resumes from the checkpoint' "$before"
await "the checkpoint fails" 10 world 'checkpoint .*world.checkpoint' "$before"
await "the run continues with all" 15 world 'started with 3 vehicles' "$before"
for member in world a b c; do
  alive "$member" || fail "$member is gone: $(tail -n 3 "$SCRATCH/$member.log")"
done
mv "$SCRATCH/away" "$SCRATCH/disk"
await "it is written again" 10 world 'is written again'

code=0
timeout 10 "$BIN/giveway-world" --scenario "$LANES" --domain "$DOMAIN" --checkpoint "$SCRATCH/none/world.checkpoint" \
  2>>"$SCRATCH/none.log" || code=$?
[[ $code -eq 2 ]] || fail "with nothing to resume: exit code $code: $(tail -n 1 "$SCRATCH/none.log")"

before=$(lines_of world)
until mkdir "$SCRATCH/disk/world.checkpoint.new" 2>/dev/null; do sleep 0.01; done # a checkpoint's name until it is whole
await "it fails once more" 10 world 'checkpoint .*cannot be written' "$before"
kill_now world
# Over UDP alone, as it has run since it restarted itself.
start world2 giveway-world --qos "$REPOSITORY/config/qos/default.xml" --checkpoint "$SCRATCH/disk/world.checkpoint"
await "killed: it resumes" 10 world2 'resumes from the checkpoint with 3 vehicles'
await "killed: it says that it keeps none" 10 world2 'checkpoint .*cannot be written'
await "killed: the run continues with all" 15 world2 'started with 3 vehicles'
no_contact
((failures == 0))
