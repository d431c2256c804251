#!/usr/bin/env bash
# fleetctl stopwatch: the shipped profile keeps every promise; what is refused, including AUTOMATIC
# liveliness; and Ctrl-C.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
unset GIVEWAY_QOS GIVEWAY_INTERFACE
cd "$SCRATCH"

# stopwatch CODE SECONDS NAME ARGUMENTS...: ends with CODE, in time; output in ./out, ./err.
stopwatch() {
  local wanted=$1 seconds=$2 name=$3 code=0
  shift 3
  timeout "$seconds" "$FLEETCTL" stopwatch "$@" >out 2>err || code=$?
  [[ $code -eq $wanted ]] || fail "$name: exit code $code: $(head -c 1500 out) $(tail -n 5 err)"
}

# says NAME CONDITION: true of the JSON object of the last command.
says() { jq -e "$2" out >/dev/null || fail "$1: not true of $(head -c 2000 out): $2"; }

# refused PATTERN ARGUMENTS...
refused() {
  local pattern=$1
  shift
  stopwatch 2 10 "$*" "$@"
  grep -Eq -- "$pattern" err || fail "$*: the message has no '$pattern': $(cat err)"
  [[ ! -s out ]] || fail "$*: something on stdout"
}

refused 'must be kill, pause, exit, hung, cut or one_way' --faults flood
refused 'vehicles' --vehicles 1
refused 'trials' --quick --trials 7
refused 'no_such.xml' --qos no_such.xml

stopwatch 0 10 "the table" --table
grep -Eq '^ +hung +must see +must see +if manual +none +none *$' out || fail "the table: $(cat out)"
grep -Eq '^ +lease +10125 ms' out || fail "the table: $(cat out)"
refused 'table' --table --json

stopwatch 0 300 "the shipped profile" --quick --json
says "the shipped profile" '.verdict == "kept" and .findings == []
  and ([.cells[].fault] | unique == ["cut", "exit", "hung", "kill", "one_way", "pause"])
  and all(.cells[]; .kept and .trials == 10)
  and all(.cells[] | select(.duty == "must"); .seen == .asked
    and .max_ms <= .promised_ms + .longest_pause_ms
    and (.promise | map(.ms) | add) == .promised_ms)
  and all(.cells[] | select(.duty == "none"); .seen == 0)
  and all(.cells[] | select(.fault == "kill" and .mechanism == "lease"); .p50_ms > 9900)'
jq -r '.cells[] | select(.duty == "must") | "\(.fault) \(.mechanism): \(.seen)/\(.asked), p50 \(.p50_ms), max \(.max_ms) of \(.promised_ms) + \(.longest_pause_ms) ms"' out

# The bug of 2.9.1: any living participant refreshes a dead one, until its participant's lease ends.
# A set with it is refused before a vehicle starts.
announced='<announcement_period><sec>0</sec><nanosec>100000000</nanosec></announcement_period>'
sed "s|<kind>MANUAL_BY_TOPIC</kind>|<kind>AUTOMATIC</kind>$announced|" \
  "$REPOSITORY/config/qos/default.xml" >automatic.xml
grep -q 'AUTOMATIC</kind><ann' automatic.xml || fail "the profile is spelt otherwise now"
refused 'fleet_beacon_writer: liveliness AUTOMATIC.*; MANUAL_BY_TOPIC' --faults kill --trials 2 \
  --vehicles 4 --qos automatic.xml

# Ctrl-C: soon, with exit code 1 and no process left behind.
"$FLEETCTL" stopwatch --faults kill --trials 4 --vehicles 4 --fleets 1 >out 2>err &
watch=$!
first=$(wait_for_child $watch 1) || fail "interrupted: no vehicle was started"
domain=$(domain_of "${first:-0}")
kill -INT $watch
code=0
wait $watch || code=$?
[[ $code -eq 1 ]] || fail "interrupted: exit code $code: $(cat err)"
grep -q 'not tried: kill: interrupted' out || fail "interrupted: $(cat out)"
all_gone "${domain:-0}" 30 || fail "interrupted: left behind: $(processes_on "$domain")"

[[ $failures -eq 0 ]]
