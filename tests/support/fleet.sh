# shellcheck shell=bash
# What the system tests share: where the programs are, a scratch folder, how failures are reported, and which
# processes belong to a run. Sourced, never run. Processes are found by id and by their own arguments, never
# by name alone: other runs on the machine do not matter here.
set -Eeuo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/../support/only_late.sh"
source "$(dirname "${BASH_SOURCE[0]}")/../support/jq.sh"
REPOSITORY=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
FLEETCTL=${GIVEWAY_BIN_DIR:-$REPOSITORY/build/release/bin}/fleetctl
[[ -x $FLEETCTL ]] || {
  echo "no $FLEETCTL; build first: bash services/run.sh --setup-only" >&2
  exit 2
}
SCRATCH=$(mktemp -d)
trap 'rm -rf "$SCRATCH"' EXIT
failures=0
# A script that `set -e` ends says where: its missing lines alone would not.
trap 'say_where_it_ends $? "${BASH_SOURCE[0]##*/}:$LINENO" "$BASH_COMMAND"' ERR
say_where_it_ends() { [[ $BASH_SUBSHELL -gt 0 || $failures -gt 0 ]] || echo "$2: exit code $1: $3" >&2; }

fail() {
  printf 'FAILED: %s\n' "$*"
  failures=$((failures + 1))
}

