#!/usr/bin/env bash
# Runs commands of one manual in order, in the folder it is called in: one shell for all, so that what
# one leaves in the background is there for the next. Reads lines "LINE <tab> EXIT CODE <tab> COMMAND".
# Usage: one_manual.sh NAME <LINES; prints "ok" or "FAILED" for each, and after a failure what the command
# printed, on lines that start with "| ".
set -uo pipefail
name=$1
ip link set lo up 2>/dev/null || true

mapfile -t lines
for line in "${lines[@]}"; do
  IFS=$'\t' read -r at expected command <<<"$line"
  eval "$command" >said 2>&1 </dev/null
  code=$?
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
