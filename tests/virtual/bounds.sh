#!/usr/bin/env bash
# Whether fleets spend their time as they did when bounds.txt was recorded: in each of its runs contacts, who did
# not arrive, the mean delay, the stops, and the time by each rule, over hundreds of seeds. Virtual time is
# deterministic, and what the radio loses moves most of these means by a thousandth or two: what moves one out of
# its bounds (figures.sh) is another brain. That may be a better one; record it, and say in the commit why.
# What no single tick shows is seen here: a vehicle that stops too soon, or drives on too late.
# With --record bounds.txt gets the least and the most of each figure without loss and under --draws draws of
# 1 % of loss (of a run with a loss of its own, of that). A line "ok" or "FAILED" each.
# Exit code 0: all inside; 1: one is outside; 2: could not run.
# Usage: bounds.sh [--record] [--draws N] [--jobs J]
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
fleetctl=${GIVEWAY_BIN:-$root/build/release/bin}/fleetctl
# shellcheck source=tests/virtual/figures.sh
source "$here/figures.sh"
bounds=$here/bounds.txt
record=false draws=10 jobs=$(nproc)

usage() {
  sed -n '10s/^# //p' "${BASH_SOURCE[0]}" >&2
  exit 2
}

while [[ $# -gt 0 ]]; do
  case $1 in
    --record) record=true ;;
    --draws | --jobs)
      [[ ${2:-} =~ ^[1-9][0-9]{0,2}$ ]] || usage
      [[ $1 == --draws ]] && draws=$2 || jobs=$2
      shift
      ;;
    *) usage ;;
  esac
  shift
done
[[ -x $fleetctl ]] || { echo "bounds.sh: $fleetctl is not built" >&2 && exit 2; }

# figures_of WORDS: of one run; a run in which an invariant breaks has some too.
figures_of() {
  { "$fleetctl" virtual "$@" --jobs "$jobs" --json </dev/null || [[ $? == 1 ]]; } | figures
}

# recorded WORDS: "NAME LOW HIGH" a line, over all draws.
recorded() {
  local -a words=("$@") loss=(--loss 1)
  local draw
  [[ " $* " != *" --loss "* ]] || loss=()
  {
    figures_of "${words[@]}"
    for ((draw = 1; draw <= draws; ++draw)); do
      figures_of "${words[@]}" "${loss[@]}" --radio-seed "$draw"
    done
  } | awk -v runs=$((draws + 1)) '
    !($1 in low) || $2 < low[$1] { low[$1] = $2 }
    !($1 in high) || $2 > high[$1] { high[$1] = $2 }
    { times[$1]++ }
    END {
      for (name in low) printf "%s %.4f %.4f\n", name, times[name] < runs ? 0 : low[name], high[name]
    }' | sort
}

runs=()
while read -r word line; do
  [[ $word != run ]] || runs+=("$line")
done <"$bounds"

if $record; then
  new=$(mktemp)
  trap 'rm -f "$new"' EXIT
  grep '^#' "$bounds" >"$new"
  for line in "${runs[@]}"; do
    read -ra words <<<"$line"
    { printf '\nrun %s\n' "$line" && recorded "${words[@]}"; } >>"$new"
    echo "recorded $line"
  done
  cp "$new" "$bounds"
  exit
fi

failed=0
for line in "${runs[@]}"; do
  read -ra words <<<"$line"
  now=$(figures_of "${words[@]}") || { echo "bounds.sh: no result of $line" >&2 && exit 2; }
  wrong=$(outside "$(bounds_of "$bounds" "$line")" "$now")
  if [[ -z $wrong ]]; then
    echo "ok      $line"
  else
    echo "FAILED  $line: $(paste -sd ';' <<<"$wrong")"
    failed=1
  fi
done
exit "$failed"
