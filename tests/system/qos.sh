#!/usr/bin/env bash
# fleetctl qos as an operator meets it: exit codes, JSON, invalid files, and that the shipped sets which need
# no other service run a crossing.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"

sets=$REPOSITORY/config/qos
bad=$REPOSITORY/tests/unit/qos/bad_qos
# Variables of this shell would add findings.
unset GIVEWAY_QOS GIVEWAY_INTERFACE FASTRTPS_DEFAULT_PROFILES_FILE ROS_DISCOVERY_SERVER
cd "$SCRATCH"

# qos CODE NAME ARGUMENTS...: fleetctl qos ARGUMENTS ends with CODE, in time; output in $SCRATCH/out.
qos() {
  local wanted=$1 name=$2 code=0
  shift 2
  timeout 20 "$FLEETCTL" qos "$@" >"$SCRATCH/out" 2>"$SCRATCH/err" || code=$?
  [[ $code -eq $wanted ]] ||
    fail "$name: exit code $code: $(head -c 400 "$SCRATCH/out" "$SCRATCH/err")"
}

# says NAME CONDITION: true of the JSON of the last command.
says() {
  jq -e "$2" "$SCRATCH/out" >/dev/null || fail "$1: not true of $(head -c 600 "$SCRATCH/out"): $2"
}

qos 0 "the shipped default" check
for set in "$sets"/*.xml; do
  qos 0 "$(basename "$set")" check "$set" --vehicles 50 --json
  says "$(basename "$set")" '.errors == 0 and .warnings == 0 and .findings == []'
done
qos 0 "by name, of a scenario" check lossy_radio --scenario four_way
qos 0 "two sets at once" check default same_host

qos 1 "a warning" check --partial "$bad/lifespan.xml" --json
says "a warning" '.errors == 0 and .warnings == 1 and .findings[0].rule == "finite_lifespan"
  and .findings[0].line > 0 and (.findings[0].file | endswith("lifespan.xml"))'
qos 2 "an error" check --partial "$bad/deadline_offered_longer.xml" --json
says "an error" '.errors == 1 and (.findings[0] | .severity == "error"
  and (.values | contains("200 ms") and contains("150 ms")) and .consequence != "" and .remedy != "")'

# refused NAME RULE FILE: an error of that rule, and nothing else happens.
refused() {
  qos 2 "$1" check "$3" --json
  says "$1" "any(.findings[]; .rule == \"$2\")"
}
refused "absent" unreadable_file no_such.xml
refused "a folder" unreadable_file "$SCRATCH"
mkfifo pipe.xml
refused "a pipe" unreadable_file pipe.xml
: >empty.xml
refused "empty" empty_file empty.xml
head -c 4096 /dev/zero >zeros.xml
refused "binary" not_text zeros.xml
{
  cat "$sets/default.xml"
  yes '<!-- more -->' 2>/dev/null | head -c 10000000 || true
} >large.xml
refused "10 MB" file_too_large large.xml
head -c 3000 "$sets/default.xml" >cut.xml
refused "cut off" malformed_xml cut.xml
yes '<dds>' 2>/dev/null | head -n 100000 >deep.xml || true
refused "deep" malformed_xml deep.xml
printf '<dds>\n<a\033[31m b="c"/></dds>' >escape.xml
qos 2 "escape codes" check escape.xml
grep -q $'\033' "$SCRATCH/out" && fail "escape codes reach the terminal"

cat >compose.yaml <<'TEXT'
services:
  world: { image: giveway, command: giveway-world, environment: { GIVEWAY_DOMAIN: 7 } }
  vehicle:
    image: giveway
    command: giveway-vehicle --qos /etc/giveway/mine.xml
    environment: [GIVEWAY_DOMAIN=7]
    volumes: [./mine.xml:/etc/giveway/mine.xml:ro]
    scale: 8
TEXT
cp "$sets/default.xml" mine.xml
qos 0 "a sound compose file" check --compose compose.yaml
sed 's/_DOMAIN=7/_DOMAIN=8/; /--qos/s/giveway.mine/elsewhere\/mine/' compose.yaml >split.yaml
qos 2 "a fleet that is split" check --compose split.yaml --json
says "a fleet that is split" '[.findings[].rule] == ["domain_split", "qos_not_mounted"]
  and all(.findings[]; .line > 0 and .subject == "vehicle")'
# Compose takes variables from the .env next to its file; a set it named was not looked at.
# shellcheck disable=SC2016 # it is for compose to expand
sed 's/GIVEWAY_DOMAIN=7\]/GIVEWAY_DOMAIN=7, "GIVEWAY_QOS=$FLEET_SET"]/; s/ --qos .*//' compose.yaml >variable.yaml
echo 'FLEET_SET=no_such_set' >.env
qos 2 "a set that .env names" check --compose variable.yaml --json
says "a set that .env names" 'any(.findings[]; .rule == "unreadable_file")'
FLEET_SET=default qos 0 "this shell counts before .env" check --compose variable.yaml
rm .env
echo "services: [" >none.yaml
qos 2 "a compose file that is none" check --compose none.yaml --json
says "a compose file that is none" '.findings[0].rule == "malformed_yaml"'

