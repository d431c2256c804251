# shellcheck shell=bash
# How late the machine wakes a process that only sleeps: by as much a deadline of a test is extended. Sourced,
# never run.

# keep_time FILE: starts that process, in the background as $!, and notes in FILE the microseconds of each time
# that it was woken 40 ms late or more: then the machine was too busy for vehicles too, whose ranges are stale
# after 150 ms.
keep_time() {
  : >"$1"
  (
    trap - EXIT ERR
    exec 3<> <(:)
    while :; do
      started=${EPOCHREALTIME/[.,]/}
      read -rt 0.02 -u 3 _ || true
      late=$((${EPOCHREALTIME/[.,]/} - started - 20000))
      ((late < 40000)) || echo "$late" >>"$1"
    done
  ) &
}

# late_us FILE: the sum so far, in microseconds; 0 where no time is kept.
late_us() {
  local sum=0 lines=() line
  [[ ! -e $1 ]] || mapfile -t lines <"$1"
  for line in "${lines[@]}"; do sum=$((sum + line)); done
  echo "$sum"
}
