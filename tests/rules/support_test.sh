#!/usr/bin/env bash
# What the test scripts share to judge by: an empty report is no passed one, and a command of a manual is made
# again only where a late machine or lost packets failed it.
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/../support/jq.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failures=0
expect() { # WHAT WANTED GOT
  [[ $2 == "$3" ]] || {
    echo "$1: $3, not $2"
    failures=$((failures + 1))
  }
}

code_of() { "$@" >/dev/null 2>&1 && echo 0 || echo $?; }
: >"$folder/empty"
echo '{"a": 1}' >"$folder/one"
expect "an empty report" 4 "$(code_of jq -e '.a == 1' "$folder/empty")"
expect "what is true" 0 "$(code_of jq -e '.a == 1' "$folder/one")"
expect "what is false" 1 "$(code_of jq -e '.a == 2' "$folder/one")"
expect "a value" 1 "$(jq .a "$folder/one")"

# made CODE REASON TICKS [FLAG]: how often a run with that flag is made that ends so.
made() {
  rm -f "$folder/runs"
  cat >"$folder/run.sh" <<RUN
echo >>"$folder/runs"
echo "FAILED  crossing: $2"
echo "overruns     $3 ticks"
exit $1
RUN
  (cd "$folder" && printf '1\t0\tbash run.sh %s\n' "${4:-}" | bash "$here/../manuals/one_manual.sh" manual >"$folder/said")
  wc -l <"$folder/runs"
}
expect "a run that a late machine failed" 3 "$(made 1 'halted: expected 2, got 1 2' 4)"
grep -q '^| FAILED  crossing' "$folder/said" || expect "what it printed" shown hidden
expect "a run on time" 1 "$(made 1 'halted: expected 2, got 1 2' 0)"
expect "a run that lost packets" 3 "$(made 1 'halted: expected 2, got 1 2' 0 --impair)"
expect "a contact of one that lost packets" 1 "$(made 1 'contact: 1 2' 0 --impair)"
expect "a run with a contact" 1 "$(made 1 'halted: expected 2, got 1 2; contact: 1 2' 4)"
expect "a run that passed" 1 "$(made 0 'halted: expected 2, got 1 2' 4)"

[[ $failures -eq 0 ]]
