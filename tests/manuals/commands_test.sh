#!/usr/bin/env bash
# shellcheck disable=SC2016  # fences of Markdown
# What commands.sh must find, in manuals made for it, with a fleetctl that only explains itself.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cat >"$scratch/fleetctl" <<'FAKE'
#!/bin/sh
[ "$1" = help ] && shift
case "$*" in
  run*) echo "Flags: --seed N" ;;
  "qos check"*) echo "Flags: --json" ;;
  qos) echo "Verbs: check" ;;
  *) exit 2 ;;
esac
FAKE
chmod +x "$scratch/fleetctl"
export GIVEWAY_BIN_DIR=$scratch
failed=0

# expect EXIT_CODE PATTERN TEXT_OF_A_MANUAL
expect() {
  local said code=0
  printf '%b' "$3" >"$scratch/README.md"
  said=$(bash "$here/commands.sh" "$scratch/README.md" 2>&1) || code=$?
  if [[ $code -eq $1 ]] && grep -qE -- "$2" <<<"$said"; then return; fi
  echo "wanted '$2' and exit code $1, got $code: $said"
  failed=1
}

expect 0 '^3 commands run, 0 checked$' '```bash\nx=1 # a comment\ntrue # exit code 0\n\n# not this\ntest $x = 1\n```\n'
expect 1 '^FAILED .*:2: false: exit code 1, not 0' '```bash\nfalse\n```\n'
expect 0 '^ok .*:2: false$' '```bash\nfalse   # exit code 1: so it is\n```\n'
expect 1 'exit code 0, not 1' '```bash\ntrue   # exit code 1\n```\n'
expect 0 '^2 commands run' '```bash\necho a \\\n  b >out\ngrep -q "a b" out\n```\n'
expect 0 '^1 commands run' '```console\n$ true\nsome output\n```\n'
expect 0 '^1 commands run' '```bash\nsleep 60 &\n```\n'
expect 0 '^0 commands run, 0 checked' '```text\nfalse\n```\n'
expect 1 'a block without an info string' '```\nfalse\n```\n'
expect 0 '^0 commands run, 2 checked' '```bash needs=hours\nfleetctl run x --seed 3\nfleetctl qos check --json | cat\n```\n'
expect 1 "'--sead' is not known" '```bash needs=hours\nfleetctl run x --sead 3\n```\n'
expect 1 "'--seed' is not known" '```bash needs=hours\nfleetctl qos check --seed 3\n```\n'
expect 1 'no verb' '```bash needs=hours\nfleetctl rum\n```\n'
expect 1 'there is no tests/nowhere.sh' '```bash needs=hours\nbash tests/nowhere.sh\n```\n'
expect 1 "'--nowhere' is not known" '```bash needs=hours\nbash tests/run.sh --nowhere\n```\n'
exit "$failed"
