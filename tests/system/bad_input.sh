#!/usr/bin/env bash
# Any mistake in what the operator gives: exit code 2, a message that names the file, the line and the remedy,
# nothing started, and no waiting.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"

# A small valid scenario; each case corrupts one thing.
good="$SCRATCH/good.textproto"
cat >"$good" <<'TEXT'
name: "good"
duration_s: 1
vehicle {
  id: 1
  start { x_m: -3 y_m: 0 heading_deg: 0 }
  cruise_m_s: 0.3
}
vehicle {
  id: 2
  start { x_m: 0 y_m: -3 heading_deg: 90 }
  cruise_m_s: 0.4
}
expect { contacts: 0 }
TEXT

# refused NAME PATTERN ARGUMENTS...: fleetctl run ARGUMENTS is refused with a message like PATTERN.
refused() {
  local name=$1 pattern=$2 code=0 logs="$SCRATCH/logs"
  shift 2
  rm -rf "$logs"
  timeout 15 "$FLEETCTL" run --logs "$logs" "$@" >"$SCRATCH/out" 2>"$SCRATCH/err" || code=$?
  [[ $code -eq 2 ]] || fail "$name: exit code $code"
  grep -Eq -- "$pattern" "$SCRATCH/err" ||
    fail "$name: the message has no '$pattern': $(head -c 600 "$SCRATCH/err")"
  [[ ! -s $SCRATCH/out ]] || fail "$name: something on stdout"
  [[ -z $(find "$logs" -type f 2>/dev/null) ]] || fail "$name: something was started"
  echo "$name: $(head -n 1 "$SCRATCH/err" | head -c 200)" >&2
}

# malformed NAME PATTERN SED: the same for the good scenario changed by a sed script.
malformed() {
  local file="$SCRATCH/malformed.textproto"
  sed -E "$3" "$good" >"$file"
  cmp -s "$good" "$file" && fail "$1: the sed script changes nothing"
  refused "$1" "$2" "$file"
}

# The control: unchanged, it runs. Otherwise the cases below would prove nothing.
code=0
"$FLEETCTL" run "$good" >/dev/null 2>"$SCRATCH/err" || code=$?
[[ $code -eq 0 ]] || fail "the good scenario: exit code $code: $(tail -n 5 "$SCRATCH/err")"

refused "absent file" 'no_such' no_such.textproto
refused "folder" 'folder|directory' "$SCRATCH"
: >"$SCRATCH/empty.textproto"
refused "empty file" 'empty\.textproto' "$SCRATCH/empty.textproto"
head -c 4096 /dev/urandom >"$SCRATCH/binary.textproto"
refused "binary file" 'binary\.textproto' "$SCRATCH/binary.textproto"
truncate -s 100M "$SCRATCH/sparse.textproto"
refused "100 MB of nothing" '8388608|8 MiB' "$SCRATCH/sparse.textproto"
yes "$(cat "$good")" 2>/dev/null | head -c 100000000 >"$SCRATCH/huge.textproto" || true
refused "100 MB of text" '8388608|8 MiB' "$SCRATCH/huge.textproto"
mkfifo "$SCRATCH/pipe.textproto"
# A million walls: too large a file, and, in the shortest notation, too many.
wall='wall{from{x_m:0 y_m:9}to{x_m:1 y_m:9}}'
{
  cat "$good"
  yes "$wall" 2>/dev/null | head -n 1000000 || true
} >"$SCRATCH/walls.textproto"
refused "a million walls" '8388608|8 MiB' "$SCRATCH/walls.textproto"
{
  cat "$good"
  yes 'wall{}' 2>/dev/null | head -n 1000000 || true
} >"$SCRATCH/bare_walls.textproto"
refused "a million bare walls" 'bare_walls\.textproto:[0-9]+: wall\[65536\] = .*at most 65536' \
  "$SCRATCH/bare_walls.textproto"
refused "named pipe" 'pipe\.textproto' "$SCRATCH/pipe.textproto"
{
  printf 'expect '
  printf '{ x %.0s' $(seq 20000)
} >"$SCRATCH/deep.textproto"
refused "deep nesting" 'deep\.textproto' "$SCRATCH/deep.textproto"

