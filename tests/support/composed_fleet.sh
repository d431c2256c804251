# shellcheck shell=bash
# What the container drills share: a composed fleet, observed from inside each container's own network, and
# waiting for conditions with deadlines. Sourced, never run.
source "$(dirname "${BASH_SOURCE[0]}")/../support/engine.sh"
source "$(dirname "${BASH_SOURCE[0]}")/../support/only_late.sh"
source "$(dirname "${BASH_SOURCE[0]}")/../support/lateness.sh"

HERE=$GIVEWAY_ROOT/tests/containers
# Which of the drills at a time this is: containers, network and firewall rules of each are its own.
DRILL=${GIVEWAY_DRILL:-1}
PROJECT=giveway-drill-$DRILL
FIREWALL=giveway_drill_$DRILL
export GIVEWAY_SUBNET=172.30.$((52 + DRILL))
SCRATCH=$(mktemp -d)
keep_time "$SCRATCH/late_us"
TIME_KEEPER=$!
# What drill.yaml mounts; the services' user reads it.
export DRILL_SCENARIOS=$SCRATCH/scenarios
mkdir "$DRILL_SCENARIOS"
chmod 755 "$SCRATCH" "$DRILL_SCENARIOS"
cp "$HERE/lanes.textproto" "$DRILL_SCENARIOS"
# use multicast|servers: how the vehicles of this test discover each other. With servers a firewall rule drops
# every multicast between the containers.
use() {
  env_file=$GIVEWAY_ROOT/config/deploy/multicast.env
  [[ $1 == servers ]] && env_file=$GIVEWAY_ROOT/config/deploy/discovery_server.env
  [[ $1 == servers ]] && block_multicast
  return 0
}

# A single run: the services end with it, and the world's exit code is its verdict. One that crashes comes back.
once() { export GIVEWAY_RESTART=on-failure GIVEWAY_STAY=; }

# eight ARRIVALS: the shipped open fleet, started once eight have joined, with this line on which must arrive.
eight() {
  sed -e 's/^start_with: 2$/start_with: 8\nstart_timeout_s: 60/' -e 's/^duration_s: 90$/duration_s: 60/' \
    -e "s/^  any_arrived: true\$/  $1/" "$GIVEWAY_ROOT/config/scenarios/open_fleet.textproto" \
    >"$DRILL_SCENARIOS/eight.textproto"
}

compose() {
  docker-compose -p "$PROJECT" --env-file "$env_file" \
    -f "$GIVEWAY_ROOT/config/deploy/compose.yaml" -f "$HERE/drill.yaml" "$@"
}

# up VEHICLES
up() {
  compose up -d --no-build --scale vehicle="$1" >"$SCRATCH/up.log" 2>&1 ||
    fail "up with $1 vehicles: $(tail -n 5 "$SCRATCH/up.log")"
}

down() { compose down -v -t 5 >"$SCRATCH/down.log" 2>&1 || fail "down: $(tail -n 3 "$SCRATCH/down.log")"; }

block_multicast() {
  nft -f - <<TEXT
table bridge $FIREWALL {
  chain forward {
    type filter hook forward priority 0;
    ip saddr $GIVEWAY_SUBNET.0/24 ether daddr & ff:ff:ff:80:00:00 == 01:00:5e:00:00:00 counter drop
  }
}
TEXT
}
# The rule is effective: otherwise multicast could have done the servers' work. A vehicle that uses multicast
# finds no fleet.
multicast_finds_nobody() {
  local alone
  alone=$(docker run -d --network "${PROJECT}_fleet" -e GIVEWAY_SCENARIO=open_fleet \
    -e GIVEWAY_DOMAIN=1 giveway-vehicle)
  await "by multicast: no fleet is found" 15 says "$alone" 'no answer from a world yet'
  await "by multicast: the firewall dropped it" 5 drops_multicasts
  docker rm -f "$alone" >/dev/null
}
drops_multicasts() { grep -q 'counter packets [1-9]' < <(nft list table bridge "$FIREWALL"); }
says() { docker logs "$1" 2>&1 | grep -Eq "$2"; }
pass_multicast() { nft delete table bridge "$FIREWALL" 2>/dev/null || true; }

end_drill() {
  kill "$TIME_KEEPER" 2>/dev/null || true
  if [[ $failures -ne 0 ]]; then
    for container in $(all_containers); do
      echo "--- $(name_of "$container")" >&2
      docker logs --tail 12 "$container" >&2 2>&1
    done
  fi
  down
  pass_multicast
  engine_down
  rm -rf "$SCRATCH"
}
trap end_drill EXIT

# Containers of a service, running or not; `running` names those that run.
all_containers() { docker ps -aq --filter "label=com.docker.compose.project=$PROJECT"; }
members() { # SERVICE [FILTER]
  docker ps -aq --filter "label=com.docker.compose.project=$PROJECT" \
    --filter "label=com.docker.compose.service=$1" ${2:+--filter "$2"}
}
running() { members "$1" status=running; }
first_of() { head -n 1 < <(running "$1"); }
name_of() { docker inspect -f '{{.Name}}' "$1" | tr -d /; }
# The first process of a container; 0 if it does not run. Kept as long as that process lives: drills ask for it many
# times a second, and the engine takes a twentieth of one for an answer.
pid_of() { # CONTAINER
  local pid before kept=$SCRATCH/pid-$1
  if { read -r pid before <"$kept"; } 2>/dev/null && [[ -n $before && $(start_of "$pid") == "$before" ]]; then
    echo "$pid"
    return
  fi
  pid=$(docker inspect -f '{{.State.Pid}}' "$1") || return
  [[ $pid == 0 ]] || echo "$pid $(start_of "$pid")" >"$kept"
  echo "$pid"
}
# When a process started, in ticks since the machine did; empty if there is none.
start_of() { # PID
  local stat fields
  { read -r stat <"/proc/$1/stat"; } 2>/dev/null || return 0
  read -ra fields <<<"${stat##*) }"
  [[ ${fields[0]} == Z ]] || echo "${fields[19]}"
}

