#!/usr/bin/env bash
# A soak that cannot fail proves nothing. One vehicle of the fleet has a defect (vehicle_with_defects.cc), or one
# fault silently has no effect, and the soak must name it. A line "ok" or "FAILED" each.
# Exit code 0: all were found; 1: one was not; 2: could not run.
# Usage: mutants.sh [MUTANT ...]
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
BIN=$(dirname "$FLEETCTL")
export GIVEWAY_CONFIG_DIR=${GIVEWAY_CONFIG_DIR:-$REPOSITORY/config}
[[ -x $BIN/vehicle_with_defects ]] || {
  echo "no $BIN/vehicle_with_defects; build the target vehicle_with_defects" >&2
  exit 2
}

# The invariant or promise that must be named for each; of several one is enough.
declare -A EXPECTED=(
  [none]=none
  [leak]=leak
  [descriptor]=leak
  [slow_loop]=slow_loop
  [stale_beacon_trusted]=stale_decision
  [priority_reversed]="order all_halted contact"
  [deadline_ignored]=detection
  [fault_without_effect]=effect
)
# And a word that must be among those about it.
declare -A WORD=([leak]=heap_bytes)
ORDER=(none leak descriptor slow_loop priority_reversed deadline_ignored fault_without_effect
  stale_beacon_trusted)

# programs MUTANT: a folder in which every vehicle has that defect.
programs() {
  local folder=$SCRATCH/$1 name
  mkdir -p "$folder"
  for name in giveway-world fleetctl; do cp "$BIN/$name" "$folder/"; done
  local deadline='' defect='' unimpaired=''
  if [[ $1 == deadline_ignored ]]; then
    # Its reader asks for a beacon an hour.
    deadline=$folder/no_deadline.xml
    sed '/profile_name="fleet_beacon_reader"/,/<\/data_reader>/ {
      /<deadline>/,/<\/deadline>/ s|<sec>0</sec>|<sec>3600</sec>|
    }' "$REPOSITORY/config/qos/default.xml" >"$deadline"
  elif [[ $1 == fault_without_effect ]]; then
    unimpaired=yes # the fault is carried out by the rules that its receiver is started with
  elif [[ $1 != none ]]; then
    defect=$1
  fi
  cat >"$folder/giveway-vehicle" <<END
#!/bin/bash
words=()
while [[ \$# -gt 0 ]]; do
  if [[ \$1 == --qos && -n "$deadline" ]]; then words+=(--qos "$deadline") && shift 2; continue; fi
  if [[ \$1 == --impair* && -n "$unimpaired" ]]; then shift 2; continue; fi
  words+=("\$1") && shift
done
GIVEWAY_DEFECT=$defect exec $BIN/vehicle_with_defects "\${words[@]}"
END
  chmod +x "$folder/giveway-vehicle"
  echo "$folder"
}

# schedule MUTANT: a fault file that makes the mutant's defect show.
schedule() {
  cat <<'END'

description: "One silence that peers must notice, and beacons that are lost."
at { name: "pause" time_s: 20 kind: "pause" vehicle: 2 for_s: 3 }
at { name: "loss" time_s: 30 kind: "loss" vehicle: 3 for_s: 20 probability: 0.6 }
END
}

for mutant in "${@:-${ORDER[@]}}"; do
  [[ -n ${EXPECTED[$mutant]:-} ]] || {
    echo "mutants.sh: no mutant is called '$mutant'; there are: ${ORDER[*]}" >&2
    exit 2
  }
  folder=$(programs "$mutant")
  schedule >"$folder/faults.textproto"
  code=0
  "$folder/fleetctl" soak patrol --vehicles 8 --faults "$folder/faults.textproto" --duration 150 \
    --seed 1 --report "$folder/report" --json >"$folder/report.json" 2>"$folder/log" || code=$?
  named=$(jq -r '[.violations[]?.invariant] | unique | join(" ")' "$folder/report.json")
  found=false
  if [[ $mutant == none ]]; then
    [[ $code -eq 0 && -z $named ]] && found=true
  else
    for wanted in ${EXPECTED[$mutant]}; do
      [[ $code -eq 1 && " $named " == *" $wanted "* ]] && found=true
    done
    [[ -z ${WORD[$mutant]:-} ]] ||
      jq -e --arg word "${WORD[$mutant]}" 'any(.violations[]?.words; contains($word))' "$folder/report.json" >/dev/null ||
      found=false
  fi
  if $found; then
    echo "ok      mutant $mutant: ${named:-nothing broken}"
  else
    tail -n 5 "$folder/log" >&2
    echo "FAILED  mutant $mutant: expected ${EXPECTED[$mutant]}, found ${named:-nothing}, exit code $code"
    failures=$((failures + 1))
  fi
done
[[ $failures -eq 0 ]]
