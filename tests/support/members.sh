# shellcheck shell=bash
# What the tests of the dynamic fleet share: a domain, a world and vehicles that are children of the
# script itself, and waiting for what they log, with deadlines. Sourced, never run.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"

BIN=$(dirname "$FLEETCTL")
LANES=$REPOSITORY/tests/system/lanes.textproto
declare -A PID # of each member, by its name; its log is $SCRATCH/NAME.log

end_members() {
  local name
  end_listening
  for name in "${!PID[@]}"; do kill -9 "${PID[$name]}" 2>/dev/null || true; done
  [[ -n ${KEEP:-} ]] || rm -rf "$SCRATCH"
}
trap end_members EXIT

# Sets DOMAIN to a free one, and keeps it by the lock that fleetctl takes too.
take_domain() {
  for DOMAIN in $(seq 60 99); do
    exec {lock}>>"${TMPDIR:-/tmp}/giveway-domain-$DOMAIN.lock"
    flock -n "$lock" && [[ -z $(processes_on "$DOMAIN") ]] && return
    exec {lock}>&-
  done
  echo "no free domain" >&2
  exit 2
}

# start NAME PROGRAM ARGUMENTS...; LOG, if set, is where its stderr goes
start() {
  local name=$1 program=$2
  shift 2
  "$BIN/$program" --scenario "$LANES" --domain "$DOMAIN" "$@" 2>>"${LOG:-$SCRATCH/$name.log}" &
  PID[$name]=$!
}

kill_now() { # NAME
  kill -9 "${PID[$1]}"
  wait "${PID[$1]}" 2>/dev/null || true
  unset "PID[$1]"
}

alive() { kill -0 "${PID[$1]}" 2>/dev/null; }

lines_of() { wc -l <"$SCRATCH/$1.log"; }

# await WHAT SECONDS NAME PATTERN [LINE]: true once a line of the member's log after line LINE
# matches; a failure if none does in time.
await() {
  local what=$1 seconds=$2 log=$SCRATCH/$3.log pattern=$4 from=${5:-0} started_us=${EPOCHREALTIME/[.,]/}
  until has_said "$log" "$pattern" "$from"; do
    if ((${EPOCHREALTIME/[.,]/} - started_us > seconds * 1000000)); then
      fail "$what: no '$pattern' in $seconds s; $3 says: $(tail -n 3 "$log" | tr '\n' '|')"
      return
    fi
    sleep 0.02
  done
  echo "$what: $(((${EPOCHREALTIME/[.,]/} - started_us) / 1000)) ms" >&2
}
# has_said LOG PATTERN LINE: true if a line after that one matches. In this process: it is asked fifty times a second.
has_said() {
  local line log_lines=()
  { mapfile -s "$3" -t log_lines <"$1"; } 2>/dev/null || return 1
  for line in "${log_lines[@]}"; do [[ ! $line =~ $2 ]] || return 0; done
  return 1
}

# The id the world gave a member.
id_of() { sed -n 's/.*is vehicle \([0-9]*\).*/\1/p' "$SCRATCH/$1.log" | tail -n 1; }

no_contact() {
  if grep -H 'contact:' "$SCRATCH"/world*.log; then fail "vehicles touched"; fi
}

# Starts a process that only sleeps, 20 ms at a time, and notes each time that it was woken 40 ms late or
# more: then the machine was too busy for vehicles too, whose ranges are stale after 150 ms.
keep_time() {
  : >"$SCRATCH/late_us"
  (
    exec 3<> <(:)
    while :; do
      started=${EPOCHREALTIME/[.,]/}
      read -rt 0.02 -u 3 _ || true
      late_us=$((${EPOCHREALTIME/[.,]/} - started - 20000))
      ((late_us < 40000)) || echo "$late_us" >>"$SCRATCH/late_us"
    done
  ) &
  PID[time]=$!
}
times_late() { wc -l <"$SCRATCH/late_us"; }
