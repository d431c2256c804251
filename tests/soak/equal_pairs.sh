#!/usr/bin/env bash
# How often `fleetctl report` calls a soak worse than another of the same program: virtual soaks of seeds 1 to
# PAIRS + 1, each against the next. A line each for a pair called worse, and what in it; the last line counts.
# Exit code 1 if that were more than 1 of 50. With CHANGED, a configuration folder whose fault file differs, the
# second of each pair runs under that: how often a deterioration is found; exit code 0.
# Usage: equal_pairs.sh PAIRS SCENARIO FAULTS DURATION [CHANGED]
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
[[ $# -ge 4 && $# -le 5 ]] || { sed -n 's/^# Usage: //p' "${BASH_SOURCE[0]}" >&2 && exit 2; }
pairs=$1 scenario=$2 faults=$3 duration=$4 changed=${5:-}
export GIVEWAY_CONFIG_DIR=${GIVEWAY_CONFIG_DIR:-$REPOSITORY/config}

# soak FOLDER SEED
soak() {
  "$FLEETCTL" soak "$scenario" --faults "$faults" --skip-unsupported --virtual --duration "$duration" \
    --seed "$2" --report "$1/$2" >"$SCRATCH/log" 2>&1 || true # one that failed is a report, too
  [[ -s $1/$2/report.json ]] || { cat "$SCRATCH/log" >&2 && exit 2; }
}

for ((seed = 1; seed <= pairs + 1; ++seed)); do
  soak "$SCRATCH/first" "$seed"
  [[ -z $changed ]] || GIVEWAY_CONFIG_DIR=$changed soak "$SCRATCH/second" "$seed"
done
second=first
[[ -z $changed ]] || second=second
worse=0
for ((seed = 1; seed <= pairs; ++seed)); do
  code=0
  "$FLEETCTL" report "$SCRATCH/first/$seed" "$SCRATCH/$second/$((seed + 1))" --json >"$SCRATCH/out" || code=$?
  [[ $code -le 1 ]] || exit 2
  [[ $code -eq 1 ]] || continue
  worse=$((worse + 1))
  jq -r --arg seed "$seed" '"\($seed): " + ([.figures[] | select(.change == "worse").what] | join(", "))' "$SCRATCH/out"
done
echo "$worse of $pairs called worse"
[[ -n $changed || $((worse * 50)) -le $pairs ]]
