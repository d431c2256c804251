#!/usr/bin/env bash
# Runs a scenario many times, each with its own seed and domain. A line for each failure, then one
# that sums up. The exit code is the verdict: 0 if every run passed.
# Usage: repeat.sh SCENARIO [N] [--jobs J] [--seed-start K]   N is by default $GIVEWAY_REPEATS or 10
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"

usage() {
  echo "Usage: repeat.sh SCENARIO [N] [--jobs J] [--seed-start K]" >&2
  exit 2
}

# whole NUMBER: a number from 1 to a million.
whole() { [[ ${1:-} =~ ^[1-9][0-9]{0,5}$ ]] || usage; }

[[ $# -ge 1 ]] || usage
scenario=$1 count=${GIVEWAY_REPEATS:-10} jobs=1 seed_start=1
shift
if [[ $# -gt 0 && $1 != --* ]]; then
  count=$1
  shift
fi
whole "$count"
while [[ $# -gt 0 ]]; do
  whole "${2:-}"
  case $1 in
    --jobs) jobs=$2 ;;
    --seed-start) seed_start=$2 ;;
    *) usage ;;
  esac
  shift 2
done

one_run() {
  local seed=$1 code=0 reason
  judged_run "$SCRATCH/$seed.json" "$SCRATCH/logs-$seed" "$scenario" --seed "$seed" || code=$?
  if [[ $code -eq 0 ]] && jq -e '.verdict == "passed"' "$SCRATCH/$seed.json" >/dev/null; then
    echo "seed $seed passed" >&2
    return
  fi
  reason=$(jq -r '"\(.reason), halted \(.halted), contacts \(.contacts)"' "$SCRATCH/$seed.json" \
    2>/dev/null || echo "no report")
  echo "seed $seed FAILED: exit code $code, $reason; again: fleetctl run $scenario --seed $seed"
  tail -n 3 "$SCRATCH/$seed.json.err" | sed 's/^/  /'
}
export -f one_run judged_run excused only_late scans_missed
export FLEETCTL SCRATCH scenario

# shellcheck disable=SC2016  # the inner shell expands it
seq "$seed_start" $((seed_start + count - 1)) |
  xargs -P "$jobs" -I{} bash -c 'one_run "$1"' one_run {}

again=$(find "$SCRATCH" -name '*.again' -exec cat {} + | wc -l)
jq -s -r --arg scenario "$scenario" --argjson count "$count" --argjson again "$again" '
  def over(f): [.[] | f | numbers];
  def text: if . == null then "-" else (. * 1000 | round / 1000 | tostring) end;
  "\($scenario) \([.[] | select(.verdict == "passed")] | length) of \($count) passed, " +
  "contacts \(over(.contacts) | add // 0), " +
  "min separation \(over(.min_separation_m) | min | text) m, " +
  "longest time to clear \(over(.time_to_clear_s) | max | text) s, " +
  "worst reaction p99 \(over(.reaction_ms.p99) | max | text) ms, " +
  "tick overruns \(over(.tick_overruns) | add // 0)" +
  if $again > 0 then ", \($again) runs made again: the machine stood still" else "" end' "$SCRATCH"/*.json
all=$(jq -s '[.[] | select(.verdict == "passed")] | length' "$SCRATCH"/*.json)
[[ $all -eq $count ]]
