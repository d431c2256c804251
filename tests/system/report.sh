#!/usr/bin/env bash
# fleetctl report: shows a soak's report, redraws its page, flags a worse one and passes an equal one, and
# refuses what is no report or not comparable, with a reason and exit code 2.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
cd "$SCRATCH"

# soak FOLDER BEACON_AGE_NS VERDICT SCENARIO: the report of a soak of 5 minutes.
soak() {
  mkdir -p "$1"
  jq -nc --argjson age "$2" --arg verdict "$3" --arg scenario "$4" '{
    format: 1, verdict: $verdict, scenario: $scenario, seed: 1, planned_s: 300, ran_s: 300,
    vehicles: 8, qos_set: "default", command: "fleetctl soak \($scenario) --seed 1",
    faults: [range(10) | {rule: "stop", nth: ., at_s: (20 * .), for_s: 2, kind: "pause",
      target: "vehicle 2", observed: true, observed_how: "<b>stopped</b>",
      noticed_after_s: (0.3 + . / 1000), promised_s: 0.5, recovered_after_s: 1}],
    histograms: [{name: "beacon_age", unit: "ns", min: $age, max: ($age + 19 * 1048576), clamped: 0,
      lowest: [range(20) | $age + . * 1048576], count: [range(20) | 100],
      budgets: [{quantile: 0.99, most: 500000000}], block_values: [range(20) | 100],
      block_mean: [range(20) | $age + (9 + . % 2) * 1048576],
      block_p50: [range(20) | $age + (9 + . % 2) * 1048576],
      block_p99: [range(20) | $age + 19 * 1048576]}],
    block_s: 15, near_misses_by_block: [5],
    near_misses: [range(5) | {time_s: ., vehicle: 1, other: 2, x_m: ., y_m: 1, distance_m: 0.1}],
    near_misses_counted: 5}' >"$1/report.json"
}

# report CODE NAME ARGUMENTS...: ends with CODE; output in ./out and ./err.
report() {
  local wanted=$1 name=$2 code=0
  shift 2
  timeout 60 "$FLEETCTL" report "$@" >out 2>err || code=$?
  [[ $code -eq $wanted ]] || fail "$name: exit code $code: $(head -c 900 out err)"
}

soak last-release 67108864 passed warehouse_loop
soak nightly 67108864 passed warehouse_loop
soak slower 83886080 passed warehouse_loop
soak broken 67108864 failed warehouse_loop
soak busy 67108864 not_run warehouse_loop
soak elsewhere 67108864 passed city_grid

report 0 "one" last-release
grep -q '^PASSED.*warehouse_loop' out || fail "one: $(cat out)"
[[ $(wc -L <out) -le 78 ]] || fail "one: a line of $(wc -L <out) columns"
report 0 "one as JSON" last-release/report.json --json
jq -e '.histograms[0].p99 > 67108864 and .seed == 1' out >/dev/null || fail "one as JSON: $(cat out)"
report 1 "one that failed" broken
report 2 "one that was not run" busy

report 0 "the page" last-release --page soak.html
grep -q '&lt;b&gt;stopped' soak.html || fail "the page lacks what was seen, or does not escape it"
if command -v gnuplot >/dev/null; then
  [[ $(grep -c '<svg' soak.html) -eq 4 ]] || fail "$(grep -c '<svg' soak.html) pictures, wanted 4"
fi
mkdir nothing
report 0 "the page without gnuplot" last-release --page plain.html
env PATH="$SCRATCH/nothing" "$FLEETCTL" report last-release --page plain.html >out 2>err ||
  fail "without gnuplot: exit code $?"
grep -q 'gnuplot-nox' err || fail "without gnuplot: stderr says $(cat err)"
grep -q 'Near misses' plain.html || fail "without gnuplot: no tables"
if grep -q '<svg' plain.html; then fail "without gnuplot: pictures"; fi
[[ $(find . -name '*.gnuplot' -o -name '*.svg' | wc -l) -eq 0 ]] || fail "left behind: $(ls)"

report 0 "equal" last-release nightly
report 1 "slower" last-release slower --json
jq -e '.worse and (.figures[0] | .what == "beacon_age, mean" and .change == "worse"
  and .p < 0.01)' out >/dev/null || fail "slower: $(cat out)"
report 0 "in reverse" slower last-release
jq -c 'del(.block_s)' slower/report.json >older.json
report 0 "without blocks" last-release older.json
grep -q 'untested: a report without blocks' out || fail "without blocks: $(cat out)"
report 1 "failed" last-release broken
grep -q '^worse    verdict' out || fail "failed: $(cat out)"

report 2 "another scenario" last-release elsewhere
grep -q 'city_grid' err || fail "another scenario: $(cat err)"
report 2 "one was not run" last-release busy
report 2 "absent" last-release absent
grep -q 'absent' err || fail "absent: $(cat err)"
echo '{"scenario": 3}' >other.json
report 2 "no report" other.json
grep -q 'other.json: is no report of fleetctl soak' err || fail "no report: $(cat err)"
head -c 300 last-release/report.json >cut.json
report 2 "cut" cut.json
report 2 "three" last-release nightly slower
report 2 "a page of two" last-release nightly --page x.html
report 2 "nowhere to write" last-release --page /nowhere/at/all/x.html

[[ $failures -eq 0 ]]
