# shellcheck shell=bash
# What the tests of the dynamic fleet share: a domain, a world and vehicles that are children of the
# script itself, and waiting for what they log, with deadlines. Sourced, never run.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
source "$(dirname "${BASH_SOURCE[0]}")/../support/lateness.sh"

BIN=$(dirname "$FLEETCTL")
LANES=$REPOSITORY/tests/system/lanes.textproto
declare -A PID # of each member, by its name; its log is $SCRATCH/NAME.log

end_members() {
  local name
  end_listening
  [[ ${failures:-0} -eq 0 ]] || tail -n 5 "$SCRATCH"/*.log >&2
  for name in "${!PID[@]}"; do kill -9 "${PID[$name]}" 2>/dev/null || true; done
  [[ -n ${KEEP:-} ]] || rm -rf "$SCRATCH"
}
trap end_members EXIT

# Sets DOMAIN to a free one, and keeps it by the lock that fleetctl takes too.
take_domain() {
  [[ -n ${PID[time]:-} ]] || {
    keep_time "$SCRATCH/late_us"
    PID[time]=$!
  }
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
# matches; a failure if none does in time, to which is added what the machine was late meanwhile.
await() {
  local what=$1 seconds=$2 log=$SCRATCH/$3.log pattern=$4 from=${5:-0} started_us=${EPOCHREALTIME/[.,]/}
  local late_before_us waited_us
  late_before_us=$(late_us "$SCRATCH/late_us")
  until has_said "$log" "$pattern" "$from"; do
    waited_us=$((${EPOCHREALTIME/[.,]/} - started_us))
    if ((waited_us > seconds * 1000000)) &&
      ((waited_us > seconds * 1000000 + $(late_us "$SCRATCH/late_us") - late_before_us)); then
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
