#!/usr/bin/env bash
# From a fresh Debian to a fleet of containers that drives until it is asked to stop. Every step does
# nothing where nothing is to be done, so that the same command again brings more or fewer vehicles.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/engine.sh"

HERE=config/deploy # from the root of the project

usage() {
  cat <<'TEXT'
Usage: bash config/deploy/up.sh [--vehicles N] [--servers] [--no-build]

Installs a container engine where none is (Debian's docker.io; root or sudo), makes the base image
where no registry has it, builds the images, starts a fleet, waits until every vehicle is ready, and
says how to look in, scale and stop.

  --vehicles N  so many (default 2); the scenario must have places for them
  --servers     found by two discovery servers, where the network passes no multicast
  --no-build    with the images as they are
  --help        this text

What else may be set, GIVEWAY_SCENARIO (default patrol) among it, stands at the head of
config/deploy/compose.yaml.

Exit code: 0 all are ready, 1 they are not in a minute and a second for each, 2 could not run.
TEXT
}

# The places of a shipped scenario; nothing is known of others.
places_of() { # SCENARIO
  local file
  file=config/scenarios/$(basename "$1" .textproto).textproto
  [[ -f $file ]] || return 0
  grep -cE '^(spawn|vehicle)\b' "$file" || true
}

refuse() {
  printf 'error: %s; see --help\n' "$*" >&2
  exit 2
}

vehicles=2 build=true discovery=multicast
read_arguments() {
  while [[ $# -gt 0 ]]; do
    case $1 in
      --help | -h) usage && exit 0 ;;
      --vehicles)
        [[ $# -gt 1 ]] || refuse "--vehicles needs a number"
        vehicles=$2
        shift
        ;;
      --vehicles=*) vehicles=${1#*=} ;;
      --servers) discovery=discovery_server ;;
      --no-build) build=false ;;
      *) refuse "unknown argument '$1'" ;;
    esac
    shift
  done
  [[ $vehicles =~ ^[1-9][0-9]{0,2}$ ]] || refuse "--vehicles $vehicles: must be a number from 1 to 999"
  local scenario=${GIVEWAY_SCENARIO:-patrol} places
  places=$(places_of "$scenario")
  [[ -z $places || $vehicles -le $places ]] ||
    refuse "--vehicles $vehicles: $scenario has places for $places; name another one by GIVEWAY_SCENARIO"
}

# An engine that answers, from any vendor; else Debian's.
have_engine() {
  engine_is_up && return
  [[ $(id -u) -eq 0 ]] || die "no container engine answers to this user; as root, or by sudo -E, it is installed and started"
  mapfile -t packages < <(engine_packages)
  install_packages "${packages[@]}"
  if [[ -d /run/systemd/system ]]; then
    systemctl start docker || die "systemd could not start docker: journalctl -u docker says why"
  fi
  engine_is_up && return
  say "starting dockerd; its log is $ENGINE_LOG"
  start_engine
}

have_compose() {
  COMPOSE=(docker-compose)
  command -v docker-compose >/dev/null && return
  COMPOSE=(docker compose)
  docker compose version >/dev/null 2>&1 && return
  [[ $(id -u) -eq 0 ]] || die "docker-compose is missing; as root: apt-get install docker-compose"
  install_packages docker-compose
  COMPOSE=(docker-compose)
}

# Only a Debian can be made here.
have_base() {
  local base
  base=$(base_name)
  has_image "$base" || timeout 60 docker pull -q "$base" >/dev/null 2>&1 && return
  [[ $base == "debian:$SUITE-slim" ]] || die "there is no image $base, and it cannot be pulled; GIVEWAY_BASE names it"
  base_image "$SUITE"
}

have_images() {
  local target
  if $build; then
    have_base
    for target in world vehicle observer tools; do
      say "building giveway-$target (the first takes ten minutes on two cores)"
      build_image "$target"
    done
  fi
  for target in world vehicle tools; do
    has_image "giveway-$target" || die "there is no image giveway-$target; leave --no-build out"
  done
}

compose() { "${COMPOSE[@]}" "${FILES[@]}" "$@"; }

# One line each: container, and what it says of being ready.
readiness() {
  local container answer
  for container in $(compose ps -q vehicle); do
    answer=$(docker exec "$container" giveway-vehicle --health ready 2>&1 | head -n 1) || true
    printf '%s %s\n' "$container" "${answer:-does not answer}"
  done
}
count_ready() { grep -c '^[^ ]* ready' <<<"$1" || true; }

wait_until_ready() {
  local patience=$((60 + vehicles)) said ready=0
  local deadline=$((SECONDS + patience))
  say "waiting until $vehicles vehicles are ready"
  while ((SECONDS < deadline)); do
    said=$(readiness)
    ready=$(count_ready "$said")
    [[ $ready -ge $vehicles ]] && return
    sleep 0.5
  done
  printf 'error: %d of %d vehicles are ready after %d s; the others say:\n' "$ready" "$vehicles" \
    "$patience" >&2
  grep -v '^[^ ]* ready' <<<"$said" | cut -d' ' -f2- | sort | uniq -c >&2
  exit 1
}

say_what_next() {
  local words="${COMPOSE[*]} ${FILES[*]}" subnet=${GIVEWAY_SUBNET:-172.30.53} more="" found=""
  local top="fleetctl top --domain ${GIVEWAY_DOMAIN:-1} --interface $subnet.1"
  if [[ $discovery != multicast ]]; then
    more=" --servers" found=" --discovery-server $subnet.250,$subnet.251"
  fi
  cat <<TEXT
$vehicles vehicles are ready, and drive until they are stopped.

look in    $words run --rm tools top
           $top$found    # from this host
logs       $words logs -f
scale      bash $HERE/up.sh$more --vehicles N
new world  $words restart world
stop       $words down
TEXT
}

cd "$GIVEWAY_ROOT"
read_arguments "$@"
# As compose.yaml says itself; the env file of multicast is empty.
FILES=(-f "$HERE/compose.yaml")
[[ $discovery == multicast ]] || FILES=(--env-file "$HERE/$discovery.env" "${FILES[@]}")
GIVEWAY_BASE=$(base_name)
export GIVEWAY_BASE
have_engine
have_compose
have_images
compose up -d --no-build --scale vehicle="$vehicles" >&2 || die "compose could not start the fleet"
wait_until_ready
say_what_next
