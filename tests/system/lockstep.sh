#!/usr/bin/env bash
# A real run in lockstep ends in the same state, to the bit, as the same scenario in virtual time,
# also while every core is kept busy by something else, and under faults of the world: then the
# world's log names each as it starts and ends.
# Usage: lockstep.sh SCENARIO SEED [FAULTS.textproto]
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
scenario=${1:?name a scenario} seed=${2:?give a seed} faults=${3:-}

load=()
for ((core = 0; core < 2 * $(nproc); core++)); do
  timeout 120 nice -n 10 sh -c 'while :; do :; done' & # other tests run at the same time
  load+=($!)
done
trap 'kill "${load[@]}" 2>/dev/null; rm -rf "$SCRATCH"' EXIT

# fleetctl run starts the giveway-world next to itself: here, one with the faults.
give_world_faults() {
  local bin="$SCRATCH/bin" real
  real=$(dirname "$FLEETCTL")
  mkdir "$bin"
  cp "$FLEETCTL" "$bin/fleetctl"
  ln -s "$real/giveway-vehicle" "$bin/giveway-vehicle"
  printf '#!/bin/sh\nexec "%s" "$@" --faults "%s"\n' "$real/giveway-world" "$faults" >"$bin/giveway-world"
  chmod +x "$bin/giveway-world"
  FLEETCTL="$bin/fleetctl"
  export GIVEWAY_CONFIG_DIR="$REPOSITORY/config"
}

code=0
[[ -z $faults ]] || give_world_faults
"$FLEETCTL" run "$scenario" --seed "$seed" --lockstep --json --logs "$SCRATCH/logs" \
  >"$SCRATCH/run.json" 2>"$SCRATCH/run.err" || code=$?
[[ $code -eq 0 ]] || fail "exit code $code: $(cat "$SCRATCH/run.json" "$SCRATCH/run.err")"
real=$(jq -r .state_hash "$SCRATCH/run.json")
virtual=$("$GIVEWAY_VIRTUAL_HASH" "$scenario" "$seed" ${faults:+"$faults"} 2>"$SCRATCH/virtual.err") ||
  fail "virtual_hash: $(cat "$SCRATCH/virtual.err")"
echo "$scenario seed $seed: real $real, virtual $virtual"
[[ -n $real && $real == "$virtual" ]] || fail "the real run and the virtual one differ"
if [[ -n $faults ]]; then
  log=$(cat "$SCRATCH"/logs/*world*)
  seen="$(grep -c 'fault starts' <<<"$log") started, $(grep -c 'fault is over' <<<"$log") over"
  echo "faults: $seen"
  [[ $seen == "$(cat "$SCRATCH/virtual.err")" && $seen != 0* ]] ||
    fail "the world saw $seen; the virtual one $(cat "$SCRATCH/virtual.err")"
fi
exit $((failures > 0))
