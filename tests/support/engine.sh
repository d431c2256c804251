# shellcheck shell=bash
# A container engine for tests: Debian's docker, started here if none runs, and stopped again by the script
# that started it. No registry is contacted. Sourced, never run.
source "$(dirname "${BASH_SOURCE[0]}")/../../config/deploy/engine.sh"
unset GIVEWAY_BASE # GIVEWAY_SUITE alone says what is tested

failures=0
fail() {
  printf 'FAILED: %s\n' "$*" >&2
  failures=$((failures + 1))
}

container_packages() {
  engine_packages
  printf '%s\n' debootstrap iptables nftables curl util-linux
}

# If it had to start one, leaves its process in ENGINE.
engine_up() { engine_is_up || start_engine; }

engine_down() {
  [[ -n ${ENGINE:-} ]] || return 0
  kill "$ENGINE"
  wait "$ENGINE" || true
}
