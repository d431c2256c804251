#!/usr/bin/env bash
# Misconfigured deployments: each container says what is wrong and what to do, /readyz says why it waits, and
# the restart policy does not spin.
source "$(dirname "${BASH_SOURCE[0]}")/../support/composed_fleet.sh"
engine_up
use multicast
BAD_SUBNET=172.30.$((72 + DRILL))
docker network create "$PROJECT-bad" --subnet "$BAD_SUBNET.0/24" >/dev/null
made=()
end_bad_input() {
  [[ ${#made[@]} -eq 0 ]] || docker rm -f "${made[@]}" >/dev/null
  docker network rm "$PROJECT-bad" >/dev/null
  end_drill
}
trap end_bad_input EXIT

# service PROGRAM NAME=VALUE...: a container with these variables over valid ones, in BAD.
service() {
  local program=$1 variables=() pair
  shift
  for pair in GIVEWAY_SCENARIO=open_fleet GIVEWAY_DOMAIN=1 GIVEWAY_INTERFACE=eth0 "$@"; do
    variables+=(-e "$pair")
  done
  BAD=$(docker run -d --read-only --cap-drop ALL --restart on-failure --network "$PROJECT-bad" \
    "${variables[@]}" "giveway-$program")
  made+=("$BAD")
}

ready_says() { ready "$BAD" | grep -Eq "$1"; }
restarts() { docker inspect -f '{{.RestartCount}}' "$BAD"; }
restarted() { [[ $(restarts) -ge $1 ]]; }
# A container that runs again has code 0.
waits_after_2() { [[ $(docker inspect -f '{{.State.Status}} {{.State.ExitCode}}' "$BAD") == "restarting 2" ]]; }

# Ends, and is restarted ever more rarely: docker doubles the wait from 0.1 s.
ends_with() { # WHAT PATTERN
  await "$1: says so" 10 says "$BAD" "$2"
  await "$1: tried again" 60 restarted 3
  local before
  before=$(restarts)
  sleep 5
  [[ $(($(restarts) - before)) -le 4 ]] || fail "$1: $(($(restarts) - before)) restarts in 5 s"
  await "$1: ended with exit code 2" 30 waits_after_2
}

# Stays, waits, and says why.
waits_with() { # WHAT LOGGED READY
  await "$1: says so" 15 says "$BAD" "$2"
  await "$1: /readyz says why" 10 ready_says "$3"
  [[ $(restarts) -eq 0 ]] || fail "$1: was restarted"
}

service vehicle GIVEWAY_DOMAIN=1000 GIVEWAY_LOG_LEVEL=loud
ends_with "wrong values" 'GIVEWAY_DOMAIN = 1000: must be a whole number between 1 and 99'
says "$BAD" 'GIVEWAY_LOG_LEVEL = loud' || fail "the second wrong value is not named"
service world GIVEWAY_SCENARIO=/scenarios/missing.textproto
ends_with "no scenario is mounted" 'missing.textproto: no such file'
service vehicle GIVEWAY_QOS=/qos/missing.xml
ends_with "no QoS file is mounted" 'missing.xml: does not exist; give a complete profile set'
service vehicle GIVEWAY_DISCOVERY_SERVER=no_such_host:11811
waits_with "a server without an address" 'discovery server no_such_host .* has no address yet' \
  'discovery server no_such_host .* has no address yet'
service vehicle GIVEWAY_DISCOVERY_SERVER="$BAD_SUBNET.200"
waits_with "a server that does not answer" 'no discovery server answers' "$BAD_SUBNET.200:11811"
# Patient: a shipped fleet waits ten minutes for its vehicles.
service world GIVEWAY_DISCOVERY_SERVER="$BAD_SUBNET.200" GIVEWAY_SCENARIO=fleet_2
waits_with "a world whose server does not answer" 'no discovery server answers' "$BAD_SUBNET.200:11811"
service vehicle
waits_with "no world" 'no answer from a world yet' 'is giveway-world running in this domain'

service world GIVEWAY_DOMAIN=2
service vehicle GIVEWAY_DOMAIN=2 GIVEWAY_ID=7
await "the first with its id: joined" 15 ready_says '^not ready: matched|^ready'
service vehicle GIVEWAY_DOMAIN=2 GIVEWAY_ID=7
await "two vehicles with one id: /readyz says why" 15 ready_says 'id 7'
await "two vehicles with one id: says so" 15 says "$BAD" 'refused this vehicle: .*7'
[[ $failures -eq 0 ]]
