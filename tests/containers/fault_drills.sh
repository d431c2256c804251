#!/usr/bin/env bash
# A composed fleet under faults: kill -9 of a vehicle, the world, one discovery server and both, a vehicle killed
# while a server is stopped, a pause, a cut network, more and fewer vehicles. No two bodies touch, and every
# vehicle that returns drives again within five seconds (eight where discovery servers went with it), without help
# from outside.
#
#   bash tests/containers/fault_drills.sh multicast|servers
source "$(dirname "${BASH_SOURCE[0]}")/../support/composed_fleet.sh"
[[ ${1:-} == multicast || ${1:-} == servers ]] || die "say multicast or servers"
LIMIT_S=5
# Where servers were killed too: a client drops the former server only after its lease of 2 s.
SERVERS_LIMIT_S=8
export GIVEWAY_SCENARIO=/drill/lanes.textproto
engine_up
use "$1"

drill_vehicle_crash() { # WHAT [SECONDS]
  local vehicle before
  vehicle=$(first_of vehicle)
  before=$(restart_count "$vehicle")
  crash "$vehicle"
  await "$1: its container is started again" 5 was_restarted "$vehicle" "$before"
  await "$1: all drive" "${2:-$LIMIT_S}" all_drive "$VEHICLES"
}

# drive_again PLACES: so many places were given, and all drive. Without the count, a vehicle just unpaused
# could be sampled with the speed and the ranges from before its pause.
drive_again() { [[ $(places) -ge $1 ]] && all_drive "$VEHICLES"; }

drill_world_crash() {
  local world before placed_before
  world=$(first_of world)
  before=$(restart_count "$world")
  placed_before=$(places)
  crash "$world"
  await "world killed: its container is started again" 5 was_restarted "$world" "$before"
  await "world killed: all drive again" "$LIMIT_S" drive_again $((placed_before + VEHICLES))
}

# Vehicles that know each other continue without a server; new ones find them through the other server, and
# after both were down through whichever is back. The packaged server has no packet filter: a packet that ends it
# costs a fleet three seconds at most.
drill_servers_crash() {
  local service others container
  local -A before=()
  for others in discovery-0 discovery-1 "discovery-0 discovery-1"; do
    before=()
    for service in $others; do
      container=$(first_of "$service")
      before[$container]=$(server_in "$container")
    done
    for container in "${!before[@]}"; do end_server "$container" "$others"; done
    for container in "${!before[@]}"; do
      await "$others killed: $(name_of "$container") serves again" 3 serves_again "$container" "${before[$container]}"
    done
    await "$others killed: all drive" 3 all_drive "$VEHICLES"
    drill_vehicle_crash "vehicle killed with $others" "$SERVERS_LIMIT_S"
  done
  VEHICLES=$((VEHICLES + 1))
  up "$VEHICLES"
  await "servers were killed: a newcomer drives, too" "$LIMIT_S" all_drive "$VEHICLES"
}
# A single server is ended as an intruder in its network can do it: by a statistics submessage that is not the
# last one of its packet, as tests/attack sends it to the services. Both at once by kill -9.
end_server() { # CONTAINER SERVERS
  if [[ $2 == *" "* ]]; then
    kill -9 "$(server_in "$1")"
  else
    in_network_of "$1" bash -c "printf '%b' '$STATISTICS_PACKET' >/dev/udp/127.0.0.1/11811"
  fi
}
# The header of RTPS 2.3 and vendor 1.15 with any GUID prefix, submessage 0x80 of 56 bytes, and zeros.
STATISTICS_PACKET="RTPS\\x02\\x03\\x01\\x0f$(printf '\\x01%.0s' {1..12})\\x80\\x00\\x00\\x38$(printf '\\x00%.0s' {1..60})"
# The server under the supervisor that is process 1 of its container.
server_in() { # CONTAINER
  local pid child children
  pid=$(pid_of "$1")
  read -ra children 2>/dev/null <"/proc/$pid/task/$pid/children" || true
  for child in "${children[@]}"; do
    [[ $(cat "/proc/$child/comm" 2>/dev/null) != fast-discovery-* ]] || echo "$child"
  done
}
serves_again() { # CONTAINER BEFORE
  local now
  now=$(server_in "$1")
  [[ -n $now && $now != "$2" ]] && grep -q ":2E23 " "/proc/$now/net/udp" 2>/dev/null
}
# The name server has no name for a container that does not run: a vehicle that then started waited for ever.
drill_server_stopped() {
  local server
  server=$(first_of discovery-1)
  docker stop -t 2 "$server" >/dev/null
  drill_vehicle_crash "vehicle killed while a server is stopped" "$SERVERS_LIMIT_S"
  docker start "$server" >/dev/null
}
# Longer than any participant lease, which is 10 s. A vehicle that loses a peer drives on, by its sensors.
drive_together() { all_drive "$VEHICLES" && all_matched "$VEHICLES"; }
drill_servers_away() {
  docker stop -t 2 "$(first_of discovery-0)" "$(first_of discovery-1)" >/dev/null
  holds "both servers away: all drive on, matched" 12 drive_together
  docker start "$(members discovery-0)" "$(members discovery-1)" >/dev/null
  VEHICLES=$((VEHICLES + 1))
  up "$VEHICLES"
  await "servers are back: a newcomer drives, too" "$LIMIT_S" all_drive "$VEHICLES"
}