cp "$bad/lifespan.xml" DEFAULT_FASTRTPS_PROFILES.xml
qos 1 "a default file lies about" check
grep -q default_profiles_file "$SCRATCH/out" || fail "the default file is not named"
rm DEFAULT_FASTRTPS_PROFILES.xml
SKIP_DEFAULT_XML=1 qos 1 "a misnamed variable" check
GIVEWAY_QSO=x qos 1 "a misspelt variable" check

qos 2 "an unknown scenario" check --scenario no_such --json
says "an unknown scenario" '.findings[0].rule == "could_not_run"'

qos 0 "show" show --json
says "show" '(.endpoints | length) == 33
  and any(.endpoints[]; .profile == "fleet_beacon_writer" and any(.values[];
    .policy == "deadline" and .value == "100 ms" and .origin == "profile" and .line > 0))
  and any(.endpoints[].values[]; .policy == "heartbeat_period" and .origin == "code")
  and any(.endpoints[].values[]; .policy == "lifespan" and .origin == "default")'
qos 0 "show of a large fleet" show giveway_participant --vehicles 64 --json
says "show of a large fleet" 'any(.endpoints[0].values[];
  .policy == "participant_lease" and .value == "20 s" and .origin == "code")'
GIVEWAY_INTERFACE=any qos 0 "show with a variable" show giveway_participant --json
says "show with a variable" 'any(.endpoints[0].values[];
  .policy == "interface" and .value == "any" and .origin == "environment")'
qos 0 "no difference" show --diff default "$sets/default.xml"
qos 1 "a difference" show --diff default lossy_radio --json
says "a difference" 'any(.differences[]; .profile == "fleet_beacon_reader" and
  .policy == "deadline" and .a.value == "150 ms" and .b.value == "200 ms")'
# Of sets that differed in transports alone it said that nothing did.
sed 's/<receiveBufferSize>1048576</<receiveBufferSize>2097152</' "$sets/default.xml" >buffer.xml
qos 1 "a difference of a transport" show --diff default buffer.xml --json
says "a difference of a transport" '.differences | length == 1 and
  (.[0] | .profile == "transport giveway_udp" and .policy == "receiveBufferSize" and .b.value == "2097152")'
qos 0 "a difference of another profile" show fleet_beacon_writer --diff default buffer.xml
qos 1 "shared memory" show --diff default same_host --json
says "shared memory" 'any(.differences[]; .profile | startswith("transport "))'
qos 2 "show of nothing" show no_such_profile
qos 2 "show of a broken file" show --qos cut.xml
qos 2 "no verb" lint

# fails_to_write CODE ARGUMENTS...: what is longer than stdio's buffer fails as it is put, not as the rest is
# flushed: the exit code was that of success.
fails_to_write() {
  local wanted=$1 code=0
  shift
  "$FLEETCTL" "$@" >/dev/full 2>err || code=$?
  [[ $code -eq $wanted ]] || fail "fleetctl $* on a full disk: exit code $code: $(<err)"
}
if [[ -w /dev/full ]]; then
  fails_to_write 2 qos show --json
  fails_to_write 2 qos check default --json
  fails_to_write 2 faults list --json
  fails_to_write 2 doctor --json
  fails_to_write 1 virtual crossing --seeds 1..2 --json
fi

crossing() { # SET: starts a crossing with it; sets $domain
  : >run.json.err # before there is anything to look for
  judged_run run.json logs intersection_yield --qos "$1" &
  fleet=$!
  domain=$(domain_said run.json.err) || fail "$1: no domain in $(cat run.json.err)"
}

arrives() { # SET: the running crossing passes
  wait "$fleet" || fail "a crossing with $1: $(cat run.json; tail -n 5 run.json.err)"
  jq -e '.verdict == "passed"' run.json >/dev/null || fail "a crossing with $1: $(cat run.json)"
}

crossing lossy_radio
qos 0 "live" show --live 2 --domain "$domain" --qos lossy_radio --json
says "live" '.vehicle == 2 and .runs_with == "lossy_radio.xml" and (.values | length > 150) and
  all(.values[]; .value == .expected) and any(.values[]; .profile == "fleet_beacon_reader" and
  .policy == "liveliness_lease" and .value == "500 ms" and .origin == "profile" and .line > 0)'
qos 1 "live, of another file" show --live 2 --domain "$domain"
grep -q '200 ms .*lossy_radio.xml:[0-9]*; not 150 ms as by' "$SCRATCH/out" || fail "live: $(cat "$SCRATCH/out")"
arrives lossy_radio
crossing same_host
arrives same_host
# Other tests may run a fleet, but none has such a vehicle.
qos 2 "live without a domain" show --live 99

[[ $failures -eq 0 ]]