# The metrics page, or nothing. From inside: no port is published.
metrics() { # CONTAINER
  nsenter -t "$(pid_of "$1")" -n curl -s -m 2 http://127.0.0.1:8080/metrics 2>/dev/null
}
ready() { nsenter -t "$(pid_of "$1")" -n curl -s -m 2 http://127.0.0.1:8080/readyz 2>/dev/null; }
# metric CONTAINER NAME: its value; 0 if the container does not answer.
metric() { metrics "$1" | awk -v name="giveway_$2" '$1 == name {value = $2} END {print value + 0}'; }

# Its wheels turn, and it is ready: the speed alone may be the last one measured, before the world or the
# network was gone.
drives() { # CONTAINER
  metrics "$1" | awk '$1 == "giveway_vehicle_speed_meters_per_second" {speed = $2}
    $1 == "giveway_vehicle_ready" {ready = $2} END {exit !(ready == 1 && speed > 0.05)}'
}
all_drive() { # COUNT
  local container count=0
  for container in $(running vehicle); do
    drives "$container" || return 1
    count=$((count + 1))
  done
  [[ $count -eq $1 ]]
}

# Every running vehicle has matched the beacons of all others. One killed together with a discovery server
# stays matched in those that knew it: the server that comes back does not know it (eProsima/Fast-DDS#4033).
all_matched() { # COUNT
  local container
  for container in $(running vehicle); do
    [[ $(metric "$container" vehicle_peers_matched) -ge $(($1 - 1)) ]] || return 1
  done
}

any_drives() {
  local container
  for container in $(running vehicle); do drives "$container" && return; done
  return 1
}

# Placements of all vehicles so far: another world places each again.
places() {
  local vehicle sum=0
  for vehicle in $(running vehicle); do
    sum=$((sum + $(metric "$vehicle" vehicle_placements_total)))
  done
  echo "$sum"
}

# await WHAT SECONDS COMMAND...: waits until the command is true; fails after so many seconds, to which is added
# what the machine was late meanwhile.
await() {
  local what=$1 seconds=$2 start_ns waited_us late_before_us
  shift 2
  start_ns=$(date +%s%N)
  late_before_us=$(late_us "$SCRATCH/late_us")
  while ! "$@"; do
    waited_us=$((($(date +%s%N) - start_ns) / 1000))
    if ((waited_us > seconds * 1000000 + $(late_us "$SCRATCH/late_us") - late_before_us)); then
      fail "$what: not within $seconds s"
      return 0
    fi
    sleep 0.05
  done
  echo "$what: $((($(date +%s%N) - start_ns) / 1000000)) ms"
}

# holds WHAT SECONDS COMMAND...: true each time it is polled for so many seconds, or again within one second,
# which it says: a machine that stalls stops its vehicles for as long, by design. What is lost stays lost.
holds() {
  local what=$1 until=$((SECONDS + $2)) looks=0 before=$failures
  shift 2
  while ((SECONDS < until)); do
    "$@" || await "$what: lapsed at poll $looks, and again" 1 "$@"
    ((failures == before)) || return 0
    looks=$((looks + 1))
    sleep 0.5
  done
  echo "$what: at all of $looks looks"
}

# excused WORLD: true if only the lateness of the machine explains that its run failed.
excused() {
  local ended reason vehicle
  ended=$(docker logs "$1" 2>&1 | sed -n 's/.*ended: .*; failed: \(.*\); late for \([0-9]*\) ticks.*/\2 \1/p')
  [[ -n $ended ]] && ! grep -q 'contact:' < <(docker logs "$1" 2>&1) || return 1
  reason=${ended#* }
  only_late "$reason" "${ended%% *}" "$(
    for vehicle in $(members vehicle); do docker logs "$vehicle" 2>&1; done | scans_missed
  )"
}

# As in a crash: docker would take its own kill for a request to stay stopped.
crash() { kill -9 "$(pid_of "$1")"; }

# was_restarted CONTAINER BEFORE: by its policy, more often than BEFORE times.
restart_count() { docker inspect -f '{{.RestartCount}}' "$1"; }
was_restarted() { [[ $(restart_count "$1") -gt $2 ]]; }

in_network_of() { # CONTAINER COMMAND...
  local pid
  pid=$(pid_of "$1")
  shift
  nsenter -t "$pid" -n "$@"
}
# No traffic in or out of a container; its own loopback stays.
cut_off() {
  in_network_of "$1" iptables -A INPUT ! -i lo -j DROP
  in_network_of "$1" iptables -A OUTPUT ! -o lo -j DROP
}
reconnect() { in_network_of "$1" iptables -F; }

no_contact() {
  local world
  for world in $(members world); do
    if grep -m 3 'contact:' < <(docker logs "$world" 2>&1); then fail "vehicles touched"; fi
  done
}
