#!/usr/bin/env bash
# A soak of real processes: everything that can go wrong here passes, and the report says so and is complete;
# wrong input is refused before anything starts; Ctrl-C ends it with a report; a supervisor that is killed
# leaves no process behind, and its soak resumes; a broken promise makes every vehicle keep its ring, which
# replays; every beacon of a lossy network is accounted for; and in virtual time the same list gives the same
# report twice. Each in a domain of its own, in parallel, in about two minutes.
# shellcheck disable=SC2317,SC2030,SC2031 # background functions are called by name
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"

# refused WORDS ARGUMENTS...: exit code 2, the words, and no report.
refused() {
  local words=$1 code=0
  shift
  "$FLEETCTL" soak "$@" --report "$SCRATCH/refused" >"$SCRATCH/out" 2>&1 || code=$?
  [[ $code -eq 2 ]] || fail "soak $*: exit code $code, expected 2"
  grep -q "$words" "$SCRATCH/out" || fail "soak $* does not say '$words': $(head -n 3 "$SCRATCH/out")"
  [[ ! -e $SCRATCH/refused/report.json ]] || fail "soak $*: there is a report"
}

refusals() {
  echo 'at { name: "a" time_s: 20 kind: "paus" vehicle: 1 for_s: 1 }' >"$SCRATCH/kind.textproto"
  echo 'at { name: "a" time_s: 20 kind: "pause" vehicle: 77 for_s: 1 }' >"$SCRATCH/absent.textproto"
  echo 'at { name: "a" time_s: 20 kind: "spoofed" vehicle: 1 for_s: 1 }' >"$SCRATCH/spoofed.textproto"
  printf 'at { name: "%s" time_s: %s kind: "pause" vehicle: 1 for_s: 5 }\n' a 20 b 22 >"$SCRATCH/twice.textproto"
  refused 'pause' patrol --faults "$SCRATCH/kind.textproto" --duration 60
  refused '77' patrol --faults "$SCRATCH/absent.textproto" --duration 60
  refused 'skip-unsupported' patrol --faults "$SCRATCH/spoofed.textproto" --duration 60
  refused 'attacker PROGRAM' patrol --faults "$SCRATCH/spoofed.textproto" --duration 60
  refused 'No such file' patrol --faults "$SCRATCH/spoofed.textproto" --duration 60 --attacker "$SCRATCH/none"
  echo 'at { name: "a" time_s: 20 kind: "restart" target: "discovery_server" for_s: 1 }' >"$SCRATCH/server.textproto"
  refused 'takes --discovery-servers' patrol --faults "$SCRATCH/server.textproto" --duration 60
  refused "'lo' is none" patrol --faults calm --duration 60 --discovery-servers 1 --interface lo
  mkdir -p "$SCRATCH/config" && cp -r "$REPOSITORY"/config/{qos,scenarios,faults} "$SCRATCH/config"
  GIVEWAY_CONFIG_DIR=$SCRATCH/config refused 'discovery_server.xml, the profiles of a server' patrol --faults calm \
    --duration 60 --discovery-servers 1
  refused 'b' patrol --faults "$SCRATCH/twice.textproto" --duration 60
  refused 'no_such' patrol --faults no_such --duration 60
  refused '30 s' patrol --faults calm --duration 5
  refused 'vehicles' intersection_yield --faults calm --duration 60 --vehicles 3
  refused 'has places for 8' patrol --faults calm --duration 60 --vehicles 9
  sed 's/name: "o"/name: "a"/' "$SCRATCH/own.textproto" >"$SCRATCH/alike.textproto"
  refused 'alike.textproto too' "$SCRATCH/alike.textproto" --faults "$SCRATCH/server.textproto" --duration 60
  refused 'o stands in .*own.textproto' "$SCRATCH/own.textproto" --faults "$SCRATCH/twice.textproto" --duration 60
  refused 'SCENARIO' --faults calm --duration 60
  refused 'excludes' patrol --faults calm --virtual --record-ring 60
  refused 'not carried out in virtual time\|cannot be carried out' patrol --faults everything --virtual --duration 60
  echo 'at { name: "a" time_s: 20 kind: "loss" vehicle: 1 for_s: 5 }' >"$SCRATCH/heard.textproto"
  refused 'shared memory' patrol --faults "$SCRATCH/heard.textproto" --duration 60 --qos same_host
  echo 'at { name: "a" time_s: 20 kind: "qos_mismatch" vehicle: 1 for_s: 5 }' >"$SCRATCH/alike_set.textproto"
  refused "match those of the fleet's own" patrol --faults "$SCRATCH/alike_set.textproto" --duration 60 --qos lossy_radio
  local code=0
  "$FLEETCTL" soak --resume "$SCRATCH/nowhere" --faults calm >"$SCRATCH/out" 2>&1 || code=$?
  { [[ $code -eq 2 ]] && grep -q 'excludes' "$SCRATCH/out"; } || fail "resuming with another list ends with $code"
  code=0
  "$FLEETCTL" soak --resume "$SCRATCH/nowhere" >"$SCRATCH/out" 2>&1 || code=$?
  { [[ $code -eq 2 ]] && grep -q 'holds no soak' "$SCRATCH/out"; } || fail "resuming nothing ends with $code"
  code=0
  "$FLEETCTL" soak patrol --faults calm --duration 60 --report /proc/no >"$SCRATCH/out" 2>&1 || code=$?
  [[ $code -eq 2 ]] || fail "a folder that cannot be made: exit code $code"
}

