#!/usr/bin/env bash
# clang-tidy with the checks of .clang-tidy over every source of the services and the world, in the
# build folder of the preset tidy; what passed before is in ccache's cache and is not checked again.
# Usage: tidy.sh [PATTERN]   only the units whose object matches; exit code 1 if there is a finding.
source "$(dirname "${BASH_SOURCE[0]}")/../../services/setup.sh"
set -euo pipefail
cd "$GIVEWAY_ROOT"
export CCACHE_BASEDIR=$GIVEWAY_ROOT CCACHE_NOHASHDIR=1

configure tidy
mapfile -t objects < <(jq -r '.[].command' build/tidy/compile_commands.json |
  sed -nE 's, -c .*,,; s,.* -o ((services|sim_world)/.*),\1,p' | grep -vF .pb.cc | grep -E -- "${1:-.}" | sort)
[[ ${#objects[@]} -gt 0 ]] || die "no unit matches $1"
# Each finding of each unit: -k 0 continues after the first.
(build tidy "${objects[@]}" -- -k 0) || exit 1
echo "${#objects[@]} units without a finding"
