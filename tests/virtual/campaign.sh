#!/usr/bin/env bash
# Runs generators of the virtual fleet over many seeds and reports what broke: a `fleetctl campaign` on this
# machine alone. A finished shard is a file in the folder of results, so that an interrupted campaign is
# resumed by the same command. Exit code 0: every invariant held in every run; 1: one did not; 2: bad usage,
# or a shard could not be run; others are those of a shard that was interrupted or lacked something.
# Usage: campaign.sh [--seeds N] [--results DIR] [--generators "NAME ..."] [--jobs J]
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
fleetctl=${GIVEWAY_BIN:-$root/build/release/bin}/fleetctl
seeds=200 results="" jobs=$(nproc)
generators="crossing roundabout corridor swarm merge convoy warehouse"
readonly kSeedsAShard=50

usage() {
  sed -n '6s/^# //p' "${BASH_SOURCE[0]}" >&2
  exit 2
}

while [[ $# -gt 0 ]]; do
  [[ $# -ge 2 ]] || usage
  case $1 in
    --seeds) seeds=$2 ;;
    --results) results=$2 ;;
    --generators) generators=$2 ;;
    --jobs) jobs=$2 ;;
    *) usage ;;
  esac
  shift 2
done
[[ $seeds =~ ^[1-9][0-9]{0,6}$ && $jobs =~ ^[1-9][0-9]{0,3}$ ]] || usage
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
results=${results:-$work/results}

{
  echo 'name: "campaign"'
  # shellcheck disable=SC2086  # a word each
  printf 'generator: "%s"\n' $generators
  echo "seeds: [1, $seeds] vehicles: [2, 50] loss_percent: [0, 20]"
} >"$work/campaign.textproto"

shards=$(((seeds + kSeedsAShard - 1) / kSeedsAShard))
for ((index = 0; index < shards; ++index)); do
  code=0
  "$fleetctl" campaign shard "$work/campaign.textproto" --of "$shards" --index "$index" --jobs "$jobs" \
    --out "$results" >/dev/null 2>"$work/said" || code=$?
  # 1 has a result: something broke, which the sum will report. Without the file there is nothing to add up.
  [[ $code -le 1 && -s $results/campaign.$index-of-$shards.json ]] && continue
  echo "shard $index of $shards ended with exit code $code and is no file in $results:" >&2
  ((code > 1)) || code=2
  cat "$work/said" >&2
  exit "$code"
done
"$fleetctl" campaign merge "$results"/campaign.*-of-"$shards".json
