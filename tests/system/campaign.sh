#!/usr/bin/env bash
# `fleetctl campaign`: one JSON object however the campaign was divided, run and interrupted, and what is
# refused, with a reason and exit code 2.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
cd "$SCRATCH"
unset JOB_COMPLETION_INDEX SLURM_ARRAY_TASK_ID PARALLEL_SEQ

cat >plan.textproto <<'PLAN'
name: "small"
generator: ["crossing", "convoy"]
seeds: [1, 51]
vehicles: [2, 4]
loss_percent: [0, 20]
shards: 4
PLAN

# campaign CODE NAME ARGUMENTS...: ends with CODE; output in ./out and ./err.
campaign() {
  local wanted=$1 name=$2 code=0
  shift 2
  timeout 60 "$FLEETCTL" campaign "$@" >out 2>err || code=$?
  [[ $code -eq $wanted ]] || fail "$name: exit code $code: $(head -c 900 out err)"
}
# refused NAME PATTERN ARGUMENTS...: exit code 2, a message like PATTERN, and nothing on stdout.
refused() {
  local name=$1 pattern=$2
  shift 2
  campaign 2 "$name" "$@"
  grep -Eq -- "$pattern" err || fail "$name: no '$pattern' in: $(head -c 900 err)"
  [[ ! -s out ]] || fail "$name: something on stdout"
}

# One process with two threads.
campaign 0 "one shard" shard plan.textproto --of 1 --index 0 --jobs 2
[[ $(wc -l <out) -eq 1 ]] || fail "one shard: $(wc -l <out) lines"
mv out whole.log
campaign 0 "merge of one" merge whole.log --json
mv out whole.json
jq -e '.verdict == "passed" and .all.runs == 102 and (.generators | length) == 2' whole.json >/dev/null ||
  fail "merge of one: $(<whole.json)"
# The runs are those of fleetctl virtual.
"$FLEETCTL" virtual convoy --seeds 1..51 --vehicles 2..4 --loss 0..20 --json >virtual.json
[[ $(jq -r '.generators[1] | .hash, .min_separation_m, .delay_s.mean' whole.json) == \
  $(jq -r '.hash, .min_separation_m, .delay_s.mean' virtual.json) ]] || fail "not the runs of fleetctl virtual"

# Four shards, each given its number by another engine; one of them is killed and run again.
JOB_COMPLETION_INDEX=0 campaign 0 "Kubernetes" shard plan.textproto --out results
SLURM_ARRAY_TASK_ID=1 campaign 0 "Slurm" shard plan.textproto --out results
PARALLEL_SEQ=3 campaign 0 "parallel" shard plan.textproto --out results
sed 's/51/100051/' plan.textproto >long.textproto # certainly not over when it is killed
for signal in KILL TERM; do
  code=0
  "$FLEETCTL" campaign shard long.textproto --index 3 --out results >killed.log 2>err &
  killed=$!
  sleep 0.5
  kill -"$signal" "$killed"
  wait "$killed" 2>/dev/null || code=$?
  [[ $code -eq 137 || $code -eq 143 ]] || fail "killed by $signal: exit code $code"
  [[ ! -s killed.log ]] || fail "killed by $signal: it printed a result"
done
[[ $(find results -type f | sort | tr '\n' ' ') == *0-of-4.json*1-of-4.json*2-of-4.json\  ]] ||
  fail "a killed shard left files: $(ls -A results)"