# A scenario with faults of its own: soaked without --faults, by the line of the report, and with --faults.
own_faults() {
  local line
  "$FLEETCTL" soak "$SCRATCH/own.textproto" --vehicles 2 --virtual --duration 60 --report "$SCRATCH/own" --json \
    >"$SCRATCH/own.json" 2>/dev/null || fail "a soak of a scenario's own faults: exit code $?"
  [[ $(grep -o 'name: "[^"]*"' "$SCRATCH/own/faults.textproto") == 'name: "o"' ]] ||
    fail "the list is not the scenario's: $(<"$SCRATCH/own/faults.textproto")"
  ! grep -q faults "$SCRATCH/own/scenario.textproto" || fail "the list stands in the scenario of the report, too"
  line=$(jq -r .command "$SCRATCH/own.json")
  [[ $line != *--faults* ]] || fail "the line asks for a fault file: $line"
  mv "$SCRATCH/own" "$SCRATCH/own_first"
  # shellcheck disable=SC2086  # the words of a line
  "$FLEETCTL" ${line#fleetctl } >/dev/null 2>&1 || fail "the line of the report: exit code $?"
  cmp "$SCRATCH/own/report.json" "$SCRATCH/own_first/report.json" || fail "the line makes another report"
  "$FLEETCTL" soak "$SCRATCH/own.textproto" --faults "$SCRATCH/short.textproto" --vehicles 2 --virtual --duration 60 \
    --report "$SCRATCH/own" >/dev/null 2>&1 || fail "both lists: exit code $?"
  [[ $(grep -c '^at { name: "\(o\|stop\)"' "$SCRATCH/own/faults.textproto") -eq 2 ]] ||
    fail "the list is not that of both: $(<"$SCRATCH/own/faults.textproto")"
}

# judged_soak NAME ARGUMENTS...: fleetctl soak ARGUMENTS, its report in $SCRATCH/NAME, its JSON and its log next to
# it. Its exit code. One that judges nothing, since the machine paused for too large a part of the time, is made
# again, twice at most.
judged_soak() {
  local name=$1 code try
  shift
  for try in 1 2 3; do
    code=0
    rm -rf "${SCRATCH:?}/$name"
    "$FLEETCTL" soak "$@" --report "$SCRATCH/$name" --json >"$SCRATCH/$name.json" 2>"$SCRATCH/$name.log" || code=$?
    [[ $code -ne 0 && $try -lt 3 ]] || break
    too_busy "$SCRATCH/$name.json" || break
    echo "made again: $name: $(jq -c '[.reasons, [.violations[]? | .words]]' "$SCRATCH/$name.json")" >&2
  done
  return "$code"
}
# The verdict of a report and everything that speaks against it.
why() { jq -c '[.verdict, .reasons, [.violations[]? | .words]]' "$1"; }
too_busy() { jq -e '.reasons | index("machine_too_busy") != null' "$1" >/dev/null 2>&1; }

# unless_busy FUNCTION JSON: the same for a function with a soak that is interrupted: made again where that JSON says
# that the machine paused.
unless_busy() {
  local try before=$failures
  for try in 1 2 3; do
    failures=$before
    rm -f "$2"
    "$1"
    ((failures > before && try < 3)) && too_busy "$2" || return 0
    echo "made again: $1" >&2
  done
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
    grep -qs 'vehicles drive' "$1" && return
    sleep 0.1
  done
  return 1
}

interrupted() {
  local supervisor code=0
  rm -rf "$SCRATCH/early" "$SCRATCH/early.log"
  "$FLEETCTL" soak patrol --vehicles 2 --faults "$SCRATCH/long.textproto" --duration 90 --report "$SCRATCH/early" \
    --json >"$SCRATCH/early.json" 2>"$SCRATCH/early.log" &
  supervisor=$!
  started "$SCRATCH/early.log" || fail "the fleet to be interrupted never drove"
  "$FLEETCTL" soak patrol --vehicles 2 --faults "$SCRATCH/long.textproto" --duration 90 --report "$SCRATCH/early" \
    >"$SCRATCH/out" 2>&1 || code=$?
  { [[ $code -eq 2 ]] && grep -q 'another soak' "$SCRATCH/out"; } || fail "a second soak in one folder ends with $code"
  code=0
  kill -INT "$supervisor"
  wait "$supervisor" || code=$?
  [[ $code -eq 1 ]] || fail "an interrupted soak ends with $code"
  [[ $(jq -r .verdict "$SCRATCH/early.json") == interrupted ]] ||
    fail "the verdict of an interrupted soak is $(jq -r .verdict "$SCRATCH/early.json")"
  [[ -s $SCRATCH/early/report.html ]] || fail "an interrupted soak has no report"
  grep -q '>not started<' "$SCRATCH/early/report.html" || fail "its faults that did not come are not shown as such"
}

# A third of the packets lost, a third doubled, some corrupted, a set of other deadlines ordered: every
# beacon of every pair is accounted for, and the latency of samples is measured.
accounted() {
  local code=0 report=$SCRATCH/accounted
  judged_soak accounted patrol --vehicles 3 --faults "$SCRATCH/lossy.textproto" --duration 50 || code=$?
  [[ $code -eq 0 ]] ||
    fail "a lossy soak ended with $code: $(why "$SCRATCH/accounted.json")"
  jq -e '(.accounting | length) == 6 and ([.accounting[] | select(.difference != 0)] == []) and
    ([.accounting[] | select(.sent > 400 and .accepted > 50 and .lost > 20)] | length) == 6 and
    ([.accounting[] | .refused] | add) > 0' "$report/report.json" >/dev/null ||
    fail "beacons are not accounted for: $(jq -c .accounting "$report/report.json")"
  jq -e '.faults | map(select(.kind == "qos_apply").observed_how) == ["patient_readers.xml in effect on 1 vehicle, and its own again"]' \
    "$report/report.json" >/dev/null || fail "no other profile set was taken and taken back: $(jq -c '.faults' "$report/report.json")"
  jq -e '.supervisor_cpu_share > 0.005 and .supervisor_cpu_share < 2' "$report/report.json" >/dev/null ||
    fail "the supervisor's processor time is not measured: $(jq -c .supervisor_cpu_share "$report/report.json")"
  grep -q 'Accounting of samples' "$report/report.html" || fail "the page does not show the accounting"
  jq -e '[.histograms[] | select((.name == "beacon_latency" or .name == "scan_latency") and .values > 400)] | length == 2' \
    "$report/report.json" >/dev/null || fail "the latency of samples is not measured"
}

# The soak whose supervisor was killed, while one of its vehicles was stopped, leaves no process behind,
# resumes with the rest of its list, and says so.
killed() {
  local supervisor children pid first stopped="" code=0 report=$SCRATCH/killed
  rm -rf "$report" "$SCRATCH/killed.log"
  "$FLEETCTL" soak patrol --vehicles 2 --faults "$SCRATCH/rest.textproto" --duration 45 --report "$report" \
    >/dev/null 2>"$SCRATCH/killed.log" &
  supervisor=$!
  started "$SCRATCH/killed.log" || fail "the fleet to be orphaned never drove"
  mapfile -t children < <(children_of "$supervisor")
  [[ ${#children[@]} -ge 3 ]] || fail "a world and two vehicles are ${#children[@]} processes"
  for _ in $(seq 200); do
    [[ -s $report/so_far.json ]] && break
    sleep 0.1
  done
  first=$(stat -c %i "$report/so_far.json") || fail "what was seen so far is not saved"
  for _ in $(seq 300); do # until it is saved again, as another file
    [[ $(stat -c %i "$report/so_far.json" 2>/dev/null || echo "$first") != "$first" ]] && break
    sleep 0.1
  done
  for _ in $(seq 100); do
    for pid in "${children[@]}"; do grep -q '^State:.T' "/proc/$pid/status" && stopped=$pid; done
    [[ -z $stopped ]] || break
    sleep 0.1
  done
  [[ -n $stopped ]] || fail "no process of the soak to be killed is stopped"
  kill -9 "$supervisor"
  wait "$supervisor" 2>/dev/null || true
  all_gone "${children[@]}" || fail "processes of a killed soak still run"
  "$FLEETCTL" soak --resume "$report" --json >"$SCRATCH/resumed.json" 2>"$SCRATCH/resumed.log" || code=$?
  [[ $code -eq 0 ]] ||
    fail "a resumed soak ended with $code: $(why "$SCRATCH/resumed.json")"
  jq -e '(.resumed_at_s | length) == 1 and .resumed_at_s[0] > 8 and .ran_s > 40 and
    (.reasons | any(startswith("resumed at"))) and ([.faults[] | select(.observed and .rule == "rest")] | length) == 1' \
    "$SCRATCH/resumed.json" >/dev/null || fail "a resumed soak does not say so: $(jq -c '[.resumed_at_s, .ran_s,
      .reasons, .faults]' "$SCRATCH/resumed.json")"
  [[ ! -e $report/so_far.json ]] || fail "a soak with a verdict could be resumed"
}

# A vehicle dies unplanned: every vehicle keeps what its ring holds, bit for bit.
kept() {
  local supervisor target code=0 report=$SCRATCH/kept
  rm -rf "$report" "$SCRATCH/kept.log"
  "$FLEETCTL" soak patrol --vehicles 3 --faults "$SCRATCH/short.textproto" --duration 40 --record-ring 5 \
    --report "$report" --json >"$SCRATCH/kept.json" 2>"$SCRATCH/kept.log" &
  supervisor=$!
  started "$SCRATCH/kept.log" || fail "the fleet with rings never drove"
  sleep 13
  target=$(find_child "$supervisor" 3)
  kill -9 "$target"
  wait "$supervisor" || code=$?
  [[ $code -eq 1 ]] || fail "a soak of which a process died ends with $code: $(jq -c '[.verdict, .reasons]' "$SCRATCH/kept.json")"
  jq -e '[.violations[] | select(.invariant == "process_ended")] | length == 1' "$SCRATCH/kept.json" >/dev/null ||
    fail "the process that died is not reported"
  jq -e '.kept_rings | length == 1 and .[0].kept >= 2' "$SCRATCH/kept.json" >/dev/null ||
    fail "not every vehicle kept its ring: $(jq -c .kept_rings "$SCRATCH/kept.json")"
  [[ $(find "$report/recordings" -name 'vehicle-2*' | wc -l) -ge 4 ]] ||
    fail "vehicle 2 kept only its newest ring: $(ls "$report/recordings")"
  # And the page of the fleet's last seconds: vehicles and their ranges, before the break and at it.
  local page
  page=$(jq -r '.kept_rings[0].page' "$SCRATCH/kept.json")
  [[ $page == recordings/black-box-*.html && -s $report/$page ]] || fail "no page of the last seconds: $page"
  grep -q "<a href=\"$page\">" "$report/report.html" || fail "the report does not lead to $page"
  [[ $(grep -c '"ranges":{"1":' "$report/$page") -ge 20 ]] ||
    fail "fewer than 20 frames with ranges in $page: $(grep -c '"ranges":' "$report/$page")"
  [[ $(grep -c '"ranges":' "$report/$page") -le 60 ]] || fail "more than the last 5 s in $page"
  "$FLEETCTL" replay "$report"/recordings/*.recording >"$SCRATCH/replayed" ||
    fail "the rings do not replay: $(tail -n 3 "$SCRATCH/replayed")"
  "$FLEETCTL" soak --around "$report" >"$SCRATCH/around" || fail "there is nothing around a broken promise"
  grep -q 'fleetctl shrink .*around.textproto' "$SCRATCH/around" || fail "--around does not say how to shrink it"
  grep -q 'stop' "$report/around.textproto" || fail "the fault around it is not in around.textproto"
}

virtually() {
  local run
  for run in a b; do
    "$FLEETCTL" soak patrol --vehicles 8 --faults radio_storm --skip-unsupported --virtual --duration 10m --seed 3 \
      --report "$SCRATCH/virtual" --json >"$SCRATCH/virtual-$run.json" 2>/dev/null ||
      fail "a soak in virtual time does not pass: $(jq -c '[.verdict, .reasons]' "$SCRATCH/virtual-$run.json")"
  done
  cmp -s "$SCRATCH/virtual-a.json" "$SCRATCH/virtual-b.json" || fail "two soaks in virtual time differ"
  jq -e '.virtual_time and (.faults | length) > 20 and ([.histograms[].name] | index("reaction_way"))' \
    "$SCRATCH/virtual-a.json" >/dev/null || fail "a soak in virtual time has no faults or no reactions"
  grep -q '</html>' "$SCRATCH/virtual/report.html" || fail "the page of a soak in virtual time is incomplete"
}

whole() {
  local code=0 report=$SCRATCH/whole
  judged_soak whole patrol --vehicles 8 --faults everything --skip-unsupported --duration "${GIVEWAY_SOAK:-90s}" \
    --seed 7 --record || code=$?
  if [[ $code -ne 0 ]]; then
    fail "the soak ended with $code: $(why "$SCRATCH/whole.json")"
    tail -n 20 "$SCRATCH/whole.log"
    return
  fi
  jq -e '(.faults | length) > 5 and ([.faults[] | select(.observed or .observed_how != "" | not)] | length) == 0' \
    "$report/report.json" >/dev/null || fail "a fault of the whole soak was not observed, and nothing says why"
  jq -e '(.accounting | length) > 40 and ([.accounting[] | .lost] | add) > 0' "$report/report.json" >/dev/null ||
    fail "the whole soak has not accounted for its beacons: $(jq -c '[.accounting[:3]]' "$report/report.json")"
  jq -e '[.histograms[].name] as $all | ["beacon_age", "tick_jitter", "turn"] - $all == []' \
    "$report/report.json" >/dev/null || fail "the whole soak has not measured its vehicles"
  grep -q '</html>' "$report/report.html" || fail "the page is incomplete"
  "$FLEETCTL" report "$report" >"$SCRATCH/summary" || fail "fleetctl report does not read it"
  grep -q PASSED "$SCRATCH/summary" || fail "fleetctl report does not say that it passed"
  "$FLEETCTL" replay "$report"/recordings/vehicle-1.recording >/dev/null ||
    fail "a recording of the soak does not replay"
}

# Littered and full shared memory, a system clock that jumps, and discovery servers that are killed and
# return: each shows in the report, and the machine's own /dev/shm and clock are left alone.
host() {
  local code=0 shm before
  [[ $(id -u) -eq 0 ]] || return 0 # a /dev/shm apart needs root
  shm=/dev/shm/giveway-soak-test-$$
  echo kept >"$shm"
  before=$SECONDS
  judged_soak host patrol --vehicles 4 --qos same_host --discovery-servers 2 --duration 45 \
    --faults "$SCRATCH/host.textproto" || code=$?
  [[ $code -eq 0 ]] || {
    fail "a soak of the host's faults ended with $code: $(why "$SCRATCH/host.json")"
    tail -n 20 "$SCRATCH/host.log"
  }
  jq -e '[.faults[] | select(.observed)] | length == 5' "$SCRATCH/host.json" >/dev/null ||
    fail "not every fault of the host was seen: $(jq -c '[.faults[] | {name, effect}]' "$SCRATCH/host.json")"
  [[ $(cat "$shm") == kept ]] || fail "the machine's own /dev/shm was touched"
  rm -f "$shm"
  ((SECONDS - before < 300)) || fail "the clock of this script jumped"
}

# An intruder on loopback: each of its faults shows in the counters of its target or the peers, no process
# ends, and all drive on.
intruded() {
  local code=0 attacker=${FLEETCTL%/*}/attacker
  [[ $(id -u) -eq 0 && -x $attacker ]] || return 0 # its packet socket needs root
  judged_soak intruded patrol --vehicles 4 --faults "$SCRATCH/intruder.textproto" --duration 42 \
    --attacker "$attacker" || code=$?
  [[ $code -eq 0 ]] || {
    fail "a soak with an intruder ended with $code: $(why "$SCRATCH/intruded.json")"
    tail -n 20 "$SCRATCH/intruded.log"
  }
  jq -e '[.faults[] | select(.observed) | .kind] | sort ==
    ["flooded", "malformed", "qos_mismatch", "replayed", "spoofed"]' \
    "$SCRATCH/intruded.json" >/dev/null ||
    fail "not every fault of an intruder was seen: $(jq -c '[.faults[] | {kind, observed_how}]' "$SCRATCH/intruded.json")"
  jq -e '.faults[] | select(.kind == "qos_mismatch").observed_how | test("endpoints of incompatible QoS")' \
    "$SCRATCH/intruded.json" >/dev/null ||
    fail "a mismatch was not seen by its own effect: $(jq -c '.faults' "$SCRATCH/intruded.json")"
}

# One after the other: more fleets at once would make a small machine too busy for all of them.
kept_and_host() {
  unless_busy kept "$SCRATCH/kept.json"
  host
}
killed_and_intruded() {
  unless_busy killed "$SCRATCH/resumed.json"
  intruded
}

# in_background FUNCTION: runs it in parallel; its failures count.
runs=()
in_background() {
  (
    failures=0
    "$1"
    exit $((failures > 0))
  ) &
  runs+=($!)
}

echo 'at { name: "stop" time_s: 50 kind: "pause" vehicle: 1 for_s: 10 }' >"$SCRATCH/long.textproto"
# The pause is over when the vehicles are ordered to keep their rings.
echo 'at { name: "stop" time_s: 11 kind: "pause" vehicle: 1 for_s: 1 }' >"$SCRATCH/short.textproto"
{
  cat "$REPOSITORY/config/scenarios/patrol.textproto"
  echo 'faults { at { name: "o" time_s: 21 kind: "hang" vehicle: 1 for_s: 1 } }'
} >"$SCRATCH/own.textproto"
cat >"$SCRATCH/rest.textproto" <<'FAULTS'
at { name: "held" time_s: 13 kind: "pause" vehicle: 2 for_s: 14 }
at { name: "rest" time_s: 30 kind: "pause" vehicle: 1 for_s: 2 }
FAULTS
cat >"$SCRATCH/lossy.textproto" <<'FAULTS'
at { name: "lost" time_s: 12 kind: "loss" target: "all" for_s: 12 probability: 0.3 }
at { name: "doubled" time_s: 13 kind: "duplicate" target: "all" for_s: 12 probability: 0.3 }
at { name: "overtaken" time_s: 14 kind: "reorder" target: "all" for_s: 8 probability: 0.2 }
at { name: "broken" time_s: 15 kind: "corrupt" target: "all" for_s: 8 probability: 0.1 }
at { name: "stop" time_s: 18 kind: "pause" vehicle: 1 for_s: 1 }
at { name: "again" time_s: 25 kind: "restart" vehicle: 2 for_s: 1 }
at { name: "patient" time_s: 28 kind: "qos_apply" vehicle: 3 for_s: 4 }
FAULTS
cat >"$SCRATCH/host.textproto" <<'FAULTS'
at { name: "forth" time_s: 16 kind: "clock_step" vehicle: 1 for_s: 4 offset_s: 3600 }
at { name: "back" time_s: 17 kind: "clock_step" target: "world" for_s: 4 offset_s: -3600 }
at { name: "littered" time_s: 18 kind: "shared_memory_left_over" target: "all" for_s: 3 count: 50 }
at { name: "served" time_s: 19 kind: "restart" target: "discovery_server" for_s: 2 }
at { name: "full" time_s: 23 kind: "shared_memory_small" target: "all" for_s: 3 }
FAULTS
cat >"$SCRATCH/intruder.textproto" <<'FAULTS'
at { name: "posing" time_s: 13 kind: "spoofed" vehicle: 1 for_s: 4 rate_hz: 40 }
at { name: "again" time_s: 14 kind: "replayed" vehicle: 2 for_s: 4 }
at { name: "noise" time_s: 16 kind: "flooded" target: "all" for_s: 5 }
at { name: "broken" time_s: 17 kind: "malformed" vehicle: 3 for_s: 4 }
at { name: "unlike" time_s: 23 kind: "qos_mismatch" vehicle: 4 for_s: 7 }
FAULTS
in_background whole
in_background killed_and_intruded
in_background kept_and_host
refusals
own_faults
unless_busy interrupted "$SCRATCH/early.json"
virtually
accounted
for run in "${runs[@]}"; do wait "$run" || failures=$((failures + 1)); done
exit $((failures > 0))