drill_pause() {
  local vehicle placed_before
  vehicle=$(first_of vehicle)
  placed_before=$(places)
  docker pause "$vehicle" >/dev/null
  await "paused: the world takes it away" 10 joined $((VEHICLES - 1))
  docker unpause "$vehicle" >/dev/null
  await "unpaused: all drive again" "$LIMIT_S" drive_again $((placed_before + 1))
}
joined() { [[ $(metric "$(first_of world)" world_vehicles_joined) -eq $1 ]]; }

drill_cut() {
  local vehicle placed_before
  vehicle=$(first_of vehicle)
  placed_before=$(places)
  cut_off "$vehicle"
  await "cut: the world takes it away" 10 joined $((VEHICLES - 1))
  reconnect "$vehicle"
  await "restored: all drive again" "$LIMIT_S" drive_again $((placed_before + 1))
}

# The interface itself goes away, and another one with the same address appears. With multicast, later
# vehicles no longer find this one, see config/deploy/README.md: there this drill comes last.
drill_unplug() {
  local vehicle placed_before address
  vehicle=$(first_of vehicle)
  address=$(docker inspect -f '{{range .NetworkSettings.Networks}}{{.IPAddress}}{{end}}' "$vehicle")
  placed_before=$(places)
  docker network disconnect "${PROJECT}_fleet" "$vehicle"
  await "unplugged: the world takes it away" 10 joined $((VEHICLES - 1))
  docker network connect --ip "$address" "${PROJECT}_fleet" "$vehicle"
  await "plugged in: all drive again" "$LIMIT_S" drive_again $((placed_before + 1))
}

drill_scale() {
  VEHICLES=8
  up 8
  await "scaled up: all 8 drive" 30 all_drive 8
  VEHICLES=3
  up 3
  await "scaled down: all 3 drive" "$LIMIT_S" all_drive 3
  await "scaled down: the world has 3" "$LIMIT_S" joined 3
}

# What the deployment promises about every container, checked from the host.
shut_in() { # CONTAINER
  local status
  status=/proc/$(pid_of "$1")/status
  grep -Eq '^Uid:[[:space:]]+10001' "$status" || fail "$(name_of "$1") does not run as 10001"
  grep -Eq '^CapBnd:[[:space:]]+0+$' "$status" || fail "$(name_of "$1") has capabilities"
  [[ $(docker inspect -f '{{.HostConfig.ReadonlyRootfs}}' "$1") == true ]] ||
    fail "$(name_of "$1") may write its root file system"
}

VEHICLES=2
up 2
await "up: all drive" 30 all_drive 2
for container in $(all_containers); do shut_in "$container"; done
drill_vehicle_crash "vehicle killed"
drill_world_crash
drill_pause
drill_cut
drill_scale
drill_unplug
if [[ $1 == servers ]]; then
  drill_server_stopped
  drill_servers_crash
  drill_servers_away
fi
no_contact
[[ $failures -eq 0 ]]