# The ids of the direct children of a process, one a line.
children_of() {
  local stat pid rest
  for stat in /proc/[0-9]*/stat; do
    { read -r rest <"$stat"; } 2>/dev/null || continue
    pid=${rest%% *}
    rest=${rest##*) } # behind the name, which may hold anything: state, parent, ...
    read -r _ rest _ <<<"$rest"
    [[ $rest == "$1" ]] && echo "$pid"
  done
  return 0
}

# Sets `arguments` to the command line of a process, a blank after each word; empty where there is none. Without
# a process of its own: tests look through all of them many times a second.
read_arguments() {
  local argv=()
  { mapfile -d '' -t argv <"/proc/$1/cmdline"; } 2>/dev/null || true
  arguments=''
  [[ ${#argv[@]} -eq 0 ]] || printf -v arguments '%s ' "${argv[@]}"
}

# The child of fleetctl $1 that is `world` or vehicle number $2; empty if there is none yet.
find_child() {
  local pid arguments
  for pid in $(children_of "$1"); do
    read_arguments "$pid"
    case $2 in
      world) [[ $arguments == */giveway-world\ * ]] && echo "$pid" ;;
      *) [[ $arguments == */giveway-vehicle\ *"--id $2 "* ]] && echo "$pid" ;;
    esac
  done
  return 0
}

# wait_for_child FLEETCTL_PID WHO: prints the id once the child is there; five seconds at most.
wait_for_child() {
  local pid _
  for _ in $(seq 250); do
    pid=$(find_child "$1" "$2")
    [[ -n $pid ]] && echo "$pid" && return
    sleep 0.02
  done
  return 1
}

# domain_said FILE [TENTHS]: prints the domain that a `fleetctl run` in the background names on its stderr, which
# is in FILE; waits 20 seconds, or so many tenths of one. Right after the start the file need not be there: the
# other process creates it.
domain_said() {
  local domain='' _
  for _ in $(seq "${2:-200}"); do
    [[ ! -e $1 ]] || domain=$(sed -n 's/.* on domain \([0-9]*\)$/\1/p' "$1")
    [[ -z $domain ]] || { echo "$domain" && return; }
    sleep 0.1
  done
  return 1
}

# The domain in a child's arguments.
domain_of() {
  local arguments
  read_arguments "$1"
  [[ $arguments =~ .*--domain\ ([0-9]+)\  ]] && echo "${BASH_REMATCH[1]}"
  return 0
}

# The processes of a run on a domain, one a line.
processes_on() {
  local folder arguments
  for folder in /proc/[0-9]*; do
    read_arguments "${folder#/proc/}"
    [[ $arguments == *"/giveway-"*" --domain $1 "* ]] || continue
    echo "${folder#/proc/}"
  done
  return 0
}

# True once no process of the domain is left; waits $2 tenths of a second at most.
all_gone() {
  local _
  for _ in $(seq "$2"); do
    [[ -z $(processes_on "$1") ]] && return
    sleep 0.1
  done
  [[ -z $(processes_on "$1") ]]
}

# excused REPORT LOGS: true if only the lateness of the machine explains that a run failed. An impaired
# channel makes scans late by itself: those do not count.
excused() {
  jq -e '.contacts == 0 and (.violations | all(. == 0))' "$1" >/dev/null 2>&1 || return 1
  only_late "$(jq -r .reason "$1")" "$(jq .tick_overruns "$1")" "$(
    grep -L ' impairment: ' "$2"/vehicle-*.log | tr '\n' '\0' | xargs -0 -r cat | scans_missed
  )"
}

# judged_run REPORT LOGS ARGUMENTS...: fleetctl run ARGUMENTS, with its JSON in REPORT, its stderr in
# REPORT.err, and its exit code. A run that is excused is repeated, twice at most, and noted in REPORT.again,
# a line each time.
judged_run() {
  local report=$1 logs=$2 code why try
  shift 2
  rm -f "$report.again"
  for try in 1 2 3; do
    code=0
    rm -rf "$logs"
    "$FLEETCTL" run "$@" --json --logs "$logs" >"$report" 2>"$report.err" || code=$?
    [[ $code -ne 0 && $try -lt 3 ]] || break
    why=$(excused "$report" "$logs") || break
    echo "$why" >>"$report.again"
    echo "made again: $why" >&2
  done
  return "$code"
}

LISTENERS=()
# listen_places NAME DOMAIN VEHICLE: from now on until end_listening, the pose in the vehicle's beacons, and
# its true one. With the set that requests least: it keeps receiving a fleet that takes another set.
listen_places() {
  local topic
  for topic in beacon truth; do
    "$FLEETCTL" listen "$([[ $topic == beacon ]] && echo fleet || echo world)/$topic" --json \
      --domain "$2" --vehicle "$3" --qos lossy_radio >"$SCRATCH/$1.$topic" 2>"$SCRATCH/$1.$topic.err" &
    LISTENERS+=("$!")
  done
}
end_listening() {
  local pid
  for pid in "${LISTENERS[@]}"; do kill -INT "$pid" 2>/dev/null || true; done
  for pid in "${LISTENERS[@]}"; do wait "$pid" || true; done
  LISTENERS=()
}

# places NAME: for each life of the vehicle in each world, in order of time, as one list: the number of
# beacons that could be compared, how far the worst was beyond 3 sigma of its own covariance, the first
# and last destination, in millimetres, how far it was to that when last heard, and whether this life
# continues the one before: to the same destination, or to another where that was reached meanwhile.
places() {
  jq -n --slurpfile said "$SCRATCH/$1.beacon" --slurpfile is "$SCRATCH/$1.truth" '
    def at: "\(.world_epoch):\(.tick)";
    ($is | map({key: at, value: .world_from_body}) | from_entries) as $true |
    [$said[] | select($true[at]) | $true[at] as $place |
      {life: "\(.world_epoch):\(.boot_epoch)", heard_s,
       toward: ([.toward_x_m, .toward_y_m] | map(. * 1000 | round)),
       left_m: ([.toward_x_m - $place.x_m, .toward_y_m - $place.y_m] | map(. * .) | add | sqrt),
       beyond_m: (([.world_from_body.x_m - $place.x_m, .world_from_body.y_m - $place.y_m] |
           map(. * .) | add | sqrt) - 3 * ([.covariance.xx_m2, .covariance.yy_m2] | max | sqrt))}] |
    group_by(.life) | sort_by(.[0].heard_s) |
    map({beacons: length, beyond_m: (map(.beyond_m) | max), first_toward: .[0].toward,
         last_toward: .[-1].toward, left_m: .[-1].left_m}) |
    . as $lives | [range(length) | $lives[.] + {continues: (. == 0 or
      $lives[. - 1].last_toward == $lives[.].first_toward or $lives[. - 1].left_m < 1)}]'
}

# await_places NAME LIVES COUNT: until it has had so many lives, and so many beacons of the last can be
# compared; fails after ten seconds. The reader of one topic may be matched long after that of the other.
await_places() {
  local until=$((SECONDS + 10))
  until places "$1" 2>/dev/null | jq -e "length >= $2 and .[-1].beacons >= $3" >/dev/null; do
    if ((SECONDS > until)); then
      fail "$1: $2 lives and $3 beacons were awaited: $(places "$1" | tr -d '\n '); of beacons and truths" \
        "$(wc -l "$SCRATCH/$1".{beacon,truth} | tr -s ' \n' ' ') were heard: $(tail -n 2 "$SCRATCH/$1".*.err)"
      return
    fi
    sleep 0.2
  done
}
