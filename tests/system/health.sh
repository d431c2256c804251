#!/usr/bin/env bash
# /livez, /readyz and /metrics of real services, by --health and by arbitrary requests of strangers; a loop
# that hangs; and stops: within a second of SIGTERM, with exit code 0, distinguished from a loss.
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
take_domain
FIRST_PORT=$((21000 + DOMAIN * 10))
WORLD=$FIRST_PORT A=$((FIRST_PORT + 1)) B=$((FIRST_PORT + 2)) C=$((FIRST_PORT + 3))

ask() { "$BIN/giveway-vehicle" --health "$2" --health-port "$1" 2>&1; } # PORT live|ready|metrics

# await_health WHAT SECONDS PORT live|ready CODE PATTERN: asks until both come.
await_health() {
  local what=$1 seconds=$2 port=$3 which=$4 wanted=$5 pattern=$6 start_ns code answer
  start_ns=$(date +%s%N)
  while true; do
    code=0
    answer=$(ask "$port" "$which") || code=$?
    [[ $code -eq $wanted && $answer =~ $pattern ]] && break
    if (($(date +%s%N) - start_ns > seconds * 1000000000)); then
      fail "$what: no '$pattern' with exit code $wanted in $seconds s, but $code: $answer"
      return
    fi
    sleep 0.05
  done
  echo "$what: $((($(date +%s%N) - start_ns) / 1000000)) ms: $answer" >&2
}

# The value of a metric; empty if there is none.
metric() { ask "$1" metrics | sed -n "s/^$2 //p"; } # PORT NAME

# ended NAME CODE SINCE_NS LIMIT_MS: waits for the end of a member.
ended() {
  local name=$1 wanted=$2 since=$3 limit=$4 code=0
  local pid=${PID[$name]}
  while kill -0 "$pid" 2>/dev/null && (($(date +%s%N) - since < limit * 1000000)); do
    sleep 0.01
  done
  local took=$((($(date +%s%N) - since) / 1000000))
  if kill -9 "$pid" 2>/dev/null; then fail "$name: not gone after $took ms"; fi
  wait "$pid" 2>/dev/null || code=$?
  unset "PID[$name]"
  [[ $code -eq $wanted ]] || fail "$name: exit code $code: $(tail -n 3 "$SCRATCH/$name.log")"
  echo "$name: gone after $took ms" >&2
}

# stops NAME: SIGTERM ends it well within a second.
stops() {
  local since
  since=$(date +%s%N)
  kill -TERM "${PID[$1]}"
  ended "$1" 0 "$since" 1000
}

# --- No world: live, and not ready; and a vehicle stops without one.
start alone giveway-vehicle --health-port "$A"
await_health "no world" 5 "$A" ready 1 'not joined: no answer from a world'
await_health "no world, alive" 1 "$A" live 0 '^live$'
stops alone
# Nor with a discovery server that has no address: then it has no participant, either.
start alone giveway-vehicle --health-port "$A" --discovery-server no-such-server.invalid
await_health "no server" 5 "$A" ready 1 'starting: .*no-such-server.invalid'
await_health "no server, alive" 1 "$A" live 0 '^live$'
stops alone

start world giveway-world --health-port "$WORLD"
start a giveway-vehicle --health-port "$A" --record "$SCRATCH/a.tape" --record-split 64KiB
start b giveway-vehicle --health-port "$B" --hang-on-signal --record "$SCRATCH/b.tape"
prlimit --pid "${PID[b]}" --fsize=20000 # b's disk: SIGXFSZ, too
await_health "the world is ready" 10 "$WORLD" ready 0 '^ready$'
await_health "a drives" 15 "$A" ready 0 '^ready$'
await_health "b drives" 15 "$B" ready 0 '^ready$'
id_b=$(id_of b)

# --- Metrics are current, and equal the fleet's own counts.
await "a drives" 5 a 'cruise'
sleep 0.3 # a status
turns=$(metric "$A" giveway_vehicle_loop_turns_total)
(($(metric "$A" giveway_vehicle_beacons_accepted_total) > 0)) || fail "a accepted no beacon"
[[ $(metric "$A" giveway_vehicle_peers_matched) == 1 ]] || fail "a is not matched with b"
[[ $(metric "$A" 'giveway_vehicle_mode{mode="cooperative"}') == 1 ]] || fail "a: mode"
[[ $(metric "$WORLD" giveway_world_vehicles_joined) == 2 ]] || fail "the world: vehicles joined"
[[ $(metric "$WORLD" 'giveway_world_run_state{state="running"}') == 1 ]] || fail "the run"
# What a supervisor reads from outside is what the allocator says, a second old at most.
said=$(metric "$WORLD" process_heap_bytes)
seen=$(cat "$(find "/proc/${PID[world]}/fd" -lname '/memfd:giveway-heap*')")
((4 * seen > 3 * said && 4 * seen < 5 * said)) || fail "the world: $said bytes of heap, $seen from outside"
(($(metric "$A" giveway_vehicle_loop_turns_total) > turns)) || fail "the metrics of a do not change"

