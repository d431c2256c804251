# shellcheck shell=bash
# Which failed runs are made again. Sourced, never run.

# only_late REASON TICKS SCANS: true if a run of that reason failed for nothing but who halted, while the
# machine stood still: a vehicle whose ranges are 150 ms old halts, and has to. TICKS is for how many the
# world was late, SCANS how many the latest vehicle has missed; on a quiet machine not one is.
only_late() {
  [[ $1 =~ ^halted:\ [^\;]*$ ]] && (($2 >= 2 || $3 >= 2)) || return 1
  echo "$1; the world was late for $2 ticks, a vehicle for $3 scans"
}
# The scans that the vehicle missed of whose logs these are that missed most; 0 of none.
scans_missed() {
  sed -n 's/.*link: ranges_skipped=\([0-9]*\)[ ,"].*/\1/p' | sort -n | tail -n 1 | grep . || echo 0
}
