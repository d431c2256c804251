#!/usr/bin/env bash
# The built images: size above their base, user, read-only root, no capabilities, labels, health check, stop
# signal; and their files are found where they are installed.
source "$(dirname "${BASH_SOURCE[0]}")/../support/engine.sh"
engine_up
trap engine_down EXIT
BASE=debian:$SUITE-slim
bytes() { docker image inspect -f '{{.Size}}' "$1"; }
config() { docker image inspect -f "{{$2}}" "giveway-$1"; }

# image TARGET MEGABYTES PROGRAM
image() {
  local target=$1 above
  above=$((($(bytes "giveway-$target") - $(bytes "$BASE")) / 1000000))
  echo "giveway-$target: $above MB above the base, $2 MB allowed"
  [[ $above -le $2 ]] || fail "giveway-$target is $above MB above its base"
  [[ $(config "$target" .Config.User) == 10001:10001 ]] || fail "giveway-$target runs as root"
  [[ $(config "$target" .Config.StopSignal) == SIGTERM ]] || fail "giveway-$target: stop signal"
  [[ $(config "$target" 'index .Config.Labels "org.opencontainers.image.revision"') != "" ]] ||
    fail "giveway-$target has no revision"
  docker run --rm --read-only --cap-drop ALL --network none --entrypoint "$3" "giveway-$target" \
    --version || fail "$3 does not start in giveway-$target"
}

image world 60 giveway-world
image vehicle 60 giveway-vehicle
image tools 150 fleetctl
for target in world vehicle; do
  [[ $(config "$target" .Config.Healthcheck) == *"--health live"* ]] || fail "$target: no health check"
  for program in g++ cmake java; do
    docker run --rm --network none --entrypoint sh "giveway-$target" -c "! command -v $program" ||
      fail "giveway-$target has $program, which only builds need"
  done
done
docker run --rm --read-only --network none --entrypoint fleetctl giveway-tools \
  virtual crossing --vehicles 2 --seeds 1..2 >/dev/null || fail "fleetctl virtual"
# The program it starts gets neither the image's health port nor an id.
docker run --rm --read-only --tmpfs /tmp --cap-drop ALL --network none -e GIVEWAY_ID=2 giveway-tools \
  run four_way --json >/dev/null || fail "fleetctl run in the image of fleetctl"
docker run --rm --read-only --network none --entrypoint fleetctl giveway-tools qos check default \
  >/dev/null || fail "fleetctl does not find its profile sets"
[[ $failures -eq 0 ]]
