# shellcheck shell=bash
# Which failed runs are repeated. Sourced, never run.

# only_late REASON TICKS SCANS: true if a run failed with that reason only by which vehicles halted, while the
# machine stalled: a vehicle whose ranges are 150 ms old halts, as it must. TICKS is how many ticks the world
# was late, SCANS how many the worst vehicle missed; on a quiet machine both are 0.
only_late() {
  [[ $1 =~ ^halted:\ [^\;]*$ ]] && (($2 >= 2 || $3 >= 2)) || return 1
  echo "$1; the world was late for $2 ticks, a vehicle for $3 scans"
}
# The largest number of scans that a vehicle of these logs missed; 0 without logs.
scans_missed() {
  sed -n 's/.*link: ranges_skipped=\([0-9]*\)[ ,"].*/\1/p' | sort -n | tail -n 1 | grep . || echo 0
}
