#!/usr/bin/env bash
# What the tests do where the process they started in the background has not had its first moment yet, and
# where one of them ends early.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
cd "$SCRATCH"

{
  sleep 0.3
  echo 'fleetctl: 2 vehicles and the world on domain 7' >run.err
} &
domain=$(domain_said run.err) || fail "a domain that was said late was not heard"
[[ ${domain:-} == 7 ]] || fail "the domain is not 7: ${domain:-}"
wait
domain_said no.err 2 >/dev/null && fail "a domain that was not said was heard"

# A test that `set -e` ends names the line: once, and not what it expects to fail.
{
  printf 'source %q\n' "$REPOSITORY/tests/support/fleet.sh"
  printf '%s\n' 'false || true' 'inner() {' '  sed -n p missing' '}' 'inner' 'echo not reached'
} >ends.sh
code=0
bash ends.sh >out 2>err || code=$?
[[ $code -eq 2 && ! -s out ]] || fail "a test that ends early: exit code $code: $(cat out)"
grep -qx 'ends.sh:4: exit code 2: sed -n p missing' err || fail "no line is named: $(cat err)"

[[ $failures -eq 0 ]]
