#!/usr/bin/env bash
# clang-tidy with the checks of .clang-tidy over every source of the services and the world, in the
# build folder of the preset tidy; what passed before is in ccache's cache and is not checked again.
# Usage: tidy.sh [--sample 0..29] [PATTERN]   only the units whose object matches, and of these every thirtieth
# from that one on; exit code 1 if there is a finding.
source "$(dirname "${BASH_SOURCE[0]}")/../../services/setup.sh"
set -euo pipefail
cd "$GIVEWAY_ROOT"
export CCACHE_BASEDIR=$GIVEWAY_ROOT CCACHE_NOHASHDIR=1

sample=''
if [[ ${1:-} == --sample ]]; then
  [[ ${2:-} =~ ^[12]?[0-9]$ ]] || die "--sample must be 0 to 29, not '${2:-}'"
  sample=$2
  shift 2
fi

configure tidy
mapfile -t objects < <(jq -r '.[].command' build/tidy/compile_commands.json |
  sed -nE 's, -c .*,,; s,.* -o ((services|sim_world)/.*),\1,p' | grep -vF .pb.cc | grep -E -- "${1:-.}" | sort)
[[ ${#objects[@]} -gt 0 ]] || die "no unit matches $1"
all=${#objects[@]}
[[ -z $sample ]] || mapfile -t objects < <(printf '%s\n' "${objects[@]}" | awk -v sample="$sample" 'NR % 30 == sample')
# Each finding of each unit: -k 0 continues after the first.
(build tidy "${objects[@]}" -- -k 0) || exit 1
echo "${#objects[@]} units of $all without a finding"
