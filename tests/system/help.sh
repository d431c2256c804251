#!/usr/bin/env bash
# The help of the command line: it fits any terminal, with suggestions for misspelt names, completion,
# colours, man pages, and verbs that find the only fleet by themselves.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
cd "$SCRATCH"
programs=$(dirname "$FLEETCTL")

# verbs_of VERB...: those its help lists.
verbs_of() { "$FLEETCTL" "$@" --help | sed -n '/^Verbs:/,/^$/s/^  \([a-z]\+\) .*/\1/p'; }
# on_terminal COLUMNS COMMAND: its output on a terminal so wide.
on_terminal() { script -qec "stty cols $1; $2" /dev/null </dev/null | tr -d '\r'; }
# The widest of its lines, without colours.
widest() { sed 's/\x1b\[[0-9;]*m//g' | wc -L; }

mapfile -t verbs < <(verbs_of)
[[ ${#verbs[@]} -ge 15 ]] || fail "verbs: ${verbs[*]}"
pages=('')
for verb in "${verbs[@]}"; do
  pages+=("$verb")
  while read -r part; do pages+=("$verb $part"); done < <(verbs_of "$verb")
done
[[ ${#pages[@]} -ge 22 ]] || fail "pages: ${pages[*]}"
for page in "${pages[@]}"; do
  # shellcheck disable=SC2086  # words of a command line
  "$FLEETCTL" $page --help >help || fail "$page --help: exit code $?"
  # shellcheck disable=SC2086
  "$FLEETCTL" help $page | cmp -s - help || fail "help $page is not $page --help"
  [[ $(wc -L <help) -le 80 ]] || fail "$page --help: $(wc -L <help) columns"
  ! grep -nE 'UINT|4294967295|TEXT:' help || fail "$page --help names a type of a program"
  grep -q "fleetctl $page" < <(sed -n '/^Examples:/,/^$/p' help) || fail "$page --help: no example of its own"
  for columns in 66 120; do
    wide=$(on_terminal "$columns" "$FLEETCTL $page --help" | wc -L)
    [[ $wide -le $columns ]] || fail "$page --help: $wide columns on a terminal of $columns"
  done
done
# The rules of variables know all that the verbs read, and so notice when one is misspelt.
mapfile -t ours < <(for page in "${pages[@]}"; do
  # shellcheck disable=SC2086
  "$FLEETCTL" $page --help
done | tr -d ' \n' | grep -o '\[GIVEWAY_[A-Z0-9_]*\]' | tr -d '[]' | sort -u)
[[ ${#ours[@]} -ge 15 ]] || fail "variables: ${ours[*]}"
env "${ours[@]/%/X=1}" "$FLEETCTL" qos check >out 2>&1 || true
for name in "${ours[@]}"; do
  grep -q "${name}X: .*$name is meant?" out || fail "a misspelt $name is not noticed"
done
for service in giveway-observer giveway-vehicle giveway-world; do
  "$programs/$service" --help >help || fail "$service --help: exit code $?"
  [[ $(wc -L <help) -le 80 ]] || fail "$service --help: $(wc -L <help) columns"
done
[[ $("$FLEETCTL" version) == "$("$FLEETCTL" --version)" ]] || fail "version is not --version"
if [[ -w /dev/full ]]; then
  for words in 'help run' version 'completion bash' 'complete ru' --help --version 'run --help'; do
    code=0
    # shellcheck disable=SC2086  # words of a command line
    "$FLEETCTL" $words >/dev/full 2>err || code=$?
    [[ $code -eq 2 ]] || fail "$words to a full disk: exit code $code: $(<err)"
  done
fi

# meant PATTERN ARGUMENTS...: refused, with a suggestion.
meant() {
  local pattern=$1 code=0
  shift
  timeout 5 "$@" >out 2>err || code=$?
  [[ $code -eq 2 ]] || fail "$*: exit code $code"
  grep -q -- "$pattern" err || fail "$*: $(<err)"
}
meant "no verb 'rum'; did you mean 'run'?" "$FLEETCTL" rum
meant "no verb 'chekc'; did you mean 'check'?" "$FLEETCTL" qos chekc
meant "no verb 'docter'; did you mean 'doctor'?" "$FLEETCTL" help docter
meant "has no flag --vehicels; did you mean '--vehicles'?" "$FLEETCTL" run open_fleet --vehicels 3
meant "did you mean 'intersection_yield'?" "$FLEETCTL" run intersection_yeild
meant "did you mean 'radio_storm'?" "$FLEETCTL" faults expand radiostorm --duration 3m --vehicles 2
meant "did you mean 'lossy_radio'?" "$FLEETCTL" run intersection_yield --qos lossy-radio
meant "did you mean 'lossy_radio'?" "$FLEETCTL" qos show --qos lossy-radio
meant "did you mean '--domain'?" "$programs/giveway-vehicle" --domian 3
meant "did you mean '--domain'?" "$programs/giveway-observer" --domian 3

# A flag's former name does what its name does.
"$FLEETCTL" plan 4 --cores 8 --memory-gib 8 >positional || fail "plan 4: exit code $?"
"$FLEETCTL" plan --vehicles 4 --cores 8 --memory-gib 8 | cmp -s - positional || fail "plan --vehicles"
"$FLEETCTL" virtual crossing --seeds 1..3 --loss 5 --json | jq -e .hash >bare || fail "no hash"
"$FLEETCTL" virtual crossing --seeds 1..3 --loss 5% --json | jq .hash | cmp -s - bare ||
  fail "--loss 5% is not --loss 5"

# Completion, in bash itself.
completed() { # WORD...: what bash offers for the last one
  bash -c 'source <("$1" completion bash); shift
           COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _fleetctl "$1"; printf "%s\n" "${COMPREPLY[@]}"' \
    bash "$FLEETCTL" "$@"
}
[[ $(completed "$FLEETCTL" pla) == plan ]] || fail "pla: $(completed "$FLEETCTL" pla)"
[[ $(completed "$FLEETCTL" qos ch) == check ]] || fail "qos ch: $(completed "$FLEETCTL" qos ch)"
[[ $(completed "$FLEETCTL" run --lock) == --lockstep ]] || fail "run --lock"
[[ $(completed "$FLEETCTL" run intersection_y) == intersection_yield ]] || fail "run intersection_y"
[[ $(completed "$FLEETCTL" run x --qos los) == lossy_radio ]] || fail "--qos los"
[[ $(completed "$FLEETCTL" run x --log-level w) == warning ]] || fail "--log-level w"

# Tables are as wide as the terminal.
for shown in "faults list" "faults expand everything --duration 5m --vehicles 8 --text" "qos show fleet/beacon" \
  "qos show --diff default lossy_radio" "stopwatch --table" "plan --vehicles 8"; do
  wide=$(on_terminal 80 "$FLEETCTL $shown || true" | widest)
  [[ $wide -le 80 ]] || fail "$shown: $wide columns on a terminal of 80"
done

# Colours on a terminal, and none where NO_COLOR is set or nothing is a terminal.
green=$'\e[32m'
export TERM=xterm
on_terminal 80 "$FLEETCTL virtual crossing --seeds 1..2" >out
grep -qF "$green" out || fail "no colour: $(<out)"
NO_COLOR=1 on_terminal 80 "$FLEETCTL virtual crossing --seeds 1..2" >out
grep -qF "$green" out && fail "NO_COLOR is not honoured: $(<out)"
"$FLEETCTL" virtual crossing --seeds 1..2 >out
grep -qF $'\e[' out && fail "colour in a pipe: $(<out)"

# The only fleet of a machine needs no domain. Only where no other fleet is visible: in namespaces.
if unshare --net --pid --fork --mount-proc true 2>/dev/null; then
  cat >alone.sh <<'SCRIPT'
ip link set lo up
"$1" ls >none 2>none.err && echo "ls of nothing succeeds"
"$1" top --once 2>none.err && echo "top of nothing succeeds"
grep -q 'no fleet runs' none.err || echo "top of nothing: $(<none.err)"
"${1%fleetctl}giveway-observer" 2>none.err && echo "an observer of nothing starts"
grep -q 'no fleet runs' none.err || echo "observer of nothing: $(<none.err)"
"$1" run open_fleet --vehicles 2 --domain 7 --duration 60 >run.out 2>&1 &
until "$1" ls >ls.out 2>&1 || ! kill -0 $!; do sleep 0.5; done # a run takes no domain that is listened to
"$1" top --domain 7 --once --wait 30s >top.out || echo "top --domain: $?"
"$1" ls >ls.out || echo "ls: $?"
grep -Eq '^ +7  127.0.0.1 +here +[0-9]+  1-2$' ls.out || echo "ls: $(<ls.out)"
"$1" ls --json | jq -e '.[0].domain == 7 and (.[0].vehicles | length) == 2' >/dev/null || echo "ls --json"
"$1" listen fleet/beacon --count 2 >listen.out || echo "listen without a domain: $?"
"$1" qos show --live 1 >live.out || echo "qos show --live without a domain: $?"
kill %1; wait
SCRIPT
  said=$(unshare --net --pid --fork --mount-proc bash alone.sh "$FLEETCTL" 2>&1 | grep -v Terminated || true)
  [[ -z $said ]] || fail "$said"
fi

# Man pages, where help2man is installed.
if command -v help2man >/dev/null; then
  bash "$REPOSITORY/services/fleetctl/help/man_pages.sh" "$programs" man || fail "man pages: exit code $?"
  [[ $(find man -name '*.1' | wc -l) -ge 25 ]] || fail "man pages: $(ls man)"
  grep -q 'intersection' man/fleetctl-run.1 || fail "fleetctl-run.1 has no example"
fi

[[ $failures -eq 0 ]]
