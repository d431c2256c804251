#!/usr/bin/env bash
# A soak of real processes: three minutes of everything that can go wrong here pass, the report says
# so and is whole; wrong input is refused before anything starts; Ctrl-C ends it with a report; and a
# supervisor that is killed leaves nobody behind.
source "$(dirname "${BASH_SOURCE[0]}")/fleet.sh"

soak() { "$FLEETCTL" soak "$@"; }

# refused WORDS ARGUMENTS...: exit code 2, the words, and no report.
refused() {
  local words=$1 code=0
  shift
  soak "$@" --report "$SCRATCH/refused" >"$SCRATCH/out" 2>&1 || code=$?
  [[ $code -eq 2 ]] || fail "soak $*: exit code $code, expected 2"
  grep -q "$words" "$SCRATCH/out" || fail "soak $* does not say '$words': $(head -n 3 "$SCRATCH/out")"
  [[ ! -e $SCRATCH/refused/report.json ]] || fail "soak $*: there is a report"
}

refusals() {
  echo 'at { name: "a" time_s: 20 kind: "paus" vehicle: 1 for_s: 1 }' >"$SCRATCH/kind.textproto"
  echo 'at { name: "a" time_s: 20 kind: "pause" vehicle: 77 for_s: 1 }' >"$SCRATCH/absent.textproto"
  echo 'at { name: "a" time_s: 20 kind: "shared_memory_small" target: "all" for_s: 1 }' >"$SCRATCH/shm.textproto"
  printf 'at { name: "%s" time_s: %s kind: "pause" vehicle: 1 for_s: 5 }\n' a 20 b 22 >"$SCRATCH/twice.textproto"
  refused 'pause' patrol --faults "$SCRATCH/kind.textproto" --duration 60
  refused '77' patrol --faults "$SCRATCH/absent.textproto" --duration 60
  refused 'skip-unsupported' patrol --faults "$SCRATCH/shm.textproto" --duration 60
  refused 'b' patrol --faults "$SCRATCH/twice.textproto" --duration 60
  refused 'no_such' patrol --faults no_such --duration 60
  refused '30 s' patrol --faults calm --duration 5
  refused 'vehicles' intersection_yield --faults calm --duration 60 --vehicles 3
  local code=0
  soak patrol --faults calm --duration 60 --report /proc/no >"$SCRATCH/out" 2>&1 || code=$?
  [[ $code -eq 2 ]] || fail "a folder that cannot be made: exit code $code"
}

# Every child of process $1 is gone, five seconds at most after it.
all_gone() {
  local pid _
  for _ in $(seq 50); do
    local left=0
    for pid in "$@"; do [[ ! -d /proc/$pid ]] || left=1; done
    [[ $left -eq 0 ]] && return
    sleep 0.1
  done
  return 1
}

# started LOG: waits until the fleet drives.
started() {
  local _
  for _ in $(seq 400); do
    grep -q 'vehicles drive' "$1" && return
    sleep 0.1
  done
  return 1
}

interrupted() {
  local supervisor code=0
  echo 'at { name: "stop" time_s: 14 kind: "pause" vehicle: 1 for_s: 30 }' >"$SCRATCH/long.textproto"
  soak patrol --vehicles 2 --faults "$SCRATCH/long.textproto" --duration 90 --report "$SCRATCH/early" \
    --json >"$SCRATCH/early.json" 2>"$SCRATCH/early.log" &
  supervisor=$!
  started "$SCRATCH/early.log" || fail "the fleet to be interrupted never drove"
  sleep 1
  kill -INT "$supervisor"
  wait "$supervisor" || code=$?
  [[ $code -eq 1 ]] || fail "an interrupted soak ends with $code"
  [[ $(jq -r .verdict "$SCRATCH/early.json") == interrupted ]] ||
    fail "the verdict of an interrupted soak is $(jq -r .verdict "$SCRATCH/early.json")"
  [[ -s $SCRATCH/early/report.html ]] || fail "an interrupted soak has no report"
}

killed() {
  local supervisor children
  soak patrol --vehicles 2 --faults "$SCRATCH/long.textproto" --duration 90 --report "$SCRATCH/killed" \
    >/dev/null 2>"$SCRATCH/killed.log" &
  supervisor=$!
  started "$SCRATCH/killed.log" || fail "the fleet to be orphaned never drove"
  mapfile -t children < <(children_of "$supervisor")
  [[ ${#children[@]} -ge 3 ]] || fail "a world and two vehicles are ${#children[@]} processes"
  kill -9 "$supervisor"
  wait "$supervisor" 2>/dev/null || true
  all_gone "${children[@]}" || fail "processes of a killed soak live on"
}

whole() {
  local code=0 report=$SCRATCH/whole
  soak patrol --vehicles 8 --faults everything --skip-unsupported --duration "${GIVEWAY_SOAK:-3m}" \
    --seed 1 --record --report "$report" --json >"$SCRATCH/whole.json" 2>"$SCRATCH/whole.log" || code=$?
  if [[ $code -ne 0 ]]; then
    fail "the soak ended with $code: $(jq -c '[.verdict, .reasons, [.violations[]? | .words]]' "$SCRATCH/whole.json")"
    tail -n 20 "$SCRATCH/whole.log"
    return
  fi
  jq -e '(.faults | length) > 5 and ([.faults[] | select(.observed | not)] | length) == 0' \
    "$report/report.json" >/dev/null || fail "a fault of the whole soak was not observed"
  grep -q '</html>' "$report/report.html" || fail "the page is not whole"
  "$FLEETCTL" report "$report" | grep -q passed || fail "fleetctl report does not read it"
  "$FLEETCTL" replay "$report"/recordings/vehicle-1.recording >/dev/null ||
    fail "a recording of the soak does not replay"
}

refusals
interrupted
killed
whole
exit $((failures > 0))