malformed "unknown field" 'malformed\.textproto:6: .*cruise_mps' '6s/cruise_m_s/cruise_mps/'
malformed "missing id" 'malformed\.textproto:[0-9]+: .*id' '4d'
malformed "id 0" 'malformed\.textproto:4: .*id' '4s/1/0/'
malformed "NaN" 'malformed\.textproto:6: .*nan' '6s/0.3/nan/'
malformed "infinite" 'malformed\.textproto:6: ' '6s/0.3/1e400/'
malformed "negative radius" 'malformed\.textproto:3: .*body_radius_m' \
  '3s/\{/{ profile { body_radius_m: -0.2 }/'
malformed "overlapping start poses" 'malformed\.textproto:[0-9]+: .*' \
  '10s/x_m: 0 y_m: -3/x_m: -2.8 y_m: 0/'
malformed "duplicate ids" 'malformed\.textproto:9: .*id' '9s/2/1/'
malformed "field given twice" 'malformed\.textproto:2: |malformed\.textproto:3: ' '2s/$/\nduration_s: 2/'
malformed "text where a number belongs" 'malformed\.textproto:6' '6s/0.3/"fast"/'
malformed "unclosed brace" 'malformed\.textproto:' '13d;12d'
malformed "wall of zero length" 'malformed\.textproto:2: wall\[0\]\.to = .*no length' \
  '2s/$/ wall { from { x_m: 1 y_m: 1 } to { x_m: 1 y_m: 1 } }/'
malformed "door of zero length" 'malformed\.textproto:2: door\[0\]\.to = .*no length' \
  '2s/$/ door { from { x_m: 1 y_m: 1 } to { x_m: 1 y_m: 1 } }/'
malformed "boxes that overlap" 'malformed\.textproto:2: obstacle\[0\]\.start = .*overlaps vehicle 1' \
  '2s/$/ obstacle { box { half_length_m: 1 half_width_m: 0.1 } start { x_m: -4 y_m: 0 } }/'
malformed "NaN pose" 'malformed\.textproto:5: vehicle\[0\]\.start\.y_m = nan' '5s/y_m: 0/y_m: nan/'
malformed "infinite pose" 'malformed\.textproto:5: vehicle\[0\]\.start\.x_m = -inf' '5s/x_m: -3/x_m: -inf/'
malformed "cart faster than anything" 'malformed\.textproto:2: obstacle\[0\]\.speed_m_s = 11: .*10 m/s' \
  '2s/$/ obstacle { disc_radius_m: 1 start { x_m: 9 y_m: 9 } waypoint { x_m: 9 y_m: 5 } speed_m_s: 11 }/'
malformed "cart without a path" 'malformed\.textproto:2: obstacle\[0\]\.speed_m_s = 1: ' \
  '2s/$/ obstacle { disc_radius_m: 1 start { x_m: 9 y_m: 9 } speed_m_s: 1 }/'
malformed "slots shorter than an echo" 'malformed\.textproto:2: sonar\.slot_ms = 20: ' \
  '2s/$/ sonar { tier: p3dx slot_ms: 20 }/'
malformed "noise louder than the echo" 'malformed\.textproto:2: sonar\.noise = 0.6: ' \
  '2s/$/ sonar { tier: typical noise: 0.6 }/'
malformed "greens against each other" 'malformed\.textproto:3: signal\[1\]\.group = 1: .*at one time' \
  '2s/$/ signal { id: 1 group: 1 heading_deg: 0 line { from { x_m: 1 y_m: 1 } to { x_m: 1 y_m: 2 } } }\
signal { id: 2 group: 1 heading_deg: 0 line { from { x_m: 1 y_m: 1 } to { x_m: 1 y_m: 2 } } }/'
malformed "fault of a signal there is not" 'malformed\.textproto:2: fault\[0\]\.dark = 9: ' \
  '2s/$/ fault { dark: 9 at_s: 1 }/'
malformed "no expectation" 'malformed\.textproto:.*expect' '13d'

