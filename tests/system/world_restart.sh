#!/usr/bin/env bash
# The world is killed with -9 and restarted, with a checkpoint, with a damaged one and without, is asked to
# stop, and reaches the end of its run: the same vehicle processes drive again within five seconds, and no two
# bodies touch. A vehicle without --stay ends with its run.
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
take_domain
checkpoint=$SCRATCH/world.checkpoint

# restart NAME WHAT SAYS ARGUMENTS...: another world, whose log says SAYS.
restart() {
  local name=$1 what=$2 says=$3 vehicle
  local -A line
  shift 3
  for vehicle in a b c; do line[$vehicle]=$(lines_of "$vehicle"); done
  start "$name" giveway-world "$@"
  for vehicle in a b c; do
    await "$what: $vehicle follows" 5 "$vehicle" 'drives on in world' "${line[$vehicle]}"
    await "$what: $vehicle drives" 5 "$vehicle" 'cruise' "$(lines_until "$vehicle" 'drives on in world')"
    alive "$vehicle" || fail "$what: $vehicle is gone"
  done
  await "$what: the world says so" 10 "$name" "$says"
}

# The number of the last line that matches.
lines_until() { grep -n "$2" "$SCRATCH/$1.log" | tail -n 1 | cut -d: -f1; }

start world1 giveway-world --checkpoint "$checkpoint"
for vehicle in a b c; do
  start "$vehicle" giveway-vehicle --stay --record "$SCRATCH/$vehicle.recording"
done
for vehicle in a b c; do await "at first: $vehicle drives" 15 "$vehicle" 'cruise'; done

kill_now world1
restart world2 "with its checkpoint" 'resumes from the checkpoint with 3 vehicles' \
  --checkpoint "$checkpoint"

kill_now world2
printf 'x' | dd of="$checkpoint" bs=1 seek=100 conv=notrunc status=none
restart world3 "with a corrupted checkpoint" 'is of no use: its checksum is wrong' \
  --checkpoint "$checkpoint"

kill_now world3
restart world4 "without a checkpoint" 'started with'

# A fourth vehicle still gets an id of its own.
start d giveway-vehicle
await "another comes" 10 d 'cruise'
[[ $(for vehicle in a b c d; do id_of "$vehicle"; done | sort -u | wc -l) -eq 4 ]] ||
  fail "two vehicles have one id"

kill -TERM "${PID[world4]}"
code=0
wait "${PID[d]}" || code=$?
unset "PID[d]"
[[ $code -eq 0 ]] || fail "after the end: exit code $code of d, which does not stay"
for vehicle in a b c; do
  await "its run is over: $vehicle" 10 "$vehicle" 'the run has ended: waits for the next world'
done
restart world5 "after one that was asked to stop" 'started with' --duration 8
wait "${PID[world5]}" # its run is over
restart world6 "after one whose run was over" 'started with'

kill -TERM "${PID[world6]}" "${PID[a]}" "${PID[b]}" "${PID[c]}"
for vehicle in a b c; do
  code=0
  wait "${PID[$vehicle]}" || code=$?
  unset "PID[$vehicle]"
  [[ $code -eq 0 ]] || fail "after the end: exit code $code of $vehicle"
done
no_contact
# Their decisions in four worlds replay identically.
"$FLEETCTL" replay "$SCRATCH"/*.recording || fail "replay: exit code $?"
[[ $failures -eq 0 ]]
