#!/usr/bin/env bash
# What bounds.sh and mutants.sh judge by: which figures of a run are outside their bounds.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/virtual/figures.sh
source "$here/figures.sh"
failed=0

# expect WHAT WANTED GOT
expect() {
  [[ $2 != "$3" ]] || return 0
  printf 'FAILED  %s: expected\n%s\nbut got\n%s\n' "$1" "$2" "$3"
  failed=1
}

readonly report='{"verdict":"failed","vehicles":8,"arrived":6,"contacts":1,"delay_s":{"mean":2.5},"traffic":{"by_rule":
  [{"rule":"cruise","mean_s":30}],"stops":0.5,"taken_back":2}}'
expect "the figures of a report" $'contacts 1\nmissing 2\ndelay_s 2.5\nstops 0.5\ntaken_back 2\ncruise_s 30' \
  "$(figures <<<"$report")"
! figures <<<'{"verdict":"not_run"}' || expect "a run that was not run" "an error" "figures"

file=$(mktemp)
trap 'rm -f "$file"' EXIT
printf '%s\n' '# of a test' '' 'run swarm --seeds 1..2' 'delay_s 10 20' '' 'run swarm --seeds 1..20' \
  'delay_s 30 40' 'stops 1 1' >"$file"
expect "the bounds of one run" "delay_s 10 20" "$(bounds_of "$file" "swarm --seeds 1..2")"
expect "no bounds of a run that is not there" "" "$(bounds_of "$file" "swarm")"

readonly bounds=$'delay_s 10 20\nstops 0.1 0.1\nobstacle_s 0 0.5'
expect "inside, by two hundredths" "" "$(outside "$bounds" $'delay_s 20.39\nstops 0.071\nobstacle_s 0.2')"
expect "more" "delay_s 20.410, not 10.000..20.000" "$(outside "$bounds" $'delay_s 20.41\nstops 0.1\nobstacle_s 0')"
expect "less" "delay_s 9.590, not 10.000..20.000" "$(outside "$bounds" $'delay_s 9.59\nstops 0.1')"
expect "one that is left out is 0" "stops 0.000, not 0.100..0.100" "$(outside "$bounds" 'delay_s 15')"
expect "a new one was 0" "signal_s 0.100, not 0.000..0.000" \
  "$(outside "$bounds" $'delay_s 15\nstops 0.1\nsignal_s 0.1')"
exit "$failed"