refused "no scenario" 'SCENARIO'
refused "unknown flag" 'Try: fleetctl run --help' intersection_yield --sped 3
refused "more vehicles than places" 'patrol: --vehicles = 9: it has places for 8' patrol --vehicles 9
refused "domain 0" 'domain' intersection_yield --domain 0
refused "domain 100" 'domain' intersection_yield --domain 100
refused "negative seed" 'seed' intersection_yield --seed -1
refused "seed of 33 bits" 'seed' intersection_yield --seed 4294967296
refused "duration nan" 'duration' intersection_yield --duration nan
refused "duration 0" 'duration' intersection_yield --duration 0
refused "unknown behaviour" 'behaviour' intersection_yield --behaviour reckless
refused "ring of no recording" 'record-ring requires --record' intersection_yield --record-ring 60
refused "recording that replay would not know" 'write run\.bag\.mcap' intersection_yield --record-topics run.bag
refused "absent QoS file" 'no_such\.xml' intersection_yield --qos no_such.xml
refused "QoS file that is no XML" 'good\.textproto' intersection_yield --qos "$good"
# On these the library would loop for ever, deaf to SIGTERM: no program may pass them on.
for nanosec in 1500000000 -1; do
  sed "/profile_name=\"fleet_beacon_reader\"/,/<\/data_reader/ s/150000000/$nanosec/" \
    "$REPOSITORY/config/qos/default.xml" >"$SCRATCH/hangs.xml"
  refused "QoS file that hangs the library" 'hangs\.xml:[0-9]+: <nanosec>: "'"$nanosec"'": .*; write' \
    intersection_yield --qos "$SCRATCH/hangs.xml"
  for program in "giveway-vehicle --domain 98 --scenario $good" "giveway-world --domain 98 --scenario $good" \
    "giveway-observer --domain 98 --port 18098" "fleetctl top --domain 98" \
    "fleetctl listen fleet/beacon --domain 98" "fleetctl record $SCRATCH/hangs.mcap --domain 98" \
    "fleetctl qos show --live 1 --domain 98" "fleetctl qos apply lossy_radio --to 1 --domain 98" \
    "fleetctl stopwatch --quick" "fleetctl soak patrol --duration 60 --report $SCRATCH/hangs"; do
    code=0
    # shellcheck disable=SC2086  # words of a command line
    timeout 5 "$(dirname "$FLEETCTL")"/$program --qos "$SCRATCH/hangs.xml" \
      >"$SCRATCH/out" 2>&1 || code=$?
    { [[ $code -eq 2 ]] && grep -Eq 'hangs\.xml:[0-9]+: <nanosec>' "$SCRATCH/out"; } ||
      fail "$program with a set that hangs the library: exit code $code: $(head -c 600 "$SCRATCH/out")"
  done
done
refused "unknown interface" 'nowhere0' intersection_yield --interface nowhere0
refused "page without a name" 'html' intersection_yield --html ""
refused "picture nowhere" 'no_such_folder' intersection_yield --picture no_such_folder/run.svg
refused "picture that is a folder" "$SCRATCH" intersection_yield --picture "$SCRATCH"

# A world with faults: a file that does not exist, random rules, and faults without a target are refused.
echo 'random { name: "a" kind: "sonar_off" mean_between_s: 5 for_s: 2 }' >"$SCRATCH/random.textproto"
echo 'at { name: "a" kind: "sonar_off" time_s: 5 for_s: 2 vehicle: 9 }' >"$SCRATCH/absent.textproto"
for case in "no_such no_such" "$SCRATCH/random.textproto fleetctl.faults.expand" \
  "$SCRATCH/absent.textproto vehicle.9|absent"; do
  read -r file pattern <<<"$case"
  code=0
  timeout 5 "$(dirname "$FLEETCTL")/giveway-world" --scenario "$good" --domain 98 --faults "$file" \
    >"$SCRATCH/out" 2>&1 || code=$?
  { [[ $code -eq 2 ]] && grep -Eq -- "$pattern" "$SCRATCH/out"; } ||
    fail "--faults $file: exit code $code: $(head -c 600 "$SCRATCH/out")"
done

# A virtual run of README, and one that asks for what is not virtual.
code=0
"$FLEETCTL" virtual crossing --seeds 1..20 --faults flaky_hardware >"$SCRATCH/out" 2>&1 || code=$?
{ [[ $code -eq 0 ]] && grep -q 'runs' "$SCRATCH/out"; } ||
  fail "virtual --faults flaky_hardware: exit code $code: $(head -c 600 "$SCRATCH/out")"
