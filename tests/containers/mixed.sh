#!/usr/bin/env bash
# A mixed fleet: vehicles built here (on Debian 12 Fast DDS 2.9.1) and of the image (3.1.2) on one loopback,
# first under the world of the one, then of the other. The world's verdict counts.
source "$(dirname "${BASH_SOURCE[0]}")/../support/engine.sh"
BIN=${GIVEWAY_BIN_DIR:-$GIVEWAY_ROOT/build/release/bin}
SCRATCH=$(mktemp -d)
CONTAINERS=()
PIDS=()
end_mixed() {
  [[ ${#CONTAINERS[@]} -eq 0 ]] || docker rm -f "${CONTAINERS[@]}" >/dev/null
  [[ ${#PIDS[@]} -eq 0 ]] || kill -9 "${PIDS[@]}" 2>/dev/null
  engine_down
  rm -rf "$SCRATCH"
}
trap end_mixed EXIT
engine_up

# If both have the same library nothing is mixed.
OURS=$("$BIN/giveway-vehicle" --version)
THEIRS=$(docker run --rm --network none giveway-vehicle --version)
[[ $OURS != "$THEIRS" ]] || die "both are $OURS: nothing is mixed"

# A free domain, kept by the lock that fleetctl takes too.
for DOMAIN in $(seq 60 99); do
  exec {lock}>>"${TMPDIR:-/tmp}/giveway-domain-$DOMAIN.lock"
  flock -n "$lock" && break
  exec {lock}>&-
done

native() { # PROGRAM SCENARIO
  "$BIN/$1" --scenario "$2" --domain "$DOMAIN" 2>>"$SCRATCH/$1.log" &
  PIDS+=($!)
}
contained() { # PROGRAM SCENARIO
  CONTAINERS+=("$(docker run -d --network host --read-only --cap-drop ALL \
    -e GIVEWAY_SCENARIO="$2" -e GIVEWAY_DOMAIN="$DOMAIN" -e GIVEWAY_INTERFACE=127.0.0.1 \
    -e GIVEWAY_HEALTH_PORT=0 "giveway-${1#giveway-}")")
}

# crossing WORLD_OF SCENARIO NATIVE CONTAINED: so many vehicles of each.
crossing() {
  local world code
  "$1" giveway-world "$2"
  [[ $1 == native ]] && world=${PIDS[-1]} || world=${CONTAINERS[-1]}
  for _ in $(seq "$3"); do native giveway-vehicle "$2"; done
  for _ in $(seq "$4"); do contained giveway-vehicle "$2"; done
  code=0
  if [[ $1 == native ]]; then wait "$world" || code=$?; else code=$(docker wait "$world"); fi
  if [[ $code == 0 ]]; then # empty where it did not start
    echo "ok      $2: $1 world, $3 vehicles of ${OURS#*, }, $4 of ${THEIRS#*, }"
  else
    echo "FAILED  $2: $1 world, $3 vehicles of ${OURS#*, }, $4 of ${THEIRS#*, }: exit code $code"
    tail -n 5 "$SCRATCH"/*.log >&2
    failures=$((failures + 1))
  fi
}

crossing native four_way 2 2
crossing contained four_way 2 2
[[ $failures -eq 0 ]]
