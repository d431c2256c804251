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
# It would land inside the result in the log of a pod.
[[ ! -s err ]] || fail "one shard: something on stderr, which is no terminal: $(<err)"
mv out whole.log
campaign 0 "merge of one" merge whole.log --json
mv out whole.json
jq -e '.verdict == "passed" and .all.runs == 102 and (.generators | length) == 2' whole.json >/dev/null ||
  fail "merge of one: $(<whole.json)"
# The runs are those of fleetctl virtual.
"$FLEETCTL" virtual convoy --seeds 1..51 --vehicles 2..4 --loss 0..20 --json >virtual.json
[[ $(jq -r '.generators[1] | .hash, .min_separation_m, .delay_s.mean' whole.json) == \
  $(jq -r '.hash, .min_separation_m, .delay_s.mean' virtual.json) ]] || fail "not the runs of fleetctl virtual"

# Four shards, each given its number by another engine.
JOB_COMPLETION_INDEX=0 campaign 0 "Kubernetes" shard plan.textproto --out results
[[ ! -s err ]] || fail "Kubernetes: something on stderr: $(<err)"
SLURM_ARRAY_TASK_ID=1 campaign 0 "Slurm" shard plan.textproto --out results
PARALLEL_SEQ=3 campaign 0 "parallel" shard plan.textproto --out results
refused "a shard lacks" 'index = 3: missing: 1 of 4 shards; .*--of 4 --index 3' merge results/*.json
campaign 0 "the one that lacks" shard plan.textproto --index 3 --out results
campaign 0 "merge of four" merge results/*.json --json
cmp -s out whole.json || fail "four shards give another result: $(diff out whole.json)"
campaign 0 "merge of four, for people" merge results/*.json
grep -Eq '^all +102 +0 +0 ' out || fail "for people: $(<out)"

# As kubectl logs gives them: in one stream, between other output.
{ echo "shard 1 of 4: words"; cat results/*.json; echo; } >pods.log
campaign 0 "merge of a log" merge pods.log --json
cmp -s out whole.json || fail "a log gives another result"
{ cat results/small.[023]*; jq -c . results/small.1-of-4.json; } >by_jq.log
campaign 0 "merge of what jq printed" merge by_jq.log --json
cmp -s out whole.json || fail "jq gives another result"

# A shard that is stopped, then run again. Its one run takes seconds.
printf 'name: "slow"\ngenerator: "swarm"\nseeds: [1, 2]\nvehicles: 120\nshards: 2\n' >slow.textproto

# handles_sigterm PID: waits until it does. From then on it must end as it says, and not as any program.
handles_sigterm() {
  local look handled
  for ((look = 0; look < 400; ++look)); do
    handled=$(awk '$1 == "Name:" && $2 != "fleetctl" { exit 1 }
                  $1 == "SigCgt:" { print $2 }' "/proc/$1/status" 2>/dev/null) && ((16#$handled >> 14 & 1)) && return
    sleep 0.02
  done
  fail "it never handled SIGTERM"
}

# stopped CODE SIGNAL...: what it ends with.
stopped() {
  local wanted=$1 shard signal code=0
  shift
  "$FLEETCTL" campaign shard slow.textproto --index 1 --out slow >killed.log 2>err &
  shard=$!
  handles_sigterm "$shard"
  sleep 0.2
  for signal in "$@"; do
    kill -"$signal" "$shard" 2>/dev/null || true
    sleep 0.02
  done
  wait "$shard" 2>/dev/null || code=$?
  [[ $code -eq $wanted ]] || fail "stopped by $*: exit code $code"
  [[ ! -s killed.log && -z $(ls -A slow) ]] || fail "stopped by $*: it left $(ls -A slow) and $(<killed.log)"
  # A third signal does not wait for words.
  [[ $# -gt 1 || $1 == KILL || $(<err) == "shard 1 of 2 was interrupted and has no result" ]] ||
    fail "stopped by $*: $(<err)"
}
stopped 137 KILL
stopped 143 TERM
stopped 130 INT
stopped 143 TERM TERM TERM # as GNU parallel does within a third of a second
campaign 0 "run again" shard slow.textproto --index 1 --out slow
campaign 0 "never stopped" shard slow.textproto --index 1 --out never_stopped
cmp -s slow/slow.1-of-2.json never_stopped/slow.1-of-2.json || fail "run again: another result"

# A result that exists is not computed again: the file stays as it is, and is what is printed.
touch -d '2001-01-01' results/small.1-of-4.json
campaign 0 "there already" shard plan.textproto --index 1 --out results
cmp -s out results/small.1-of-4.json || fail "there already: another line"
[[ $(date -r results/small.1-of-4.json +%Y) -eq 2001 ]] || fail "there already: it was written again"
# What is no result of this shard is replaced, and the message says why, with the path once.
sed 's/51/52/' plan.textproto >more.textproto
campaign 0 "of one more seed" shard more.textproto --index 1 --out more
for there in more/small.1-of-4.json results/small.2-of-4.json /dev/null half.json; do
  head -c 500 results/small.2-of-4.json >half.json
  cat "$there" >results/small.1-of-4.json
  campaign 0 "in place of $there" shard plan.textproto --index 1 --out results
  [[ $(grep -o 'small.1-of-4.json' err | wc -l) -eq 1 && $(<err) == *"; the shard is run again and the file replaced" ]] ||
    fail "in place of $there: $(<err)"
done
mkdir -p folder/small.1-of-4.json
refused "a folder in its place" 'small.1-of-4.json: is a folder; remove it' shard plan.textproto --index 1 --out folder
! grep -q replaced err || fail "a folder in its place: $(<err)"
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

# A full or closed stdout: what was computed is in the file, and the shard is to be tried again. Its line is
# longer than the buffer of stdout.
cat >wide.textproto <<'PLAN'
name: "wide"
generator: ["crossing", "convoy", "merge", "swarm", "corridor"]
seeds: [4294967100, 4294967239]
vehicles: 2
crashes: 9
PLAN
code=0
"$FLEETCTL" campaign shard wide.textproto --index 0 --jobs 2 --out wide >/dev/full 2>err || code=$?
[[ $code -eq 75 && $(<err) == "cannot write the result to stdout" ]] || fail "a full stdout: exit code $code: $(<err)"
campaign 1 "after a full stdout" shard wide.textproto --index 0 --out wide
cmp -s out wide/wide.0-of-1.json || fail "after a full stdout: another line"
[[ $(wc -c <out) -gt 4096 ]] || fail "after a full stdout: a line of only $(wc -c <out) bytes"
for closed in "$FLEETCTL campaign shard wide.textproto --index 0 --out wide" "$FLEETCTL campaign merge wide/wide.0-of-1.json"; do
  code=0
  $closed >&- 2>err || code=$?
  [[ $code -eq 75 || ($code -eq 2 && $closed == *merge*) ]] || fail "$closed: a closed stdout: exit code $code: $(<err)"
done
code=0
"$FLEETCTL" campaign merge wide/wide.0-of-1.json --json >/dev/full 2>err || code=$?
[[ $code -eq 2 && $(<err) == "cannot write the report to stdout" ]] || fail "merge to a full stdout: exit code $code: $(<err)"
campaign 1 "a long report" merge wide/wide.0-of-1.json --json
jq -e '.failing_left_out > 0 and (.failing | length) + .failing_left_out == .all.failed_runs' out >/dev/null ||
  fail "failing runs: $(jq -c '[.all.failed_runs, (.failing | length), .failing_left_out]' out)"
# A file that cannot be written at the end.
code=0
(ulimit -f 4 && exec "$FLEETCTL" campaign shard wide.textproto --index 0 --jobs 2 --out small_disk) 2>err | cat >out || code=$?
[[ $code -eq 75 ]] || fail "a full disk: exit code $code: $(<err)"
cmp -s out wide/wide.0-of-1.json || fail "a full disk: it was not printed"

# A full disk takes neither the file nor its folder; later it may.
if unshare --map-root-user --mount true 2>/dev/null; then
  for inodes in 1 2; do
    code=0
    # shellcheck disable=SC2016  # expanded by the inner shell
    unshare --map-root-user --mount bash -c 'mkdir -p tiny && mount -t tmpfs -o "nr_inodes=$1" none tiny &&
      exec "$2" campaign shard wide.textproto --index 0 --out tiny/results' bash "$inodes" "$FLEETCTL" >out 2>err || code=$?
    [[ $code -eq 75 && ! -s out ]] || fail "a disk of $inodes inodes: exit code $code: $(<err)"
    grep -q 'No space left on device; see to that disk.*run the shard again' err || fail "$inodes inodes: $(<err)"
  done
fi

# Fewer threads than asked for, by an address space that holds the stacks of three; and none.
code=0
(ulimit -s 1048576 -v 4500000 && exec "$FLEETCTL" campaign shard wide.textproto --index 0 --jobs 8) >out 2>err || code=$?
[[ $code -eq 1 ]] || fail "too few threads: exit code $code: $(<err)"
cmp -s out wide/wide.0-of-1.json || fail "too few threads: another result"
code=0
(ulimit -s 4194304 -v 3000000 && exec "$FLEETCTL" campaign shard wide.textproto --index 0) >out 2>err || code=$?
[[ $code -eq 75 && ! -s out ]] || fail "no thread: exit code $code: $(<err)"
grep -q 'cannot be run now' err || fail "no thread: $(<err)"

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
refused "a file twice" '^\./results/small.1-of-4.json: is given twice' merge results/*.json ./results/small.1-of-4.json
cp results/small.1-of-4.json other.json
refused "a shard twice" 'index = 1: stands in other.json too' merge other.json results/*.json
refused "another plan" 'plan = [0-9a-f]+: is [0-9a-f]+ in results' merge results/small.[023]* more/small.1-of-4.json
sed 's/"contacts":0/"contacts":1/' results/small.1-of-4.json >other.json
refused "an edited one" 'other.json: its checksum is of other contents' merge results/small.[023]* other.json
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
