#!/usr/bin/env bash
# Vehicles join and leave a running world: one that was killed with -9 drives again within five seconds of its
# restart, under its id or another; a fleet grows from two to four and shrinks again; and no two bodies touch.
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
take_domain

start world giveway-world
start a giveway-vehicle
start b giveway-vehicle
await "the first two drive (a)" 15 a 'cruise'
await "the first two drive (b)" 15 b 'cruise'

# The lanes cross, so vehicles also wait for each other.
DRIVES='cruise|keep_clear|give_way|not_granted'

# Under its id: its body still stands where it was left.
id=$(id_of b)
listen_places b "$DOMAIN" "$id"
await_places b 1 25 # it drives
kill_now b
start b2 giveway-vehicle --id "$id"
await "killed and restarted by its id" 5 b2 'cruise'

# Under another: any id, another place. The body of the dead one is removed in time.
kill_now a
start a2 giveway-vehicle
await "killed and restarted by any id" 5 a2 'cruise'
await "the dead one is removed" 10 world 'body is taken away'

start c giveway-vehicle
start d giveway-vehicle
await "four drive (c)" 10 c "$DRIVES"
await "four drive (d)" 10 d "$DRIVES"
left=$(id_of c)
for name in c d; do kill -TERM "${PID[$name]}"; done
for name in c d; do
  code=0
  wait "${PID[$name]}" || code=$?
  unset "PID[$name]"
  [[ $code -eq 0 ]] || fail "leaving: exit code $code of $name"
done
await "one has left" 3 world "vehicle $left left the run"
line=$(lines_of b2)
start e giveway-vehicle
await "another comes" 10 e 'cruise'
for name in world b2 a2 e; do alive "$name" || fail "$name is gone"; done
# A machine that stalls makes ranges stale.
halts=$(tail -n "+$((line + 1))" "$SCRATCH/b2.log" | grep '(halt)' | grep -v 'ranges_stale' || true)
[[ -z $halts ]] || fail "a vehicle that stayed was stopped by those that joined: $halts"

# The world ends: the vehicles end by themselves.
kill -TERM "${PID[world]}"
for name in b2 a2 e; do
  code=0
  wait "${PID[$name]}" || code=$?
  unset "PID[$name]"
  [[ $code -eq 0 ]] || fail "after the end: exit code $code of $name"
done
# The new process knows where the body was left, and drives on, not back.
end_listening
places b | jq -e 'length == 2 and all(.[]; .beacons > 5 and .beyond_m < 0.1) and
  .[1].continues' >/dev/null ||
  fail "where vehicle $id took itself to be: $(places b | tr -d '\n ')"
no_contact
[[ $failures -eq 0 ]]
