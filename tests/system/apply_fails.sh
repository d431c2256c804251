#!/usr/bin/env bash
# A QoS set that the trial of an order takes and the restart does not: between the two, shared memory
# becomes full, and the library ends the process by SIGBUS; or the process may write no large file any
# more, and the library refuses. The vehicle comes back as the same process with the set it had, answers
# "refused", and drives on; so does the world. On a host of our own. Needs root.
if [[ -z ${OWN_HOST:-} ]]; then
  if [[ $(id -u) -ne 0 ]] || ! unshare -m true 2>/dev/null; then
    echo "not root: left out" >&2
    exit 0
  fi
  # shellcheck disable=SC2016  # the inner shell expands it
  OWN_HOST=1 exec unshare -m bash -c \
    'mount -t tmpfs -o size=64m none /dev/shm && exec bash "$0" "$@"' "$0" "$@"
fi
source "$(dirname "${BASH_SOURCE[0]}")/members.sh"
unset GIVEWAY_QOS GIVEWAY_INTERFACE GIVEWAY_DOMAIN
cd "$SCRATCH"
take_domain

# says NAME CONDITION: true of the JSON object of the last order.
says() { jq -e "$2" out >/dev/null || fail "$1: not true of $(head -c 900 out): $2"; }

# The process that tries a set for this one. Once it is there, this one stands still until it is over:
# what is done then is done between the trial and the restart.
trial_of() {
  local children
  until read -r children _ <"/proc/$1/task/$1/children"; do
    kill -0 "$ORDER" 2>/dev/null || return 1
  done
  kill -STOP "$1"
  echo "$children"
}
is_over() { [[ ! -e /proc/$1/stat || $(cut -d' ' -f3 "/proc/$1/stat") == Z ]]; }

fill_memory() { head -c 1G /dev/zero >/dev/shm/full 2>/dev/null || true; }
forbid_files() { prlimit --pid "$1" --fsize=100000:unlimited; }
allow_again() {
  rm -f /dev/shm/full
  prlimit --pid "$1" --fsize=unlimited
}

# comes_back NAME MEMBER TARGET SPOILS WHY: an order of same_host to the member, spoilt by SPOILS between
# trial and restart, is refused for WHY.
comes_back() {
  local name=$1 member=$2 target=$3 spoils=$4 why=$5 pid=${PID[$2]} line code=0 trial
  line=$(lines_of "$member")
  "$FLEETCTL" qos apply same_host --to "$target" --domain "$DOMAIN" --json >out 2>err &
  ORDER=$!
  if trial=$(trial_of "$pid"); then
    until is_over "$trial"; do sleep 0.01; done
    "$spoils" "$pid"
    kill -CONT "$pid"
  else
    fail "$name: nothing was tried"
  fi
  wait "$ORDER" || code=$?
  allow_again "$pid"
  [[ $code -eq 1 ]] || fail "$name: exit code $code: $(head -c 600 out err)"
  says "$name" ".verdict == \"refused\" and
    (.vehicles[0].refusal | contains(\"came back with what it had\") and test(\"$why\"))"
  await "$name: it restarted" 1 "$member" 'restarts itself with the QoS of same_host' "$line"
  await "$name: and came back" 5 "$member" "comes back with the QoS it had before: .*$why" "$line"
  alive "$member" || {
    fail "$name: $member is gone: $(tail -n 3 "$member.log")"
    exit 1
  }
  timeout 20 "$FLEETCTL" qos show --live "${6:-1}" --domain "$DOMAIN" --qos default >shown 2>err ||
    fail "$name: another set than before: $(grep not shown; cat err)"
}

start world giveway-world
for id in 1 2; do start "$id" giveway-vehicle --id "$id"; done
for id in 1 2; do await "at first: $id drives" 15 "$id" cruise; done
listen_places 1 "$DOMAIN" 1
await_beacons 1 25
listened=$(lines_of 2)

comes_back "full shared memory" 1 1 fill_memory 'it ended by signal 7'
await "full shared memory: drives on" 5 1 cruise "$(lines_of 1)"
comes_back "no large files" 1 1 forbid_files 'Fast DDS did not make'
await_beacons 1 "$(($(wc -l <1.beacon) + 10))"
if tail -n "+$((listened + 1))" 2.log | grep -q halt; then fail "the other was stopped by it"; fi

# With nothing in the way the same order is taken.
"$FLEETCTL" qos apply same_host --to 1 --domain "$DOMAIN" --json >out 2>err || fail "at last: $(cat out err)"
says "at last" '.verdict == "applied"'

end_listening
places 1 | jq -e 'length >= 3 and all(.[]; .beyond_m < 0.1) and
  ([range(1; length) as $i | .[$i - 1].last_toward == .[$i].first_toward] | all)' >/dev/null ||
  fail "where vehicle 1 took itself to be: $(places 1 | tr -d '\n ')"
no_contact
[[ $failures -eq 0 ]]
