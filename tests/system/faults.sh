#!/usr/bin/env bash
# `fleetctl faults` as its README.md and its help show it: lists that expand to themselves, and what is
# refused. Starts nothing.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
cd "$SCRATCH"

# The commands of services/fleetctl/faults/README.md.
"$FLEETCTL" faults list >kinds || fail "list: exit code $?"
[[ $(grep -c '^  [a-z]' kinds) -eq 43 ]] || fail "not 43 kinds: $(<kinds)"
"$FLEETCTL" faults expand everything --seed 1 --duration 30m --vehicles 20 >list.textproto ||
  fail "expand everything: exit code $?"
"$FLEETCTL" faults expand list.textproto --duration 30m --vehicles 20 >again.textproto ||
  fail "expand the list: exit code $?"
grep -v '^#' list.textproto | cmp - again.textproto || fail "the list does not expand to itself"
[[ $(grep -c '^at ' list.textproto) -gt 300 ]] || fail "few faults: $(wc -l <list.textproto)"
"$FLEETCTL" faults expand everything --seed 2 --duration 30m --vehicles 20 >other.textproto
cmp -s list.textproto other.textproto && fail "two seeds give the same list"
"$FLEETCTL" faults expand radio_storm --duration 3m --vehicles 8 --text >lines ||
  fail "--text: exit code $?"
grep -Eq '^[0-9.]+ s for [0-9.]+ s: vehicle [1-8]: loss probability=0.4  \[loss [0-9]+\]$' lines ||
  fail "--text: $(head -n 3 lines)"
# Those of the help.
"$FLEETCTL" faults expand calm --duration 3m --vehicles 8 --json | jq -e '.faults[].kind' >/dev/null ||
  fail "--json"
"$FLEETCTL" faults list --json | jq -r '.[] | select(.virtual).kind' >virtual || fail "list --json"
grep -qx sonar_off virtual || fail "in virtual time: $(<virtual)"
"$FLEETCTL" faults expand everything --duration 20s --vehicles 4 --warm-up 10s --healing 15s >none 2>err || fail "20 s: exit code $?"
grep -q 'leave no time in 20 s' err || fail "no word of a list without faults: $(cat err)"

# The list is that of a soak.
"$FLEETCTL" soak patrol --faults calm --vehicles 4 --seed 3 --duration 20m --virtual --report soak >/dev/null 2>&1 ||
  fail "the soak: exit code $?"
"$FLEETCTL" faults expand calm --vehicles 4 --seed 3 --duration 20m | grep '^at ' | cmp - <(grep '^at ' soak/faults.textproto) ||
  fail "a soak has another list"

for verb in faults 'faults expand' 'faults list'; do
  # shellcheck disable=SC2086  # two words
  "$FLEETCTL" $verb --help >/dev/null || fail "$verb --help: exit code $?"
done

# The example of that README.md, and the same without one rule: the faults of the others do not move.
sed -n '/^\(at\|random\) {/p' "$REPOSITORY/services/fleetctl/faults/README.md" >three.textproto
[[ $(wc -l <three.textproto) -eq 3 ]] || fail "the example of README.md: $(<three.textproto)"
expand() { "$FLEETCTL" faults expand "$1" --seed 7 --duration 1h --vehicles 4 | grep '^at '; }
expand three.textproto >with
sed '/"world"/d' three.textproto >two.textproto
expand two.textproto >without
grep -v 'name: "world"' with | cmp - without || fail "taking a rule out moved another's faults"

# refused NAME PATTERN ARGUMENTS...: exit code 2, a message like PATTERN, and nothing on stdout.
refused() {
  local name=$1 pattern=$2 code=0
  shift 2
  "$FLEETCTL" faults expand "$@" >out 2>err || code=$?
  [[ $code -eq 2 ]] || fail "$name: exit code $code"
  grep -Eq -- "$pattern" err || fail "$name: no '$pattern' in: $(head -c 600 err)"
  [[ ! -s out ]] || fail "$name: something on stdout"
}
run=(--duration 60 --vehicles 2)
echo 'at { name: "a" time_s: 1 kind: "puase" vehicle: 1 for_s: 1 }' >f.textproto
refused "unknown kind" 'f.textproto:1: .*"puase".*write pause' f.textproto "${run[@]}"
echo 'at { name: "a" time_s: 1 kind: "kill" vehicle: 3 }' >f.textproto
refused "absent vehicle" 'f.textproto:1: .*no vehicle 3' f.textproto "${run[@]}"
printf 'at { name: "%s" time_s: %s kind: "%s" vehicle: 1 %s }\n' a 1 pause 'for_s: 5' b 3 kill '' >f.textproto
refused "overlap" 'f.textproto:2: b: .*and a \(1 s for 5 s: vehicle 1: pause\) of line 1' f.textproto "${run[@]}"
echo 'at { name: "a" time_s: 44 kind: "pause" vehicle: 1 for_s: 2 }' >f.textproto
refused "into the healing" 'heals from 45 s' f.textproto "${run[@]}"
refused "no such file" 'calm, everything, flaky_hardware, radio_storm' no_such "${run[@]}"
refused "no time" '--duration.*30 days' calm --duration 5x --vehicles 2
refused "no vehicles" '--vehicles' calm --duration 60 --vehicles 0
refused "text and JSON" 'excludes' calm "${run[@]}" --text --json

[[ $failures -eq 0 ]]
