# shellcheck shell=bash
# Fleets that drive side by side at the same time, one with and one without what is to be measured, and
# the ratio of their figures. Sourced by a bench, which sets `vehicles`, `seconds` and `work`, a folder.
#
#   cpu_ms_s      processor time of a vehicle a second, mean; world_ms_s of the world
#   taken         beacons taken of those that the others sent, %
#   age_p99_ms    age of the oldest beacon decided by, 99 %, mean of the vehicles
#   reaction_ms   from the scan of a cause to obeying wheels, mean of all reactions; reaction_p99_ms
#   turn_us       from waking on a scan to the command sent, mean
#   misses        beacon deadlines that vehicles missed, a sum
# shellcheck disable=SC2269  # errors where one is not set
work=${work:?} seconds=${seconds:?} vehicles=${vehicles:?}
FIGURES=(cpu_ms_s world_ms_s taken age_p99_ms reaction_ms reaction_p99_ms turn_us misses)
declare -A folder=() pid=() domain=()

end_fleets() {
  local name
  for name in "${!pid[@]}"; do kill -INT "${pid[$name]}" 2>/dev/null || true; done
  for name in "${!pid[@]}"; do wait "${pid[$name]}" 2>/dev/null || true; done
  pid=()
}

children_of() { cat "/proc/$1/task"/*/children 2>/dev/null; }
# on_cpu PROGRAM FLEETCTL: nanoseconds that the fleet's processes of this program were on a processor.
on_cpu() {
  local child
  for child in $(children_of "$2"); do
    [[ $(readlink "/proc/$child/exe") == */"$1" ]] || continue
    cat "/proc/$child/task"/*/schedstat
  done | awk '{sum += $1} END {printf "%.0f\n", sum}'
}

# start_fleet NAME SEED SCENARIO [ARGUMENTS]: with the programs in folder[NAME]; returns when its domain is known.
start_fleet() {
  local name=$1 seed=$2 scenario=$3
  shift 3
  rm -f "$work/$name.err" # of the pair before: its domain is not this one's
  "${folder[$name]}/fleetctl" run "$scenario" --duration 600 --seed "$seed" --json "$@" \
    >"$work/$name.json" 2>"$work/$name.err" &
  pid[$name]=$!
  until domain[$name]=$(sed -n 's/.* on domain \([0-9]*\)$/\1/p' "$work/$name.err" 2>/dev/null) && [[ -n ${domain[$name]} ]]; do
    kill -0 "${pid[$name]}" || return
    sleep 0.1
  done
}

# The newest status of each vehicle of a fleet, into a file.
statuses() { # NAME WHEN
  "${folder[$1]}/fleetctl" listen fleet/status --domain "${domain[$1]}" --duration 2 --json \
    2>/dev/null | jq -s 'group_by(.vehicle) | map(last)' >"$work/$1.$2"
}

# watch NAME...: what those fleets' vehicles say before and after, and their processor time meanwhile. A
# bench that does something to a fleet meanwhile has a function while_watched.
while_watched() { sleep "$seconds"; }
declare -A vehicles_ns=() world_ns=() window_ns=()
watch() {
  local name
  for name in "$@"; do statuses "$name" first; done
  for name in "$@"; do
    window_ns[$name]=$(date +%s%N)
    vehicles_ns[$name]=$(on_cpu giveway-vehicle "${pid[$name]}")
    world_ns[$name]=$(on_cpu giveway-world "${pid[$name]}")
  done
  while_watched
  for name in "$@"; do
    window_ns[$name]=$(($(date +%s%N) - window_ns[$name]))
    vehicles_ns[$name]=$(($(on_cpu giveway-vehicle "${pid[$name]}") - vehicles_ns[$name]))
    world_ns[$name]=$(($(on_cpu giveway-world "${pid[$name]}") - world_ns[$name]))
  done
  for name in "$@"; do statuses "$name" last; done
}

# figures NAME: those of a watched fleet, tabs between. TRUE_OF_IT is a jq condition on what its vehicles said
# last (`$b`), and an error where it does not hold.
figures() {
  jq -nr --argjson cpu "${vehicles_ns[$1]}" --argjson world "${world_ns[$1]}" --argjson window "${window_ns[$1]}" \
    --argjson n "$vehicles" --slurpfile a "$work/$1.first" --slurpfile b "$work/$1.last" "
    \$a[0] as \$a | \$b[0] as \$b | def mean: if length > 0 then add / length else 0 end;
    if (\$b | length) != \$n or (\$a | length) != \$n then error(\"not all vehicles were heard\") else . end |
    if ${TRUE_OF_IT:-true} then . else error(\"not so: ${TRUE_OF_IT:-}\") end |"'
    (([$b[].beacons.sent] | add) - ([$a[].beacons.sent] | add)) as $sent |
    (([$b[].beacons.taken] | add) - ([$a[].beacons.taken] | add)) as $taken |
    [$cpu * 1000 / $window / $n, $world * 1000 / $window, 100 * $taken / ($sent * ($n - 1)),
      ([$b[].timing.beacon_age_us.p99] | mean) / 1000,
      ([$b[].timing.reaction_us | select(.values > 0) | .p50] | mean) / 1000,
      ([$b[].timing.reaction_us | select(.values > 0) | .p99] | mean) / 1000,
      ([$b[].timing.turn_us.p50] | mean),
      ([$b[].qos.deadline_missed] | add) - ([$a[].qos.deadline_missed] | add)] |
    map(if type == "number" then . * 1000 | round / 1000 else . end) | @tsv'
}

# ratios FILE: of its lines "with|without FIGURES", a pair after the other: of each figure the mean of the pairs'
# ratios and its 95 % interval by Student's t, two-sided; of misses both sums.
ratios() {
  awk -F '\t' -v names="${FIGURES[*]}" '
    NR == 1 { count = split(names, name, " ")
      split("0 12.706 4.303 3.182 2.776 2.571 2.447 2.365 2.306 2.262", t, " ") }
    { ++lines[$1]
      for (i = 1; i <= count; ++i) { value[$1, lines[$1], i] = $(i + 1); total[$1, i] += $(i + 1) } }
    END { n = lines["with"]
      for (i = 1; i <= count; ++i) {
        if (name[i] == "misses") { printf "%-16s with %d, without %d\n", name[i], total["with", i], total["without", i]; continue }
        sum = square = pairs = 0
        for (k = 1; k <= n; ++k) if (value["without", k, i] > 0) {
          r = value["with", k, i] / value["without", k, i]; sum += r; square += r * r; ++pairs }
        if (pairs < 1) continue
        mean = sum / pairs
        spread = pairs < 2 ? 0 : t[pairs > 10 ? 10 : pairs] * sqrt((square - pairs * mean * mean) / (pairs - 1) / pairs)
        printf "%-16s with / without %.3f  (%.3f to %.3f, %d pairs)\n", name[i], mean, mean - spread, mean + spread, pairs } }' "$1"
}
