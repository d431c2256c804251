#!/usr/bin/env bash
# A QoS set that works in the trial of an order but not in the restart: between the two, shared memory becomes
# full, and the library ends the process by SIGBUS. The vehicle comes back as the same process with the set it
# had, answers "refused", and drives on from where it stands. On a host of its own, a mount namespace with a
# small /dev/shm. Needs root.
if [[ -z ${OWN_HOST:-} ]]; then
  if [[ $(id -u) -ne 0 ]] || ! unshare -m true 2>/dev/null; then
    echo "not root: left out" >&2
    exit 0
  fi
  # shellcheck disable=SC2016  # the inner shell expands it
  OWN_HOST=1 exec unshare -m bash -c \
    'mount -t tmpfs -o size=64m none /dev/shm && exec bash "$0" "$@"' "$0" "$@"
fi
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
unset GIVEWAY_QOS GIVEWAY_INTERFACE GIVEWAY_DOMAIN
cd "$SCRATCH"
take_domain
export GIVEWAY_ADMIN_KEY=$SCRATCH/admin.key # of the services and of fleetctl
printf "a key for one test\n" >"$GIVEWAY_ADMIN_KEY"
QOS=$REPOSITORY/config/qos

# says NAME CONDITION: true of the JSON object of the last order.
says() { jq -e "$2" out >/dev/null || fail "$1: not true of $(head -c 900 out): $2"; }

fill_memory() { head -c 1G /dev/zero >/dev/shm/full 2>/dev/null || true; }
free_memory() { rm -f /dev/shm/full; }

# Prints the child in which process $1 tries a set, and stops $1, so that what follows happens before its
# restart. Fails once process $2, which gave the order, is gone.
trial_of() {
  local children=
  while [[ -z $children ]]; do # they stand on a line without an end
    { read -r children _ <"/proc/$1/task/$1/children"; } 2>/dev/null || true
    kill -0 "$2" 2>/dev/null || return 1
  done
  kill -STOP "$1"
  echo "$children"
}
is_over() { [[ $(sed 's/.*) //; s/ .*//' "/proc/$1/stat" 2>/dev/null) == @(Z|) ]]; }

# A world that an order restarted comes back too.
fill_memory
start world giveway-world --qos "$QOS/same_host.xml" --former-qos "$QOS/default.xml"
await "a world" 5 world 'comes back with the QoS it had before: it ended by signal 7'
free_memory

for id in 1 2; do start "$id" giveway-vehicle --id "$id" --qos "$QOS/default.xml"; done
for id in 1 2; do await "at first: $id drives" 15 "$id" cruise; done
[[ $failures -eq 0 ]] || exit 1
listen_places 1 "$DOMAIN" 1
await_places 1 1 25
line=$(lines_of 1)
line_of_2=$(lines_of 2)

"$FLEETCTL" qos apply same_host --to 1 --domain "$DOMAIN" --json >out 2>err &
order=$!
trial=$(trial_of "${PID[1]}" "$order") || {
  fail "nothing was tried: $(cat out err)"
  exit 1
}
until is_over "$trial"; do sleep 0.01; done
fill_memory
kill -CONT "${PID[1]}"
code=0
wait "$order" || code=$?
free_memory
[[ $code -eq 1 ]] || fail "exit code $code: $(head -c 600 out err)"
says "the answer" '.verdict == "refused" and
  (.vehicles[0].refusal | contains("came back with what it had: it ended by signal 7"))'
await "it restarted" 10 1 'restarts itself with the QoS of same_host' "$line"
await "it came back" 10 1 'comes back with the QoS it had before: it ended by signal 7' "$line"
await "it drives on" 5 1 cruise "$(grep -n 'comes back' 1.log | cut -d: -f1)"
alive 1 || fail "it is gone: $(tail -n 3 1.log)"
timeout 20 "$FLEETCTL" qos show --live 1 --domain "$DOMAIN" --qos default >out 2>err ||
  fail "it has another set than before: $(grep not out; cat err)"
await_places 1 2 10
if tail -n "+$((line_of_2 + 1))" 2.log | grep halt | grep -qv ranges_stale; then # that the machine is late
  fail "the other was stopped by it: $(tail -n 3 2.log)"
fi

# With enough memory the same set is applied.
"$FLEETCTL" qos apply same_host --to 1 --domain "$DOMAIN" --json >out 2>err ||
  fail "with enough memory: $(head -c 600 out err)"
says "with enough memory" '.verdict == "applied"'
await_places 1 3 10

# An operator ends the verb while a process has an order and has not answered: it carried it out when it came to it,
# and stood alone with a set that no other had.
line=$(lines_of 2)
: >out # that of the order before is not empty
"$FLEETCTL" qos apply lossy_radio --to 2 --force --domain "$DOMAIN" >out 2>err &
order=$!
PID[order]=$order
for _ in $(seq 1000); do [[ ! -s out ]] || break; sleep 0.01; done # the plan
kill -STOP "${PID[2]}"
kill -INT "$order"
for _ in $(seq 1000); do
  ! grep -q 'gave no answer' out || break
  sleep 0.01
done
kill -CONT "${PID[2]}"
code=0
wait "$order" || code=$?
unset "PID[order]"
[[ $code -eq 1 ]] || fail "ended while it waited: exit code $code: $(cat out err)"
await "ended while it waited: 2 has gone back" 5 2 'restarts itself with the QoS of default' "$line"
line=$(grep -n 'restarts itself with the QoS of default' 2.log | tail -n 1 | cut -d: -f1)
await "ended while it waited: 2 drives" 10 2 cruise "$line"
timeout 20 "$FLEETCTL" qos show --live 2 --domain "$DOMAIN" --qos default >shown 2>err ||
  fail "ended while it waited: 2 has another set: $(cat out; grep not shown; cat err)"

end_listening
places 1 | jq -e 'length >= 3 and all(.[]; .beyond_m < 0.1) and
  all(.[]; .continues)' >/dev/null ||
  fail "where vehicle 1 took itself to be: $(places 1 | tr -d '\n ')"
no_contact
[[ $failures -eq 0 ]]