code=0
"$FLEETCTL" virtual crossing --seed 1 --faults everything >"$SCRATCH/out" 2>"$SCRATCH/err" || code=$?
{ [[ $code -eq 2 ]] && grep -q 'disk_full.*--skip-unsupported' "$SCRATCH/err"; } ||
  fail "virtual --faults everything: exit code $code: $(head -c 600 "$SCRATCH/err")"

code=0
"$FLEETCTL" virtual crossing --seed 1 --mcap "$SCRATCH/run.bin" >"$SCRATCH/out" 2>"$SCRATCH/err" || code=$?
{ [[ $code -eq 2 ]] && grep -q 'write .*run\.bin\.mcap' "$SCRATCH/err" && [[ ! -s $SCRATCH/out ]]; } ||
  fail "virtual --mcap run.bin: exit code $code: $(head -c 600 "$SCRATCH/err")"

# What is no number passes no range, and one that may be of two units is refused.
while IFS='|' read -r pattern words; do
  code=0
  # shellcheck disable=SC2086  # words of a command line
  "$FLEETCTL" $words >"$SCRATCH/out" 2>"$SCRATCH/err" || code=$?
  { [[ $code -eq 2 ]] && grep -q -- "$pattern" "$SCRATCH/err"; } ||
    fail "$words: exit code $code: $(head -c 600 "$SCRATCH/err")"
done <<CASES
--cores.*from 0.1 to 1024, not 'nan'|plan 5 --cores nan
--memory-gib.*not 'nan'|plan 5 --memory-gib nan
--link-mbit.*not 'nan'|plan 5 --link-mbit nan
--split.*has no unit.*MiB.*600s|record $SCRATCH/run.mcap --domain 98 --split 1000000
--ros2-rate.*not 'nan'|record $SCRATCH/run.mcap --domain 98 --ros2 --ros2-rate nan
--fault AT.*from 0 to 86400|virtual crossing --seed 1 --fault crash:1@$(printf '9%.0s' {1..400})
--fault AT.*from 0 to 86400|virtual crossing --seed 1 --fault pause:1@99999999999999999999
--fault FOR.*from 0 to 86400|virtual crossing --seed 1 --fault pause:1@5+99999999999999999999
CASES

code=0
"$FLEETCTL" rum 2>"$SCRATCH/err" || code=$?
[[ $code -eq 2 ]] || fail "unknown verb: exit code $code"
grep -q "no verb 'rum'" "$SCRATCH/err" || fail "unknown verb: $(cat "$SCRATCH/err")"

# Of its own faults a run takes what needs no supervisor of a soak.
{
  cat "$good"
  echo 'faults { at { name: "stands" time_s: 0.5 kind: "pause" vehicle: 1 for_s: 0.1 } }'
} >"$SCRATCH/pause.textproto"
refused "a fault of a soak" 'pause\.textproto:14: stands = pause: .*use fleetctl soak' "$SCRATCH/pause.textproto"
sed 's/"pause"/"paus"/' "$SCRATCH/pause.textproto" >"$SCRATCH/paus.textproto"
refused "no kind of fault" 'paus\.textproto:14: faults\.at\[0\]\.kind = "paus"' "$SCRATCH/paus.textproto"
{
  cat "$REPOSITORY/config/scenarios/patrol.textproto"
  echo 'faults { at { name: "lost" time_s: 5 kind: "loss" vehicle: 1 for_s: 2 } }'
} >"$SCRATCH/lost.textproto"
refused "faults of who restarts" '--restart: a restarted vehicle would count' "$SCRATCH/lost.textproto" --restart

# With --json the refusal is data, too.
"$FLEETCTL" run no_such.textproto --json 2>/dev/null >"$SCRATCH/out" || true
jq -e '.verdict == "not_run" and .reason == "bad_input"' "$SCRATCH/out" >/dev/null ||
  fail "JSON of a refusal: $(cat "$SCRATCH/out")"

[[ $failures -eq 0 ]]
