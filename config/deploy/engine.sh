# shellcheck shell=bash
# A container engine and the images, where they are missing: Debian's docker, a base image by
# debootstrap, and ours. For config/deploy/up.sh and the tests of tests/containers. Sourced, never run.
source "$(dirname "${BASH_SOURCE[0]}")/../../services/setup.sh"

# A client of another origin may stand first in PATH; Debian's fits Debian's engine.
export PATH=/usr/bin:$PATH DOCKER_BUILDKIT=1 COMPOSE_DOCKER_CLI_BUILD=1
# The Debian that the images stand on: trixie with Fast DDS 3.1, bookworm with 2.9.
SUITE=${GIVEWAY_SUITE:-trixie}
# The image that ours are made from.
base_name() { printf '%s' "${GIVEWAY_BASE:-debian:$SUITE-slim}"; }
ENGINE_LOG=${TMPDIR:-/tmp}/giveway-dockerd.log

# Debian 13 has the client and BuildKit in packages of their own.
engine_packages() {
  printf '%s\n' docker.io docker-compose
  if [[ $(debian_version) -ge 13 ]] 2>/dev/null; then printf '%s\n' docker-cli docker-buildx; fi
}

engine_is_up() { docker info >/dev/null 2>&1; }

# Starts an engine, whose process is ENGINE then, and waits until it answers. It continues when the
# shell that started it ends.
start_engine() {
  local deadline=$((SECONDS + 60))
  setsid dockerd >"$ENGINE_LOG" 2>&1 </dev/null &
  ENGINE=$!
  until engine_is_up; do
    kill -0 "$ENGINE" 2>/dev/null || die "dockerd ended: $(tail -n 3 "$ENGINE_LOG")"
    ((SECONDS < deadline)) || die "dockerd does not answer: $(tail -n 3 "$ENGINE_LOG")"
    sleep 0.2
  done
}

# The mirror this machine's own apt uses.
apt_mirror() {
  # shellcheck disable=SC2016 # apt's variable, not the shell's
  apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' | grep -v security | head -n 1
}

# What a stock slim image leaves out.
slim_down() { # ROOT
  cat >"$1/etc/dpkg/dpkg.cfg.d/docker" <<'TEXT'
path-exclude /usr/share/doc/*
path-exclude /usr/share/man/*
path-exclude /usr/share/info/*
path-exclude /usr/share/locale/*
path-include /usr/share/doc/*/copyright
TEXT
  rm -rf "$1"/var/lib/apt/lists/* "$1"/usr/share/{man,info,locale}/* "$1"/var/cache/apt/* \
    "$1"/var/log/*.log
  find "$1/usr/share/doc" -type f ! -name copyright -delete
}

has_image() { docker image inspect "$1" >/dev/null 2>&1; }

# base_image SUITE: debian:SUITE-slim, made here if the engine has none. No registry is asked.
base_image() {
  local suite=$1 root
  has_image "debian:$suite-slim" && return
  install_packages debootstrap
  say "making debian:$suite-slim"
  root=$(mktemp -d)
  debootstrap --variant=minbase "$suite" "$root" "$(apt_mirror)" >"$root.log" 2>&1 ||
    die "debootstrap failed: $(tail -n 3 "$root.log")"
  slim_down "$root"
  tar -C "$root" -c . | docker import - "debian:$suite-slim" >/dev/null
  rm -rf "$root" "$root.log"
}

# build_image TARGET: giveway-TARGET.
build_image() {
  local target=$1 log
  log=$(mktemp)
  docker build --network host --progress plain -f "$GIVEWAY_ROOT/config/deploy/Dockerfile" \
    --build-arg BASE="$(base_name)" \
    --build-arg REVISION="$(git -C "$GIVEWAY_ROOT" rev-parse --short HEAD 2>/dev/null || true)" \
    --target "$target" -t "giveway-$target" "$GIVEWAY_ROOT" >"$log" 2>&1 ||
    die "the image $target could not be built: $(tail -n 20 "$log")"
  rm -f "$log"
}
