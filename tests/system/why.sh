#!/usr/bin/env bash
# fleetctl why on real processes: each reason why one vehicle cannot receive another is named, and the probe
# agrees; what is no reason is not named. Other namespaces need root, and are skipped without it.
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
source "$REPOSITORY/services/setup.sh"
unset GIVEWAY_QOS GIVEWAY_INTERFACE GIVEWAY_DOMAIN
cd "$SCRATCH"
take_domain

# why CODE NAME ARGUMENTS...: fleetctl why ARGUMENTS ends with CODE, in time; output in ./out, ./err.
why() {
  local wanted=$1 name=$2 code=0
  shift 2
  timeout 30 "$FLEETCTL" why "$@" >out 2>err || code=$?
  [[ $code -eq $wanted ]] || fail "$name: exit code $code: $(head -c 900 out err)"
}

# says NAME CONDITION: true of the JSON of the last command.
says() { jq -e "$2" out >/dev/null || fail "$1: not true of $(head -c 900 out): $2"; }

# deaf NAME RULE A B: A does not hear B, RULE alone is the reason, and the probe agrees.
deaf() {
  local name=$1 rule=$2
  shift 2
  why 1 "$name" "$@" --seconds 1.5 --json
  says "$name" ".hears == false and .probed and .disagree == false
    and .topics[0].reasons == [\"$rule\"] and .topics[0].verdict == \"does not hear\"
    and any(.findings[]; .rule == \"$rule\" and .values != \"\" and .remedy != \"\")"
}

hears() { # NAME A B: on every topic, predicted and probed, with no findings
  local name=$1
  shift
  why 0 "$name" "$@" --seconds 8 --json
  says "$name" '.hears and .probed and .disagree == false and .findings == [] and .not_known == []
    and all(.topics[]; .verdict == "hears" and .predicted == "hears" and .samples > 0 and .matched)'
}

# More places than lanes.textproto has, and the same in another area. The first starts the run: a world that
# waits for several waits until they receive each other.
{
  cat "$REPOSITORY/tests/system/lanes.textproto"
  echo 'start_with: 1'
  for y in 12 15 18 21 24 27; do
    echo "spawn { start { x_m: 0 y_m: $y heading_deg: 0 } cruise_m_s: 0.35 goal { x_m: 300 y_m: $y } }"
  done
} >many.textproto
sed 's/^name: .*/&\narea: "north"/' many.textproto >north.textproto
LANES=$SCRATCH/many.textproto
# A beacon offered less often than the others request it; its own reader would take it.
sed -e '/profile_name="fleet_beacon_writer"/,/data_writer>/s/100000000/400000000/' \
  -e '/profile_name="fleet_beacon_reader"/,/data_reader>/s/150000000/400000000/' \
  "$REPOSITORY/config/qos/default.xml" >slow.xml

start world giveway-world
start one giveway-vehicle --id 1
await "one drives" 20 one cruise
start two giveway-vehicle --id 2 --partition-free
start three giveway-vehicle --id 3 --qos slow.xml
LANES=$SCRATCH/north.textproto start four giveway-vehicle --id 4 --partition-free
start five giveway-vehicle --id 5 --impair 'from=1,loss=1'
for name in two three four five; do await "$name drives" 20 "$name" cruise; done
[[ $failures -eq 0 ]] || exit 1

hears "two vehicles" 1 2 --domain "$DOMAIN"
says "two vehicles" '(.topics | length == 1 and .[0].topic == "fleet/beacon")
  and .own_status.taken > 0'
hears "ranges" 1 world --domain "$DOMAIN"
says "ranges" '[.topics[].topic] == ["world/ranges", "world/roster"]'
hears "commands" world 2 --domain "$DOMAIN"
says "commands" '[.topics[].topic] == ["fleet/motor_command", "fleet/join"]'
hears "by process" "pid:${PID[one]}" "pid:${PID[two]}"
why 0 "for people" 1 2 --domain "$DOMAIN" --seconds 8
grep -Eq '^vehicle 1 \(pid [0-9]+\) hears vehicle 2 \(pid [0-9]+\) on fleet/beacon' out ||
  fail "for people: $(cat out)"
grep -q 'host id' out && fail "the host id is not that of the library: $(cat out)"
why 0 "prediction alone" 1 2 --domain "$DOMAIN" --no-probe --json
says "prediction alone" '.hears and .probed == false and (.topics[0] | has("samples") | not)'

deaf "incompatible QoS" deadline_mismatch 1 3 --domain "$DOMAIN"
says "incompatible QoS" '.findings[0].values
  | test("deadline 400 ms \\(slow.xml:[0-9]+\\)") and test("deadline 150 ms \\(default.xml:")'
hears "compatible in the other direction" 3 1 --domain "$DOMAIN"
deaf "another area" partition_apart 1 4 --domain "$DOMAIN"
says "another area" '.findings[0].values | test("main/\\*") and test("north/v4 and without")'
deaf "a lossy channel" impaired_deaf 5 1 --domain "$DOMAIN"
hears "an impairment of another" 5 2 --domain "$DOMAIN"

kill -STOP "${PID[two]}"
deaf "a stopped speaker" process_stopped 1 2 --domain "$DOMAIN"
why 1 "a stopped hearer" 2 1 --domain "$DOMAIN" --seconds 8 --json
says "a stopped hearer" '.disagree == false and .topics[0].samples > 0
  and .topics[0].verdict == "does not hear" and .topics[0].reasons == ["process_stopped"]'
kill -CONT "${PID[two]}"

# Each of the others has a world of its own, and sends.
first=$DOMAIN
one=pid:${PID[one]}
take_domain
start six giveway-vehicle --id 6
start eleven giveway-vehicle --id 11
for name in six eleven; do await "$name waits" 10 "$name" 'no answer'; done
why 1 "no place" "pid:${PID[six]}" "pid:${PID[eleven]}" --seconds 4 --json
says "no place" '.disagree == false and .topics[0].reasons == ["not_joined", "not_joined"]
  and .topics[0].predicted == "hears" and .topics[0].verdict == "does not hear"'
start world2 giveway-world
await "six drives" 10 six cruise
deaf "another domain" domain_apart "$one" "pid:${PID[six]}"
says "another domain" ".findings[0].values | test(\"domain $first,\") and test(\"domain $DOMAIN\")"
deaf "and back" domain_apart "pid:${PID[six]}" "$one"
DOMAIN=$first

if [[ $(id -u) -eq 0 ]] && unshare -nm true 2>/dev/null; then
  unshare -n bash -c 'ip link set lo up && exec "$@"' apart \
    "$BIN/giveway-world" --scenario "$LANES" --domain "$DOMAIN" 2>world3.log &
  PID[world3]=$!
  until_apart=$((SECONDS + 10))
  until [[ $(readlink "/proc/${PID[world3]}/exe") == */giveway-world ]]; do
    ((SECONDS < until_apart)) || { fail "no world apart: $(cat world3.log)" && break; }
    sleep 0.05
  done
  nsenter -t "${PID[world3]}" -n \
    "$BIN/giveway-vehicle" --scenario "$LANES" --domain "$DOMAIN" --id 7 2>seven.log &
  PID[seven]=$!
  await "seven drives" 10 seven cruise
  deaf "another network namespace" network_apart 1 7 --domain "$DOMAIN"
  deaf "and from there" network_apart 7 1 --domain "$DOMAIN"
  hears "inside of it" "pid:${PID[seven]}" "pid:${PID[world3]}"

  same=$REPOSITORY/config/qos/same_host.xml
  start eight giveway-vehicle --id 8 --qos "$same"
  start nine giveway-vehicle --id 9 --qos "$same"
  unshare -m bash -c 'mount -t tmpfs none /dev/shm && exec "$@"' apart \
    "$BIN/giveway-vehicle" --scenario "$LANES" --domain "$DOMAIN" --id 10 --qos "$same" 2>ten.log &
  PID[ten]=$!
  for name in eight nine ten; do await "$name drives" 20 "$name" cruise; done
  hears "shared memory" 8 9 --domain "$DOMAIN"
  deaf "another shared memory" shared_memory_apart 8 10 --domain "$DOMAIN"
else
  echo "not root: other namespaces are left out" >&2
fi

# A fleet that is found through a server alone, which the processes themselves name; and one of its domain
# that does not ask there.
take_domain
server=(fast-discovery-server -l 127.0.0.1 -p $((7000 + DOMAIN)))
[[ $(debian_version) -ge 13 ]] || server+=(-i 0) # without a number 2.9.1 starts none
"${server[@]}" >server.log 2>&1 &
PID[server]=$!
by_server=(--discovery-server "127.0.0.1:$((7000 + DOMAIN))")
start world4 giveway-world "${by_server[@]}"
start thirteen giveway-vehicle --id 13 "${by_server[@]}"
GIVEWAY_DISCOVERY_SERVER=${by_server[1]} start fourteen giveway-vehicle --id 14
start fifteen giveway-vehicle --id 15
for name in thirteen fourteen; do await "$name drives" 20 "$name" cruise; done
for pair in 'thirteen fourteen' 'fourteen world4'; do
  read -r a b <<<"$pair"
  why 0 "by a server: $pair" "pid:${PID[$a]}" "pid:${PID[$b]}" --seconds 8 --json
  says "by a server: $pair" '.hears and .probed and .disagree == false
    and [.findings[].rule] == ["discovery_by_server"] and all(.topics[]; .verdict == "hears" and .samples > 0)'
done
why 1 "not by the server" "pid:${PID[fifteen]}" "pid:${PID[thirteen]}" --seconds 1.5 --json
says "not by the server" '.disagree == false and .topics[0].reasons[0] == "discovery_apart"
  and any(.findings[]; .rule == "discovery_apart" and (.values | test("SIMPLE.*CLIENT")))'
DOMAIN=$first

# Its id is known only from discovery.
start twelve giveway-vehicle
await "twelve drives" 20 twelve cruise
hears "a vehicle without a given id" "$(id_of twelve)" 1 --domain "$DOMAIN"

# An absent process is judged by what can be received, and invalid arguments are reported.
why 1 "no vehicle of that id" 1 77 --domain "$DOMAIN" --seconds 1 --json
says "no vehicle of that id" '.topics[0].samples == 0 and (.not_known[0] | test("vehicle 77"))'
why 2 "no such hearer" 77 1 --domain "$DOMAIN" --seconds 8 --json
says "no such hearer" '.topics[0].samples > 0 and .topics[0].verdict == "may hear"'
why 2 "neither" 77 78
grep -q "pid:${PID[one]} *vehicle 1 in domain $DOMAIN" err || fail "neither: $(cat err)"
why 2 "itself" 1 1
why 2 "itself, by another name" 1 "$one" --domain "$DOMAIN"
why 2 "no vehicle" one 2
grep -q "not 'one'" err || fail "no vehicle: $(cat err)"
why 2 "no such process" pid:1 2
grep -q 'no process of a fleet' err || fail "no such process: $(cat err)"
why 2 "id 0" 0 2
why 2 "one name only" 1
for name in "${!PID[@]}"; do alive "$name" || fail "$name did not outlive the questions"; done

[[ $failures -eq 0 ]]
