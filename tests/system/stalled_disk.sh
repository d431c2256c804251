#!/usr/bin/env bash
# The disk of the world's checkpoint stalls for five seconds: the world does not wait for it. Regression: the loop
# wrote its checkpoint itself, and its watchdog ended the process.
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
take_domain

LD_PRELOAD=$GIVEWAY_STALLED_DISK start world giveway-world --checkpoint "$SCRATCH/world.checkpoint"
for vehicle in a b c; do start "$vehicle" giveway-vehicle; done
for vehicle in a b c; do await "$vehicle drives" 15 "$vehicle" 'cruise'; done
await "the disk stalls" 10 world 'the disk stalls'
await "it is back" 10 world 'the disk is back'
alive world || fail "the world is gone: $(tail -n 3 "$SCRATCH/world.log")"
kill -TERM "${PID[world]}"
await "how long it took is said" 5 world 'the longest checkpoint took 5[0-9]{3}'
await "it ends" 5 world 'late for [0-9]+ ticks'
late=$(sed -n 's/.*late for \([0-9]*\) ticks.*/\1/p' "$SCRATCH/world.log")
[[ $late -lt 50 ]] || fail "the world was late for $late ticks, half of the time that the disk stalled"
[[ $failures -eq 0 ]]
