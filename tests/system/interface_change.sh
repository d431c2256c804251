#!/usr/bin/env bash
# A vehicle whose network interface is removed and comes back differently, as another device or with another
# address, would receive nothing any more: it ends with exit code 1 within three seconds, and drives on from
# where it stands once it is restarted. The other vehicle drives on throughout. The world and the two have
# network namespaces of their own, joined by a bridge. Then the world's interface gets another address: the
# world and an observer end as a vehicle does, and the world that is started next resumes. Regression: both
# stayed deaf, and said that they were ready. Needs root.
if [[ -z ${OWN_NETWORK:-} ]]; then
  if [[ $(id -u) -ne 0 ]] || ! unshare -nm true 2>/dev/null; then
    echo "not root: left out" >&2
    exit 0
  fi
  # shellcheck disable=SC2016  # the inner shell expands it
  OWN_NETWORK=1 exec unshare -nm bash -c \
    'mount -t tmpfs none /run && ip link set lo up && exec bash "$0" "$@"' "$0" "$@"
fi
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
unset GIVEWAY_QOS GIVEWAY_INTERFACE GIVEWAY_DOMAIN
take_domain
# A body stays for longer than a vehicle takes to come back.
sed 's/^remove_after_s: .*/remove_after_s: 30/' "$LANES" >"$SCRATCH/lanes.textproto"
LANES=$SCRATCH/lanes.textproto
NOTICED_MS=3000

ip link add fleet type bridge
ip address add 192.0.2.1/24 dev fleet
ip link set fleet up

# connect VEHICLE ADDRESS: its device eth0 is on the bridge.
connect() {
  ip link add "to_$1" type veth peer name eth0 netns "$1"
  ip link set "to_$1" master fleet up
  ip -n "$1" address add "$2/24" dev eth0
  ip -n "$1" link set eth0 up
}

# drive NAME NAMESPACE ARGUMENTS...
drive() {
  local name=$1 inside=$2
  shift 2
  ip netns exec "$inside" "$BIN/giveway-vehicle" --scenario "$LANES" --domain "$DOMAIN" "$@" \
    2>"$SCRATCH/$name.log" &
  PID[$name]=$!
}

# ends WHAT NAME [INTERFACE]: with exit code 1, after NOTICED_MS from now at most, and the longest pause of the machine.
ends() {
  local what=$1 name=$2 code=0 start_ms last now took_ms pause_ms=0
  start_ms=$(date +%s%3N)
  now=$start_ms
  while alive "$name" && ((now - start_ms < 10000)); do
    last=$now
    sleep 0.02
    now=$(date +%s%3N)
    ((now - last <= pause_ms)) || pause_ms=$((now - last))
  done
  took_ms=$((now - start_ms))
  if alive "$name"; then
    fail "$what: $name still runs: $(tail -n 3 "$SCRATCH/$name.log")"
    return
  fi
  wait "${PID[$name]}" || code=$?
  unset "PID[$name]"
  echo "$what: ended after $took_ms ms, the machine paused for $pause_ms ms" >&2
  ((code == 1)) || fail "$what: exit code $code of $name"
  ((took_ms <= NOTICED_MS + pause_ms)) || fail "$what: $name ended after $took_ms ms"
  grep -q "the network interfaces changed: was ${3:-eth0} (.*; ends, to be started again" \
    "$SCRATCH/$name.log" || fail "$what: $name does not say why: $(tail -n 3 "$SCRATCH/$name.log")"
}

# drives_through WHAT NAME LINE: since this line of its log it halted only for stale ranges, as on a late
# machine.
drives_through() {
  if tail -n "+$(($3 + 1))" "$SCRATCH/$2.log" | grep halt | grep -qv ranges_stale; then
    fail "$1: $2 was stopped by it: $(tail -n 3 "$SCRATCH/$2.log")"
  fi
}

for vehicle in a b; do
  ip netns add "$vehicle"
  ip -n "$vehicle" link set lo up
done
connect a 192.0.2.11
connect b 192.0.2.12

start world giveway-world --interface fleet --checkpoint "$SCRATCH/world.checkpoint"
start observer giveway-observer --interface fleet --port $((18000 + DOMAIN))
drive a a --id 1 --interface 192.0.2.11
drive b b --id 2 --interface eth0
for vehicle in a b; do await "at first: $vehicle drives" 15 "$vehicle" cruise; done
[[ $failures -eq 0 ]] || exit 1
export GIVEWAY_INTERFACE=fleet
listen_places a "$DOMAIN" 1
listen_places b "$DOMAIN" 2
for vehicle in a b; do await_places "$vehicle" 1 25; done

line=$(lines_of a)
ip link delete to_b
connect b 192.0.2.22
ends "another device" b
drive b2 b --id 2 --interface eth0
await "another device: drives on" 5 b2 cruise
alive a || fail "another device: a is gone"
drives_through "another device" a "$line"

line=$(lines_of b2)
ip -n a address delete 192.0.2.11/24 dev eth0
ip -n a address add 192.0.2.21/24 dev eth0
ends "another address" a
drive a2 a --id 1 --interface 192.0.2.21
await "another address: drives on" 5 a2 cruise
alive b2 || fail "another address: b is gone"
drives_through "another address" b2 "$line"

for vehicle in a b; do await_places "$vehicle" 2 10; done
end_listening
for vehicle in a b; do
  places "$vehicle" | jq -e 'length == 2 and all(.[]; .beacons > 5 and .beyond_m < 0.1) and
    .[1].continues' >/dev/null ||
    fail "where $vehicle took itself to be: $(places "$vehicle" | tr -d '\n ')"
done
for member in world observer; do
  alive "$member" || fail "$member is gone: $(tail -n 3 "$SCRATCH/$member.log")"
done

line=$(lines_of a2)
ip address delete 192.0.2.1/24 dev fleet
ip address add 192.0.2.2/24 dev fleet
ends "the world's address" world fleet
ends "the observer's address" observer fleet
start world2 giveway-world --interface fleet --checkpoint "$SCRATCH/world.checkpoint"
await "the world's address: resumes" 5 world2 'resumes from the checkpoint'
await "the world's address: a drives on" 10 a2 cruise "$line"
no_contact
[[ $failures -eq 0 ]]
