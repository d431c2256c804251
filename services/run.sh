#!/usr/bin/env bash
# From a fresh checkout to a judged crossing: installs what is missing, builds, runs.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

usage() {
  cat <<'TEXT'
Usage: bash services/run.sh [--setup-only] [--observer] [-- FLEETCTL_ARGUMENTS]

Installs missing Debian packages (root or sudo), builds into build/release, and runs
the crossing of two vehicles.

  --setup-only  stop after the build
  --observer    build giveway-observer too, the live map of a fleet
  -- ARGUMENTS  hand these to fleetctl instead of running the crossing
  --help        this text

Examples
  bash services/run.sh
  bash services/run.sh -- run intersection_equal --seed 3 --json

Exit code: 0 passed, 1 failed or interrupted, 2 could not run.
TEXT
}

setup_only=false
programs=(giveway-vehicle giveway-world fleetctl)
fleetctl_arguments=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --setup-only) setup_only=true ;;
    --observer) programs+=(giveway-observer) ;;
    --help | -h)
      usage
      exit 0
      ;;
    --)
      shift
      [[ $# -gt 0 ]] || die "nothing follows --; try: bash services/run.sh -- run --help"
      fleetctl_arguments=("$@")
      break
      ;;
    *) die "unknown argument '$1'; arguments of fleetctl go behind --; see --help" ;;
  esac
  shift
done

mapfile -t packages < <(build_packages && java_package)
install_packages "${packages[@]}"
check_java
# A cache that holds nothing yet is filled without a look at every preprocessed file: 3 % of a first start.
export CCACHE_DEPEND=1
configure release
build release "${programs[@]}"

fleetctl="$GIVEWAY_ROOT/build/release/bin/fleetctl"
if $setup_only; then
  say "ready: bash services/run.sh"
  exit 0
fi
if [[ ${#fleetctl_arguments[@]} -gt 0 ]]; then
  exec "$fleetctl" "${fleetctl_arguments[@]}"
fi

picture="$GIVEWAY_ROOT/build/release/intersection_yield.svg"
say "two vehicles meet at a crossing; the slower one should give way"
code=0
"$fleetctl" run intersection_yield --picture "$picture" || code=$?
[[ $code -eq 2 ]] && exit 2
cat <<TEXT

Picture of both paths: $picture

Try next
  bash services/run.sh -- run intersection_equal          # equal speeds: exactly one halts
  bash services/run.sh -- run peer_dies --picture died.svg  # one is killed before the crossing
  bash tests/run.sh unit                                  # the quick tests
TEXT
exit "$code"
