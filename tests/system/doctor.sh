#!/usr/bin/env bash
# fleetctl doctor on a host of its own, a mount namespace with an empty /dev/shm: what killed vehicles leave
# there is found and removed, and nothing that lives is touched; a full shared memory, two separate ones in
# one network, and networks without multicast are found. Needs root.
if [[ -z ${OWN_HOST:-} ]]; then
  if [[ $(id -u) -ne 0 ]] || ! unshare -nm true 2>/dev/null; then
    echo "not root: left out" >&2
    exit 0
  fi
  # shellcheck disable=SC2016
  OWN_HOST=1 exec unshare -m bash -c \
    'mount -t tmpfs -o size=64m none /dev/shm && exec bash "$0" "$@"' "$0" "$@"
fi
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
unset GIVEWAY_QOS GIVEWAY_INTERFACE GIVEWAY_DOMAIN
cd "$SCRATCH"
take_domain
SAME=$REPOSITORY/config/qos/same_host.xml

# doctor CODE NAME ARGUMENTS...: ends with CODE; its output in ./out, ./err. INSIDE is what it is run by.
INSIDE=(env)
doctor() {
  local wanted=$1 name=$2 code=0
  shift 2
  timeout 20 "${INSIDE[@]}" "$FLEETCTL" doctor --domain "$DOMAIN" "$@" >out 2>err || code=$?
  [[ $code -eq $wanted ]] || fail "$name: exit code $code: $(head -c 900 out err)"
}

# says NAME CONDITION: true of the JSON of the last command.
says() { jq -e "$2" out >/dev/null || fail "$1: not true of $(head -c 900 out): $2"; }

# finds NAME RULE ARGUMENTS...: that rule alone, with values and remedy.
finds() {
  local name=$1 rule=$2
  shift 2
  doctor 1 "$name" "$@" --json
  says "$name" "[.findings[].rule] == [\"$rule\"]
    and all(.findings[]; .values != \"\" and .consequence != \"\" and .remedy != \"\")"
}

healthy() { # NAME ARGUMENTS...
  local name=$1
  shift
  doctor 0 "$name" "$@" --json
  says "$name" '.findings == []'
}

# The segment a participant owns: a file of its own that it holds locked.
segment_of() {
  local file
  for file in /proc/"${PID[$1]}"/fd/*; do
    file=$(readlink "$file" || true)
    [[ $file == /dev/shm/fast@(rtps|dds)_????????????????_el ]] && basename "$file" _el
  done
  return 0
}

# Two vehicles that hear each other, and one that is alone in another domain: no process cleans up what that
# one leaves. Neighbours remove each other's stale segments after some seconds.
healthy "an empty host" --qos same_host
says "an empty host" '.not_known == []'
fleet=$DOMAIN
take_domain
start lone giveway-vehicle --id 9 --qos "$SAME"
DOMAIN=$fleet
start world giveway-world --qos "$SAME"
start one giveway-vehicle --id 1 --qos "$SAME"
await "one drives" 20 one cruise
[[ $failures -eq 0 ]] || exit 1

healthy "a living fleet" --qos same_host
says "a living fleet" '.processes == 2
  and (.memory.groups | length > 3 and all(.[]; .state == "in_use"))'
doctor 0 "nothing to fix" --qos same_host --fix
grep -q '^removed' out && fail "a living fleet was robbed: $(cat out)"

segment=$(segment_of lone)
living=$(segment_of one)
kill_now lone
finds "one was killed" memory_stale --qos same_host
says "one was killed" "[.memory.groups[] | select(.state == \"stale\").name] | index(\"$segment\")"
says "another vehicle lives" "any(.memory.groups[]; .name == \"$living\" and .state == \"in_use\")"
doctor 0 "removed" --qos same_host --fix
grep -qx "removed /dev/shm/$segment" out || fail "not removed: $(cat out)"
[[ ! -e /dev/shm/$segment && ! -e /dev/shm/${segment}_el ]] || fail "$segment is there"
[[ -e /dev/shm/$living ]] || fail "$living is gone"
healthy "cleaned" --qos same_host
timeout 10 "$FLEETCTL" listen fleet/beacon --domain "$DOMAIN" --qos same_host --vehicle 1 \
  --count 5 --duration 8 >heard || fail "a live vehicle is no longer heard: $(cat heard)"
start two giveway-vehicle --id 2 --qos "$SAME"
await "another comes" 10 two cruise
for name in world one two; do alive "$name" || fail "$name is gone: $(tail -n 3 "$name.log")"; done

# In the same network, with a shared memory of its own, as a container without --ipc=host.
unshare -m bash -c 'mount -t tmpfs none /dev/shm && exec "$@"' apart \
  "$BIN/giveway-vehicle" --scenario "$LANES" --domain "$DOMAIN" --id 3 --qos "$SAME" 2>three.log &
PID[three]=$!
until [[ $(readlink "/proc/${PID[three]}/exe") == */giveway-vehicle ]]; do sleep 0.02; done
finds "another shared memory" shared_memory_apart --qos same_host

for name in world one two three; do kill_now "$name"; done
doctor 1 "all were killed" --qos same_host --json
says "all were killed" '[.findings[].rule] - ["memory_stale", "memory_orphaned"] == []'
doctor 0 "all removed" --qos same_host --fix
left=$(find /dev/shm -name '*fast*')
[[ -z $left ]] || fail "left: $left"

# Space for no segment, then for some.
INSIDE=(unshare -m bash -c 'mount -t tmpfs -o size=1m none /dev/shm && exec "$@"' small)
finds "a small shared memory" memory_small --qos same_host
INSIDE=(unshare -m bash -c
  'mount -t tmpfs -o size=1m none /dev/shm && head -c 900k /dev/zero >/dev/shm/x && exec "$@"' full)
finds "a full shared memory" memory_full --qos same_host
healthy "a set that needs none" --qos default

INSIDE=(unshare -n)
finds "not even a loopback" interface_missing
INSIDE=(unshare -n bash -c 'ip link set lo up && exec "$@"' loopback)
healthy "a loopback"
INSIDE=(unshare -n bash -c 'ip link set lo up && ip link add v0 type veth peer name v1 &&
  ip address add 192.0.2.1/24 dev v0 && ip link set v0 multicast off up && exec "$@"' veth)
finds "an interface without multicast" multicast_missing --interface v0
healthy "another interface" --interface lo
if command -v nft >/dev/null; then
  INSIDE=(unshare -n bash -c 'ip link set lo up && nft add table ip t &&
    nft "add chain ip t c { type filter hook output priority 0; }" &&
    nft add rule ip t c ip daddr 239.255.0.1 drop && exec "$@"' wall)
  finds "a firewall" multicast_missing
  healthy "a firewall, and a discovery server" --qos wan_discovery_server
fi

INSIDE=(env)
touch DEFAULT_FASTRTPS_PROFILES.xml
finds "a stray profile file" default_profiles_file
rm DEFAULT_FASTRTPS_PROFILES.xml
INSIDE=(bash -c 'ulimit -n 64 && exec "$@"' limit)
finds "a low limit" descriptor_limit --vehicles 8
INSIDE=(env)
doctor 1 "a crowd" --vehicles 600 --json
says "a crowd" 'any(.findings[]; .rule == "participant_ids_short" and .severity == "error")'
doctor 2 "no such set" --qos no_such_set
grep -q no_such_set err || fail "no such set: $(cat err)"
doctor 0 "quiet" --quiet
[[ ! -s out ]] || fail "quiet: $(cat out)"

[[ $failures -eq 0 ]]
