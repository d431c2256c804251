#!/usr/bin/env bash
# One run of a shipped scenario, judged by its JSON and its picture.
# Usage: crossing.sh SCENARIO
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
scenario=${1:?name a scenario}

# What readers of the JSON rely on, in every run.
shape='type == "object"
  and (.verdict | IN("passed", "failed", "not_run")) and (.reason | length > 0)
  and ([.contacts, .beacons_sent, .beacons_received, .deadline_missed, .liveliness_lost,
        .tick_overruns, .seed, .domain] | all(type == "number"))
  and (.halted | type == "array") and (.domain >= 1 and .domain <= 99)'
passed='.verdict == "passed" and .contacts == 0 and .min_separation_m > 0
  and .beacons_sent > 0 and .beacons_received > 0'
# Judged at all, nearly everywhere, and without a violation.
held='.ticks_judged > 200 and .ticks_unseen < .ticks_judged
  and (.violations | length == 10 and all(. == 0)) and .first_violations == []'

case $scenario in
  intersection_yield)
    expected='.halted == [2] and .arrived == [1, 2] and .time_to_clear_s > 0
      and .reaction_ms.p50 > 0 and .reaction_ms.p99 >= .reaction_ms.p50
      and .reaction_ms.max >= .reaction_ms.p99'
    ;;
  intersection_equal) expected='.halted == [2] and .arrived == [1, 2]' ;;
  intersection_avoid) expected='.halted == []' ;;
  wall_only) expected='.halted == [] and .arrived == [1, 2]' ;;
  head_on) expected='.halted == [2] and .arrived == [1, 2]' ;;
  three_way) expected='.halted == [2, 3] and .arrived == [1, 2, 3]' ;;
  four_way) expected='(.halted | length > 0) and .arrived == [1, 2, 3, 4]' ;;
  narrow_door) expected='(.halted | length > 0) and .arrived == [1, 2, 3, 4]' ;;
  deaf) expected='(.halted | length > 0) and .arrived == [1, 2]' ;;
  parked_nose_to_nose) expected='.arrived == [1, 2]' ;;
  convoy) expected='.halted == [] and .arrived == [1, 2, 3, 4]' ;;
  flaky_crossing) expected='(.halted | length > 0) and .arrived == [1, 2] and .liveliness_lost > 0' ;;
  peer_dies) expected='.halted == [1] and .arrived == [1] and .liveliness_lost > 0' ;;
  *)
    echo "unknown scenario '$scenario'" >&2
    exit 2
    ;;
esac

code=0
judged_run "$SCRATCH/run.json" "$SCRATCH/logs" "$scenario" --picture "$SCRATCH/run.svg" || code=$?
cat "$SCRATCH/run.json"

[[ $code -eq 0 ]] || fail "exit code $code"
[[ $(jq -s length "$SCRATCH/run.json") == 1 ]] || fail "stdout is not exactly one JSON object"
for what in "$shape" "$passed" "$held" "$expected"; do
  jq -e "$what" "$SCRATCH/run.json" >/dev/null || fail "not true of the report: $what"
done
if command -v rsvg-convert >/dev/null; then
  rsvg-convert "$SCRATCH/run.svg" -o "$SCRATCH/run.png" || fail "the picture does not render"
fi
[[ -e $SCRATCH/logs/world.log ]] || fail "no log of the world"

if [[ $failures -gt 0 ]]; then
  tail -n 20 "$SCRATCH/run.json.err" "$SCRATCH"/logs/*
  exit 1
fi
