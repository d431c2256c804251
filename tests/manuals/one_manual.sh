#!/usr/bin/env bash
# Runs commands of one manual in order, in the folder it is called in: one shell for all, so that what
# one leaves in the background is there for the next. Reads lines "LINE <tab> EXIT CODE <tab> COMMAND".
# Usage: one_manual.sh NAME <LINES; prints "ok" or "FAILED" for each, and after a failure what the command
# printed, on lines that start with "| ".
set -uo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/only_late.sh"
name=$1
ip link set lo up 2>/dev/null || true

# run_was_late COMMAND <OUTPUT: true of a fleetctl run that failed only by which vehicles halted, because the
# machine was late or packets were to be lost; says so.
run_was_late() {
  local output reason ticks
  output=$(cat)
  reason=$(sed -n 's/^FAILED  *[^ :]*: //p' <<<"$output")
  ticks=$(sed -n 's/^overruns  *\([0-9]*\) ticks$/\1/p' <<<"$output")
  [[ $1 != *--impair* ]] || ticks=2 # a vehicle that hears nothing halts as well
  only_late "$reason" "${ticks:-0}" 0 | sed 's/^/| made again: /'
  return "${PIPESTATUS[0]}"
}

mapfile -t lines
for line in "${lines[@]}"; do
  IFS=$'\t' read -r at expected command <<<"$line"
  for try in 1 2 3; do
    eval "$command" >said 2>&1 </dev/null
    code=$?
    [[ $code -ne $expected && $try -lt 3 ]] || break
    run_was_late "$command" <said || break
  done
  if [[ $code -eq $expected ]]; then
    echo "ok      $name:$at: $command"
  else
    echo "FAILED  $name:$at: $command: exit code $code, not $expected"
    tail -n 40 said | sed 's/^/| /'
  fi
done
mapfile -t background < <(jobs -p)
[[ ${#background[@]} -eq 0 ]] || kill "${background[@]}" 2>/dev/null
wait
