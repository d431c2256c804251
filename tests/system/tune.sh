#!/usr/bin/env bash
# fleetctl qos tune: refuses what it cannot search, measures with real vehicles, leaves every file it
# promises, and continues where it was cut off. Small searches: what comes out of them is not judged.
# With GIVEWAY_TUNE_QUICK=1 a whole --quick search, which must be verified within three minutes.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
unset GIVEWAY_QOS GIVEWAY_INTERFACE GIVEWAY_DOMAIN GIVEWAY_IMPAIR GIVEWAY_SEED
cd "$SCRATCH"

# tune CODES NAME ARGUMENTS...: ends with one of CODES, "0 1", in time; output in ./out and ./err.
tune() {
  local wanted=$1 name=$2 code=0
  shift 2
  timeout 120 "$FLEETCTL" qos tune "$@" >out 2>err || code=$?
  [[ " $wanted " == *" $code "* ]] || fail "$name: exit code $code: $(tail -n 5 out err)"
}

tune 2 "an impairment that is none" --impair loss=2
tune 2 "a seed for all" --impair loss=0.1,seed=3
grep -q -- '--seed' err || fail "a seed for all: no remedy in $(cat err)"
tune 2 "one vehicle" --vehicles 1
tune 2 "no time" --trial-seconds 0
tune 2 "no such base" --base no_such.xml
grep -q 'no_such.xml' err || fail "no such base: $(cat err)"
tune 2 "a base with an error" --base "$REPOSITORY/tests/unit/qos/bad_qos/deadline_offered_longer.xml"
grep -q 'qos check' err || fail "a base with an error: $(cat err)"
touch a_file
tune 2 "a folder that is none" --out a_file
[[ ! -e qos-tune ]] || fail "left a folder behind for wrong arguments"

small=(--quick --candidates 2 --trial-seconds 3 --verify-trials 1 --vehicles 3)
tune "0 1" "a small search" "${small[@]}" --out small --json
jq -e '.vehicles == 3 and (.candidates | length) == 2 and .candidates[0].name == "base"
  and all(.candidates[]; .measured.vehicle_hours > 0 and .measured.detections > 0
    and .measured.heard_bytes_s > 0 and .measured.cpu_share > 0
    and .predicted.alarms_per_vehicle_hour > 0) and (.front | length) > 0
  and (.recommended != null) and (.trials | length) >= 2' out >/dev/null ||
  fail "a small search: $(head -c 600 out)"
cmp -s out small/evidence.json || fail "evidence.json is not what was printed"
grep -q '<table>' small/report.html || fail "no table in report.html"
if command -v gnuplot >/dev/null; then
  grep -q '<svg' small/report.html || fail "no picture in report.html"
  grep -q '<svg' small/front.svg || fail "no picture front.svg"
fi
code=0
"$FLEETCTL" qos check small/recommended.xml --vehicles 3 >out 2>err || code=$?
[[ $code -le 1 ]] || fail "recommended.xml: $(cat out err)"
judged_run out logs intersection_yield --qos small/recommended.xml ||
  fail "recommended.xml does not run: $(cat out out.err)"

cp -r small before
tune "0 1" "the same again" "${small[@]}" --out small
grep -q 'nothing left to measure' err || fail "the same again: $(cat err)"
grep -Eq '^\* ' out || fail "the same again: no front in $(cat out)"
diff -r before small >/dev/null || fail "the same again: files changed"
code=0
env PATH="$SCRATCH/nothing" "$FLEETCTL" qos tune "${small[@]}" --out small >out 2>err || code=$?
[[ $code -le 1 ]] || fail "without gnuplot: exit code $code: $(cat err)"
grep -q 'gnuplot-nox' err || fail "without gnuplot: $(cat err)"
grep -q 'No pictures' small/report.html || fail "without gnuplot: report.html says nothing of it"
rm small/trials/base-0.json
# As a trial leaves it that was killed: such recordings were read in place of the repetition's own.
mkdir -p small/running/base-0
for id in 1 2 3; do touch "small/running/base-0/vehicle-$id.recording"; done
tune "0 1" "one is missing" "${small[@]}" --out small
[[ -s small/trials/base-0.json ]] || fail "one is missing: it was not measured again"
jq -e '(.detections | length) > 0 and .age_mean_ms > 0' small/trials/base-0.json >/dev/null ||
  fail "one is missing: a former recording was read: $(cat small/trials/base-0.json)"
cmp -s {before,small}/trials/d190_l250_be_h5-0.json || fail "one is missing: another changed"
tune 2 "another search there" "${small[@]}" --seed 9 --out small
grep -q 'another' err || fail "another search there: $(cat err)"

# Interrupted while it measures: says that it can be resumed, leaves no process behind, and resumes.
"$FLEETCTL" qos tune "${small[@]}" --fleets 1 --out cut >out 2>err &
tuning=$!
for _ in $(seq 400); do
  compgen -G 'cut/trials/*.json' >/dev/null && break
  sleep 0.1
done
domain=
for _ in $(seq 200); do
  for pid in $(children_of "$tuning"); do
    domain=$(domain_of "$pid")
    [[ -z $domain ]] || break 2
  done
  sleep 0.05
done
kill -INT "$tuning"
code=0
wait "$tuning" || code=$?
[[ $code -eq 1 ]] || fail "cut off: exit code $code: $(cat err)"
grep -q 'run the same command again' err || fail "cut off: $(cat err)"
if [[ -z $domain ]]; then
  fail "cut off: nothing was started"
elif ! all_gone "$domain" 50; then
  fail "cut off: vehicles are left on domain $domain"
fi
compgen -G 'cut/trials/*.json' >/dev/null || fail "cut off: no evidence was kept"
tune "0 1" "resumed" "${small[@]}" --out cut
grep -q 'resuming: [1-9]' err || fail "resumed: $(cat err)"

if [[ ${GIVEWAY_TUNE_QUICK:-0} -eq 1 ]]; then
  start_s=$SECONDS
  code=0
  "$FLEETCTL" qos tune --quick --out quick >out 2>err || code=$?
  [[ $code -eq 0 ]] || fail "quick: exit code $code: $(cat out)"
  ((SECONDS - start_s < 180)) || fail "quick: took $((SECONDS - start_s)) s"
fi

[[ $failures -eq 0 ]]