# --- A port that is taken: refused at once, with a remedy.
since=$(date +%s%N)
start second giveway-vehicle --health-port "$A"
ended second 2 "$since" 2000
grep -q 'already in use.*port of its own' "$SCRATCH/second.log" ||
  fail "a taken port: $(cat "$SCRATCH/second.log")"

# --- Whatever a stranger sends, the loop continues and the next probe is answered.
# said_to PORT: sends stdin, prints the answer.
said_to() {
  local socket
  exec {socket}<>"/dev/tcp/127.0.0.1/$1"
  cat 1>&"$socket" 2>/dev/null || true
  timeout 3 cat <&"$socket" 2>/dev/null || true
  exec {socket}>&-
}
first_line() { head -n 1 < <(said_to "$A") | tr -d '\r'; }

late=$(metric "$A" giveway_vehicle_late_scans_total)
missed=$(metric "$B" giveway_vehicle_deadline_missed_total)
get() { printf '%s %s HTTP/1.1\r\nHost: a\r\n%s\r\n' "$1" "$2" "${3:-}"; }
[[ $(get GET /livez | first_line) == 'HTTP/1.1 200 OK' ]] || fail "GET /livez"
[[ $(get HEAD /livez | first_line) == 'HTTP/1.1 200 OK' ]] || fail "HEAD /livez"
[[ $(get GET /secrets | first_line) == 'HTTP/1.1 404 '* ]] || fail "an unknown page"
[[ $(get GET /../../etc/passwd | first_line) == 'HTTP/1.1 404 '* ]] || fail "a path out of the root"
[[ $(get POST /livez $'Content-Length: 5\r\n' | first_line) == 'HTTP/1.1 405 '* ]] || fail "POST"
[[ $(get DELETE /livez | first_line) == 'HTTP/1.1 405 '* ]] || fail "DELETE"
get GET '/readyz?format=json' | said_to "$A" | grep -q '^{"ready":true,"reasons":\[\]}' || fail "JSON"
printf '\0\377\r\n\r\n' | first_line >/dev/null || true
{ printf 'GET /%07000d HTTP/1.1\r\n\r\n' 0; } | first_line >/dev/null || true
get GET /metrics "Range: bytes=$(printf '0-1,%.0s' $(seq 1500))0-1"$'\r\n' | first_line >/dev/null || true
peak_kb() { awk '/^VmHWM:/ {print $2}' "/proc/${PID[a]}/status"; }
peak=$(peak_kb)
{ printf 'GET /livez HTTP/1.1\r\nX: ' && head -c 50000000 /dev/zero | tr '\0' x; } | first_line \
  >/dev/null || true
(($(peak_kb) - peak < 8000)) || fail "a keeps a header of 50 MB: $peak, then $(peak_kb) kB"
sockets=()
for _ in $(seq 12); do # half open; more than there are threads and waiting places
  exec {socket}<>"/dev/tcp/127.0.0.1/$A"
  printf 'GET /li' 1>&"$socket" 2>/dev/null || true
  sockets+=("$socket")
done
await_health "behind half-open connections" 1 "$A" live 0 '^live$'
for socket in "${sockets[@]}"; do exec {socket}>&-; done
# trickles COUNT: clients that send a byte every 0.2 s of a request that never ends, and come again.
trickles() {
  local _
  for _ in $(seq "$1"); do
    while exec {socket}<>"/dev/tcp/127.0.0.1/$A"; do
      while printf x 1>&"$socket"; do sleep 0.2; done
      exec {socket}>&-
    done 2>/dev/null &
    TRICKLERS+=("$!")
  done
}
TRICKLERS=()
trickles 10
sleep 0.5
for _ in $(seq 5); do await_health "while clients trickle bytes" 1 "$A" live 0 '^live$'; done
start_ns=$(date +%s%N)
printf 'GET /li' | said_to "$A" >/dev/null # cut off for another, or after its second
(($(date +%s%N) - start_ns < 1500000000)) || fail "a request that never ends is waited for"
kill "${TRICKLERS[@]}" 2>/dev/null || true
wait "${TRICKLERS[@]}" 2>/dev/null || true
# A busy machine alone causes a few; a loop that waited for these clients would be late ten times for each
# half-open connection.
late=$(($(metric "$A" giveway_vehicle_late_scans_total) - late))
missed=$(($(metric "$B" giveway_vehicle_deadline_missed_total) - missed))
echo "under strangers' requests: $late scans late, $missed beacons missed" >&2
((late <= 5 && missed <= 2)) || fail "strangers disturb the loop: $late late, $missed missed"

