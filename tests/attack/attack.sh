#!/usr/bin/env bash
# An intruder without credentials attacks a driving fleet: a line "ok" or "FAILED" an attack. Each time:
# every process survives, there is no contact, vehicles receive 90 % of each other's beacons and are never
# blind, no process grows by more than 16 MB, and all drive again within 5 s of the end.
#
#   bash tests/attack/attack.sh [ATTACK ...]
#
# GIVEWAY_ATTACK_SECONDS is how long each attack lasts, GIVEWAY_ATTACK_FUZZ_SECONDS how long the fuzzed one.
# Everything is in network namespaces of its own; needs root. After a failure logs and samples are kept.
if [[ -z ${OWN_NETWORK:-} ]]; then
  if [[ $(id -u) -ne 0 ]] || ! unshare -nm true 2>/dev/null; then
    echo "no right to make network namespaces: the attacks are left out" >&2
    exit 0
  fi
  # shellcheck disable=SC2016  # the inner shell expands it
  OWN_NETWORK=1 exec unshare -nm bash -c \
    'mount -t tmpfs none /run && ip link set lo up && exec bash "$0" "$@"' "$0" "$@"
fi
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
unset GIVEWAY_QOS GIVEWAY_INTERFACE GIVEWAY_DOMAIN
ATTACKER=${GIVEWAY_ATTACKER:-$BIN/attacker}
# This namespace has no other fleet, but fleets outside share the folder of the domain locks.
export TMPDIR=$SCRATCH
DOMAIN=$((RANDOM % 90 + 5))
VEHICLES=4
SECONDS_EACH=${GIVEWAY_ATTACK_SECONDS:-3}
FUZZ_SECONDS=${GIVEWAY_ATTACK_FUZZ_SECONDS:-6}
MOST_KB=$((16 * 1024))
ATTACKS=("$@")
[[ $# -gt 0 ]] ||
  ATTACKS=(loopback statistics fragments gaps heartbeats jumps steps strangers endpoints tokens replay flood fuzz health)
bad=0

# The other side of a cable: a stranger, and a program of this machine that joined the fleet's group.
ip netns add stranger
ip link add out type veth peer name in netns stranger
ip address add 192.0.2.1/24 dev out
ip link set out up
ip -n stranger address add 192.0.2.2/24 dev in
ip -n stranger link set in up

"$FLEETCTL" run patrol --vehicles "$VEHICLES" --restart --domain "$DOMAIN" --json \
  --logs "$SCRATCH/logs" >"$SCRATCH/report.json" 2>"$SCRATCH/fleet.log" &
PID[fleet]=$!
listen() { # NAME TOPIC
  "$FLEETCTL" listen "$2" --domain "$DOMAIN" --json >"$SCRATCH/$1.json" 2>"$SCRATCH/$1.log" &
  PID[$1]=$!
}

# drives_on SECONDS LINE: whether every vehicle says, behind that line, that it drives with its peers, or
# stands since one of them goes first; and one at least drives.
drives_on() {
  local end=$(($(date +%s%N) + $1 * 1000000000)) count
  while (($(date +%s%N) < end)); do
    count=$(samples_behind "$2" | jq -n '
      reduce inputs as $status ({};
        ($status.forward_m_s > 0.05) as $moves |
        (($status.rule | IN("give_way", "not_granted", "keep_clear", "steer_round", "make_room")) and
          $status.peer != null) as $waits |
        if $status.mode == "cooperative" and ($moves or $waits)
        then .[$status.vehicle | tostring] |= (. or $moves) else . end) |
      if any(.[]; .) then length else 0 end' 2>/dev/null) || count=0
    ((count >= VEHICLES)) && return
    sleep 0.1
  done
  return 1
}

# What vehicles said, behind a line.
samples_behind() { tail -n "+$(($1 + 1))" "$SCRATCH/status.json" | jq -R 'fromjson?'; }

# blind_ms FROM TO: the longest time that a vehicle had no ranges to go by, between two lines. By the count
# of its own beacons, one every 50 ms.
blind_ms() {
  head -n "$2" "$SCRATCH/status.json" | tail -n "+$(($1 + 1))" | jq -R 'fromjson?' | jq -n '
    [inputs] | group_by(.vehicle) | map(
      reduce .[] as $said ({since: null, most: 0};
        if $said.rule != "ranges_stale" then .since = null
        else .since = (.since // $said.beacons.sent) |
          .most = ([.most, 50 * ($said.beacons.sent - .since)] | max) end) | .most) |
    max // 0' 2>/dev/null || echo 0
}

# how_they_are LINE: what each vehicle said last, behind that line.
how_they_are() {
  samples_behind "$1" | jq -n -r '[inputs] |
    group_by(.vehicle) | map(last | " \(.vehicle) \(.mode) \(.rule) \(.forward_m_s * 100 | round)cm/s") | add' \
    2>/dev/null || true
}

# heard LINE: the share of each other's beacons, in per cent, that vehicles heard behind that line. By the
# largest and smallest counts, for a status that is sent again says what it said.
heard() {
  samples_behind "$1" | jq -n '
    [inputs] | group_by(.vehicle) | map(select(length > 1) |
      {sent: ((map(.beacons.sent) | max) - (map(.beacons.sent) | min)),
       taken: ((map(.beacons.taken) | max) - (map(.beacons.taken) | min))}) |
    (map(.sent) | add) as $sent | (length - 1) as $peers |
    if $sent > 0 then (100 * (map(.taken) | add) / ($peers * $sent) | floor) else 0 end' 2>/dev/null ||
    echo 0
}

contacts() { grep -c '"kind":"contact"' "$SCRATCH/events.json" || true; }
deaths() { grep -c 'died' "$SCRATCH/fleet.log" || true; }

# sizes: the resident memory of each process of the fleet, "PID kB" a line.
sizes() {
  local pid
  for pid in "${PID[fleet]}" "${PID[status]}" "${PID[events]}" $(children_of "${PID[fleet]}"); do
    awk -v pid="$pid" '/^VmRSS:/ {print pid, $2}' "/proc/$pid/status" 2>/dev/null || true
  done
}
growth_kb() { # BEFORE: of the process that grew most
  join <(sort <<<"$1") <(sizes | sort) | awk '{grown = $3 - $2; if (grown > most) most = grown}
    END {print most + 0}'
}

# report NAME FAULTS WHAT
report() {
  if [[ -z $2 ]]; then
    echo "ok      $1: $3"
  else
    echo "FAILED  $1:$2 ($3)"
    bad=$((bad + 1))
  fi
}

# attacked NAME COMMAND...: the fleet while that runs, and after it. An intruder that sends as another's writer
# with its next sequence numbers blinds that one's readers meanwhile; nothing can prevent it.
attacked() {
  local name=$1 line before died touched faults='' sent share grown started_ns took blind
  shift
  line=$(wc -l <"$SCRATCH/status.json")
  before=$(sizes)
  died=$(deaths) touched=$(contacts)
  sent=$("$@" 2>&1) || faults+=" the attack did not run: $sent;"
  local after
  after=$(wc -l <"$SCRATCH/status.json")
  started_ns=$(date +%s%N)
  drives_on 5 "$after" || faults+=" not all drive on within 5 s:$(how_they_are "$after");"
  took=$((($(date +%s%N) - started_ns) / 1000000))
  share=$(heard "$line")
  blind=$(blind_ms "$line" "$after")
  grown=$(growth_kb "$before")
  (($(deaths) == died)) || faults+=" $(($(deaths) - died)) died;"
  for process in fleet status events; do
    alive "$process" || faults+=" $process is gone;"
  done
  (($(contacts) == touched)) || faults+=" $(($(contacts) - touched)) contacts;"
  [[ $name == steps ]] || ((blind <= 1000)) || faults+=" a vehicle was blind for $blind ms;"
  [[ $name == steps ]] || ((share >= 90)) || faults+=" beacons heard: $share %;"
  ((grown <= MOST_KB)) || faults+=" +$grown kB;"
  report "$name" "$faults" "${sent#*: }, beacons heard $share %, blind $blind ms, +$grown kB, drives on after $took ms"
}

attack() { "$ATTACKER" "$1" --domain "$DOMAIN" --seconds "${2:-$SECONDS_EACH}" --rate "${3:-2000}"; }

# from_stranger DOMAIN: statistics packets of the cable.
from_stranger() {
  ip netns exec stranger "$ATTACKER" statistics --no-capture --domain "$1" --source 192.0.2.2 \
    --address 192.0.2.1 --seconds "$SECONDS_EACH" --rate 500
}

# The group is joined on the cable by another process, and the stranger speaks to it: to the fleet, and to a vehicle
# on loopback that is asked what reached it.
from_the_cable() {
  local joined code=0 reached
  "$BIN/giveway-vehicle" --scenario patrol --domain "$((DOMAIN + 1))" --health-port 20002 \
    2>"$SCRATCH/asked.log" &
  PID[asked]=$!
  "$ATTACKER" join --source 192.0.2.1 --seconds "$((2 * SECONDS_EACH + 2))" &
  joined=$!
  sleep 1
  from_stranger "$DOMAIN" || code=1
  from_stranger "$((DOMAIN + 1))" >/dev/null || code=1
  reached=$("$BIN/giveway-vehicle" --health metrics --health-port 20002 |
    awk '/^giveway_vehicle_packets_dropped_total/ {seen = 1; sum += $2} END {print seen ? sum : "no metrics"}')
  [[ $reached == 0 ]] || {
    echo "packets of the cable that reached a vehicle on loopback: $reached"
    code=1
  }
  kill_now asked
  wait "$joined" || code=1
  return "$code"
}

# Clients from another machine that send a byte every 0.2 s of a request that never ends, and one that
# sends without pause, in addition to probes from this machine.
health_port() {
  local tricklers=() code=0 answered=0 _
  "$BIN/giveway-vehicle" --scenario patrol --domain "$((DOMAIN + 1))" --health-address 0.0.0.0 \
    --health-port 20001 2>"$SCRATCH/probed.log" &
  PID[probed]=$!
  for _ in $(seq 100); do
    timeout 2 "$BIN/giveway-vehicle" --health live --health-port 20001 >/dev/null 2>&1 && break
    sleep 0.1
  done
  for _ in $(seq 10); do
    # shellcheck disable=SC2016  # the inner shell expands it
    ip netns exec stranger bash -c 'trap "" PIPE; while :; do
      exec 3<>/dev/tcp/192.0.2.1/20001 || { sleep 0.1; continue; }
      while printf x >&3; do sleep 0.2; done; exec 3>&-; done' 2>/dev/null &
    tricklers+=("$!")
  done
  # shellcheck disable=SC2016
  ip netns exec stranger bash -c 'while :; do cat /dev/zero 2>/dev/null >/dev/tcp/192.0.2.1/20001; done' \
    2>/dev/null &
  tricklers+=("$!")
  sleep 0.5
  for _ in $(seq 20); do
    timeout 2 "$BIN/giveway-vehicle" --health live --health-port 20001 >/dev/null 2>&1 &&
      answered=$((answered + 1))
    sleep 0.1
  done
  for _ in "${tricklers[@]}"; do kill -0 "$_" || code=1; done # they are still there
  kill "${tricklers[@]}" 2>/dev/null || true
  kill_now probed
  echo "probes: $answered of 20 answered"
  ((answered == 20)) || code=1
  return "$code"
}

for _ in $(seq 100); do # until the processes are there
  sleep 0.1
  [[ $(children_of "${PID[fleet]}" | wc -l) -gt $VEHICLES ]] && break
done
listen status fleet/status
listen events world/event
sleep 1
drives_on 30 0 || {
  KEEP=1
  echo "FAILED  the fleet does not drive (see $SCRATCH): $(tail -n 3 "$SCRATCH/fleet.log" "$SCRATCH/status.log")"
  exit 1
}

for name in "${ATTACKS[@]}"; do
  case $name in
    loopback) attacked loopback from_the_cable ;;
    health)
      if said=$(health_port); then report health '' "$said"; else report health " probes fail" "$said"; fi
      ;;
    fuzz) attacked fuzz attack fuzz "$FUZZ_SECONDS" ;;
    flood) attacked flood attack flood "$SECONDS_EACH" 5000 ;;
    *) attacked "$name" attack "$name" ;;
  esac
done

# The run is stopped, and its judge saw no contact either.
kill -INT "${PID[fleet]}"
wait "${PID[fleet]}" || true
unset 'PID[fleet]'
faults=''
[[ $(jq .contacts "$SCRATCH/report.json") == 0 ]] || faults=" $(head -c 300 "$SCRATCH/report.json")"
report "the whole run" "$faults" "0 contacts"
grep -h 'packet filter' "$SCRATCH"/logs/*.log | sed 's/^/  /' | tail -n 12 >&2 || true
((bad == 0)) || {
  KEEP=1
  echo "logs and samples: $SCRATCH" >&2
}
[[ $bad -eq 0 ]]