refused "a shard lacks" 'index = 3: lacks: 1 of 4 shards; .*--of 4 --index 3' merge results/*.json
campaign 0 "run again" shard plan.textproto --index 3 --out results
campaign 0 "merge of four" merge results/*.json --json
cmp -s out whole.json || fail "four shards give another result: $(diff out whole.json)"
campaign 0 "merge of four, for people" merge results/*.json
grep -Eq '^all +102 +0 +0 ' out || fail "for people: $(<out)"

# As kubectl logs gives them: in one stream, between other output.
{ echo "shard 1 of 4: words"; cat results/*.json; echo; } >pods.log
campaign 0 "merge of a log" merge pods.log --json
cmp -s out whole.json || fail "a log gives another result"

# A result that exists is not computed again: the file stays as it is, and is what is printed.
touch -d '2001-01-01' results/small.1-of-4.json
campaign 0 "there already" shard plan.textproto --index 1 --out results
cmp -s out results/small.1-of-4.json || fail "there already: another line"
[[ $(date -r results/small.1-of-4.json +%Y) -eq 2001 ]] || fail "there already: it was written again"
sed 's/"plan":"[0-9a-f]*"/"plan":"0123456789abcdef"/' results/small.1-of-4.json >other.json
cp other.json results/small.1-of-4.json
campaign 0 "of another plan" shard plan.textproto --index 1 --out results
grep -q 'of another plan or program' err || fail "of another plan: $(<err)"
campaign 0 "replaced" merge results/*.json --json
cmp -s out whole.json || fail "replaced: another result"

# Broken invariants give exit code 1, with the command that shows each again.
cat >deadly.textproto <<'PLAN'
name: "deadly"
generator: "crossing"
seeds: [1, 3]
vehicles: 2
crashes: 9
PLAN
campaign 1 "a failing shard" shard deadly.textproto --index 0
mv out deadly.log
campaign 1 "a failing campaign" merge deadly.log --json
jq -r '.failing[0].command' out >shown
[[ $(<shown) == "fleetctl virtual crossing --seed "[123]" --vehicles 2 --crashes 9" ]] || fail "command: $(<shown)"
code=0
read -ra words <shown
"$FLEETCTL" "${words[@]:1}" >/dev/null || code=$?
[[ $code -eq 1 ]] || fail "the command does not fail again: exit code $code"

# A scenario in place of generators: its runs are those of fleetctl virtual too. Cut short, no
# vehicle arrives, though its file expects it.
printf 'name: "placed"\nscenario: "four_way"\nseeds: [1, 4]\n' >placed.textproto
for index in 0 1 2; do campaign 0 "a scenario" shard placed.textproto --of 3 --index "$index" --out placed; done
campaign 0 "merge of a scenario" merge placed/*.json --json
"$FLEETCTL" virtual four_way --seeds 1..4 --json >virtual.json
[[ $(jq -r '.all.hash' out) == $(jq -r '.hash' virtual.json) ]] || fail "a scenario: not the runs of fleetctl virtual"
echo 'duration_s: 2' >>placed.textproto
campaign 1 "a scenario cut short" shard placed.textproto --index 0
mv out placed.log
campaign 1 "merge of it" merge placed.log --json
jq -e '.all.violations.expectation == 4 and (.reason | contains("expectation"))' out >/dev/null || fail "cut short: $(<out)"
[[ $(jq -r '.failing[2].command' out) == "fleetctl virtual four_way --seed 3 --duration 2" ]] || fail "cut short: $(<out)"

# Bad input.
refused "no number" 'neither JOB_COMPLETION_INDEX, SLURM_ARRAY_TASK_ID nor PARALLEL_SEQ' shard plan.textproto
SLURM_ARRAY_TASK_ID=1 PARALLEL_SEQ=1 refused "two numbers" 'more than one engine' shard plan.textproto
PARALLEL_SEQ=5 refused "beyond the last" 'from 1 to 4' shard plan.textproto
refused "beyond the last" 'from 0 to 3' shard plan.textproto --index 4
refused "no such plan" 'faulty, nightly' shard no_such --index 0
printf 'name: "a"\ngenerator: "crosing"\nseeds: [9, 3]\nloss_percent: 100\nfaults: "no_such"\n' >bad.textproto
refused "all at once" 'no shipped fault file' shard bad.textproto --index 0
[[ $(grep -Ec '^bad.textproto:[234]: ' err) -eq 3 ]] || fail "all at once: $(<err)"
sed 's/vehicles.*/faults: "everything"/' plan.textproto >everything.textproto
refused "what a virtual run cannot do" 'skip_unsupported: true' shard everything.textproto --index 0
echo >occupied
printf 'name: "a"\nscenario: "four_way"\nseeds: 1\nvehicles: 3\n' >named.textproto
refused "vehicles of a scenario that names its own" 'vehicles = 3: it names its vehicles' shard named.textproto --index 0
printf 'name: "a"\nscenario: "convoy"\ngenerator: "swarm"\nseeds: 1\n' >both.textproto
refused "both" 'is a generator too' shard both.textproto --index 0
refused "a file for a folder" 'occupied' shard plan.textproto --index 0 --out occupied
refused "twice" 'index = 1: stands in results/small.1-of-4.json too' merge results/*.json results/small.1-of-4.json
refused "another plan" 'plan = 0123456789abcdef' merge results/*.json other.json
sed 's/"program":"[0-9a-f]*"/"program":"abcd"/' results/small.1-of-4.json >other.json
refused "another program" 'program = abcd' merge results/small.[023]* other.json
head -c 500 results/small.1-of-4.json >half.json
refused "half a file" 'half.json: is no result of a shard' merge results/small.[023]* half.json
refused "no result" 'no line of it is a result' merge plan.textproto
refused "no file" 'does not exist' merge no_such.json

# The shipped campaigns, and the help.
for shipped in nightly faulty; do
  refused "$shipped" 'from 0 to' shard "$shipped" --index 99999
done
for verb in campaign 'campaign shard' 'campaign merge'; do
  # shellcheck disable=SC2086  # two words
  "$FLEETCTL" $verb --help >/dev/null || fail "$verb --help: exit code $?"
done

# The files of Slurm and GNU parallel: what they run for a shard is tried here.
PATH=$(dirname "$FLEETCTL"):$PATH SLURM_ARRAY_TASK_ID=2 SLURM_CPUS_PER_TASK=2 \
  bash "$REPOSITORY/config/deploy/campaign.slurm" plan.textproto 4 slurm >/dev/null 2>err ||
  fail "campaign.slurm: $(<err)"
cmp -s slurm/small.2-of-4.json results/small.2-of-4.json || fail "campaign.slurm: another result"
code=0
bash "$REPOSITORY/config/deploy/campaign.slurm" plan.textproto >/dev/null 2>err || code=$?
[[ $code -eq 2 && $(<err) == usage:* ]] || fail "campaign.slurm without arguments: exit code $code"
# The second time over a stub ssh that passes on nothing of the environment: the number must come through, and
# stdout is what comes back.
if parallel --version 2>/dev/null | grep -q GNU; then
  PATH=$(dirname "$FLEETCTL"):$PATH
  seq 4 | parallel -N0 fleetctl campaign shard plan.textproto --of 4 --out parallel >/dev/null 2>err ||
    fail "parallel: $(<err)"
  campaign 0 "merge of parallel" merge parallel/*.json --json
  cmp -s out whole.json || fail "parallel gives another result"
  cat >ssh <<'SSH'
#!/usr/bin/env bash
# ssh [OPTION ...] HOST -- WORD ...
while [[ $1 != -- ]]; do shift; done
shift
exec env -i PATH="$PATH" HOME="$HOME" SHELL=/bin/bash bash -c "$*"
SSH
  chmod +x ssh
  seq 4 | parallel -N0 --ssh "$PWD/ssh" --sshlogin 1/here,1/there \
    fleetctl campaign shard "$PWD/plan.textproto" --of 4 >over_ssh.log 2>err || fail "parallel over ssh: $(<err)"
  campaign 0 "merge over ssh" merge over_ssh.log --json
  cmp -s out whole.json || fail "ssh gives another result"
else
  fail "GNU parallel is missing: apt-get install parallel"
fi

[[ $failures -eq 0 ]]