# --- A loop that hangs is not live, and is again when it continues.
line=$(lines_of a)
kill -USR1 "${PID[b]}"
await_health "b hangs" 3 "$B" live 1 'not live: the control loop has been silent for [0-9.]+ s'
await_health "b hangs and is not ready" 1 "$B" ready 1 'silent for'
await_health "a does not hang" 1 "$A" live 0 '^live$'
kill -USR2 "${PID[b]}"
await_health "b continues" 2 "$B" live 0 '^live$'
await_health "b drives again" 5 "$B" ready 0 '^ready$'

# --- A leave is not a loss. Half a request does not keep the vehicle from leaving.
await "a hears b again" 5 a "beacon_heard: vehicle $id_b" "$line"
sleep 0.5
line=$(lines_of a)
lost=$(metric "$A" giveway_vehicle_liveliness_lost_total)
exec {socket}<>"/dev/tcp/127.0.0.1/$B"
printf 'GET /li' 1>&"$socket"
stops b
exec {socket}>&-
grep -q 'leaving (leaving)' "$SCRATCH/b.log" || fail "b did not halt: $(tail -n 3 "$SCRATCH/b.log")"
await "a gets the leave" 2 a "beacon_left: vehicle $id_b" "$line"
await "the world gets the leave" 2 world "vehicle $id_b left the run"
sleep 0.5
if tail -n "+$((line + 1))" "$SCRATCH/a.log" | grep -E "(stale|lost|missed).*vehicle $id_b"; then
  fail "a takes a leave for a loss"
fi
[[ $(metric "$A" giveway_vehicle_liveliness_lost_total) == "$lost" ]] || fail "a counted a loss"

# --- b's disk was full: it drove on, and both its log and its recording say so.
grep -q 'error .*the recording ends here: .*b.tape: File too large' "$SCRATCH/b.log" ||
  fail "b did not say that its disk is full"
"$FLEETCTL" replay "$SCRATCH/b.tape" | grep -q 'could not be written: File too large' ||
  fail "replay does not say that b's disk was full"

# --- kill -9 is a loss, and leaves neither id nor port taken.
line=$(lines_of a)
start c giveway-vehicle --health-port "$C" --id "$id_b" # which is free again
await_health "c drives" 10 "$C" ready 0 '^ready$'
[[ $(metric "$C" "giveway_vehicle_info{vehicle=\"$id_b\",version=\".*\"}") == 1 ]] ||
  fail "c is not vehicle $id_b"
await "a hears c" 5 a "beacon_heard: vehicle $id_b" "$line"
line=$(lines_of a)
kill_now c
await "a loses c" 3 a "(stale|lost).*vehicle $id_b" "$line"
start c2 giveway-vehicle --health-port "$C" --id "$id_b" --hang-on-signal
await_health "c is back" 5 "$C" ready 0 '^ready$'

# --- Two with one id: the later one waits, says why, and stops as always.
start twin giveway-vehicle --health-port "$B" --id "$id_b"
await_health "a taken id" 5 "$B" ready 1 "not joined: the world lets it wait: .*$id_b"
await_health "a taken id, alive" 1 "$B" live 0 '^live$'
stops twin

# --- At any moment of joining, once it handles the signal: before that it is still the shell.
handles_term() { # NAME
  local handled of="/proc/${PID[$1]}"
  for _ in $(seq 400); do
    sleep 0.005
    [[ $(readlink "$of/exe") == */giveway-* ]] || continue # before the signals: those of the shell
    handled=$(awk '/^SigCgt:/ {print $2}' "$of/status")
    (((0x$handled >> 14) & 1)) && return
  done
  fail "$1 never handled SIGTERM"
}
for moment in 0 0.05 0.1 0.15 0.2 0.3; do
  start "joins_$moment" giveway-vehicle --health-port "$B"
  handles_term "joins_$moment"
  sleep "$moment"
  stops "joins_$moment"
done

# --- As process 1 of a container: no signal has a default there, and strangers' children are left
# as they are.
if unshare --pid --fork --mount-proc true 2>/dev/null; then
  unshare --pid --fork --mount-proc bash -c '(sleep 0.8 &); exec "$@"' bash \
    "$BIN/giveway-vehicle" --scenario "$LANES" --domain "$DOMAIN" --health-port "$B" \
    2>>"$SCRATCH/first.log" &
  PID[first]=$!
  await_health "process 1 drives" 10 "$B" ready 0 '^ready$'
  inner=$(children_of "${PID[first]}")
  orphan=$(children_of "$inner")
  [[ -n $orphan ]] || fail "process 1 was given no orphan"
  for _ in $(seq 100); do
    state=$(awk '/^State:/ {print $2}' "/proc/$orphan/status" 2>/dev/null) || state=gone
    [[ $state == Z || $state == gone ]] && break
    sleep 0.02
  done
  [[ $state == Z ]] || fail "process 1 must leave a stranger's child as it is, which is $state"
  since=$(date +%s%N)
  kill -TERM "$inner"
  ended first 0 "$since" 1000
