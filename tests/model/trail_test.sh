#!/usr/bin/env bash
# A counter-example becomes a scenario and a command line that fleetctl takes.
# Usage: trail_test.sh FOLDER; GIVEWAY_BIN_DIR holds fleetctl.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=$1

# old_grant_kept needs a restart, grant_not_awaited a death and losses.
for run in old_grant_kept grant_not_awaited; do
  bash "$here/check.sh" "$run" "$folder/$run"
  printed=$(bash "$here/trail.sh" "$folder/$run")
  printf '%s\n' "$printed"
  read -ra command < <(grep 'fleetctl virtual' <<<"$printed")
  command[0]="$GIVEWAY_BIN_DIR/fleetctl"
  command[-1]=1..5 # seeds: only that it runs is of interest
  code=0
  "${command[@]}" --json >"$folder/$run/virtual.json" || code=$?
  # The brain has no such defect: nothing touches.
  if [[ $code -ne 0 || $(jq '[.runs, .contacts] == [5, 0]' "$folder/$run/virtual.json") != true ]]; then
    printf 'FAILED: %s: exit code %d\n' "${command[*]}" "$code"
    cat "$folder/$run/virtual.json"
    exit 1
  fi
done