else
  echo "no right to make process namespaces: process 1 is not tried" >&2
fi

# watched_in_vain: an observer joins, and is killed: nothing may wait for it for long.
watched_in_vain() {
  : >"$SCRATCH/top.log" # that of the one before shows a fleet, too
  "$FLEETCTL" top --domain "$DOMAIN" >"$SCRATCH/top.log" 2>/dev/null &
  PID[top]=$!
  await "an observer sees" 5 top 'cruise|halt'
  kill_now top
}

# --- With its world dead a vehicle says so, and stops as always.
watched_in_vain
kill_now world
await_health "no world any more" 3 "$A" ready 1 'the ranges are [0-9.]+ s old'
await_health "and yet alive" 1 "$A" live 0 '^live$'
stops a
[[ -e $SCRATCH/a.2.tape ]] || fail "a's recording was not split"
"$FLEETCTL" replay "$SCRATCH"/a.*tape || fail "a's recording: exit code $?"

# --- A loop that hangs does not see SIGTERM: the process ends nevertheless, and its exit code says so.
kill -USR1 "${PID[c2]}"
await "c2 hangs" 2 c2 'the control loop hangs'
since=$(date +%s%N)
kill -TERM "${PID[c2]}"
ended c2 143 "$since" 1500

# start_unread NAME ARGUMENTS...: a vehicle whose stderr is a full pipe that is never read.
start_unread() {
  local name=$1 pipe
  shift
  mkfifo "$SCRATCH/$name.pipe"
  exec {pipe}<>"$SCRATCH/$name.pipe"
  timeout 0.2 cat /dev/zero >&"$pipe" || true
  LOG=$SCRATCH/$name.pipe start "$name" giveway-vehicle "$@"
}

# --- The world stops as its vehicles do, with one of them there and with none. That one's log is
# not read: this delays neither its loop nor its end.
start world2 giveway-world --health-port "$WORLD"
await_health "the port of a killed world" 5 "$WORLD" ready 0 '^ready$'
stops world2
start world3 giveway-world --health-port "$WORLD"
start_unread d --health-port "$A" --log-level debug
await_health "d drives" 10 "$A" ready 0 '^ready$'
await_health "d's log is not read" 1 "$A" live 0 '^live$'
[[ $(metric "$A" giveway_vehicle_log_lines_dropped_total) =~ ^[0-9]+$ ]] || fail "d: dropped lines"
# --- A loop that hangs for longer ends with its process, which logs where all of its threads are.
start c3 giveway-vehicle --health-port "$C" --hang-on-signal
await_health "c3 drives" 10 "$C" ready 0 '^ready$'
since=$(date +%s%N)
kill -USR1 "${PID[c3]}"
ended c3 70 "$since" 6000
grep -q 'watchdog: the control loop has made no progress' "$SCRATCH/c3.log" || fail "c3 does not say why"
(($(grep -c '^thread ' "$SCRATCH/c3.log") >= 5)) || fail "c3 does not say where its threads are"
grep -q 'the loop:$' "$SCRATCH/c3.log" || fail "c3 does not say which thread is the loop"

# --- So does that of an observer, of which a probe alone starts nothing again; a process that was stopped does
# not hang.
start seer giveway-observer --port "$B" --hang-on-signal
await_health "an observer sees" 10 "$B" live 0 '^live$'
kill -STOP "${PID[seer]}"
sleep 4
kill -CONT "${PID[seer]}"
await_health "an observer that was stopped" 2 "$B" live 0 '^live$'
since=$(date +%s%N)
kill -USR1 "${PID[seer]}"
ended seer 70 "$since" 8000 # many of its threads hold back signals, 0.1 s each
grep -q 'watchdog: the control loop has made no progress' "$SCRATCH/seer.log" || fail "the observer does not say why"

watched_in_vain
since=$(date +%s%N)
stops world3
ended d 0 "$since" 3000

# --- In lockstep a world waits a second for a command. One that is stopped together with its vehicle, which
# answers no more, stops in time nevertheless, and leaves no checkpoint. Regression: 143, and a checkpoint.
start world4 giveway-world --lockstep --health-port "$WORLD" --checkpoint "$SCRATCH/world4.checkpoint"
start e giveway-vehicle --lockstep --health-port "$A"
await_health "e drives in lockstep" 10 "$A" ready 0 '^ready$'
kill -STOP "${PID[e]}"
sleep 0.1
stops world4
[[ ! -e $SCRATCH/world4.checkpoint ]] || fail "world4 left a checkpoint, to be resumed from"
kill_now e
[[ $failures -eq 0 ]]
