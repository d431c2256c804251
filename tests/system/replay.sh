#!/usr/bin/env bash
# Recordings of real runs replay to the bit: of a crossing, of one whose second vehicle is killed with -9, and
# of a file corrupted on the disk, as far as possible.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"

# replayed FILE CONDITION: true of the only file's entry in the report.
replayed() {
  "$FLEETCTL" replay "$1" --json >"$SCRATCH/replay.json" || true
  jq -e ".files | length == 1 and (.[0] | $2)" "$SCRATCH/replay.json" >/dev/null ||
    fail "$1: not true of $(cat "$SCRATCH/replay.json"): $2"
}
same='.steps > 100 and .difference == null and .finding == "" and .lost == 0'

record() { # SCENARIO
  judged_run "$SCRATCH/run.json" "$SCRATCH/logs" "$1" --record "$SCRATCH/$1" ||
    fail "$1: $(cat "$SCRATCH/run.json"; tail -n 5 "$SCRATCH/run.json.err")"
}

record intersection_yield
crossing=$SCRATCH/intersection_yield
"$FLEETCTL" replay "$crossing"/*.recording || fail "the crossing: exit code $?"
for id in 1 2; do replayed "$crossing/vehicle-$id.recording" "$same and .complete"; done
[[ $(find "$crossing" -name '*.recording' | wc -l) -eq 2 ]] || fail "not two recordings"

# Every step has what the status and the log said: vehicle 2 gave way.
"$FLEETCTL" replay "$crossing/vehicle-2.recording" --trace "$SCRATCH/2.tsv" >/dev/null
[[ $(awk -F'\t' '$9 == "give_way"' "$SCRATCH/2.tsv" | wc -l) -gt 20 ]] ||
  fail "the trace of vehicle 2 shows no giving way"

# The file of the killed vehicle has no end record; what it holds is intact.
record peer_dies
died=$SCRATCH/peer_dies
replayed "$died/vehicle-1.recording" "$same and .complete"
replayed "$died/vehicle-2.recording" "$same and (.complete | not)"
"$FLEETCTL" replay "$died"/*.recording || fail "peer_dies: exit code $?"

# malformed NAME COMMAND...: the file FILE as the command leaves it is refused with exit code 2.
malformed() {
  local name=$1 code=0
  shift
  cp "$crossing/vehicle-1.recording" "$SCRATCH/$name"
  (cd "$SCRATCH" && "$@")
  "$FLEETCTL" replay "$SCRATCH/$name" >"$SCRATCH/out" 2>&1 || code=$?
  cat "$SCRATCH/out"
  [[ $code -eq 2 ]] || fail "$name: exit code $code"
}
malformed empty truncate -s 0 empty
malformed no_mark dd if=/dev/zero of=no_mark bs=1 count=1 conv=notrunc status=none
malformed one_byte dd if=/dev/zero of=one_byte bs=1 seek=30000 count=5 conv=notrunc status=none
malformed other_format sed -i '1s/[0-9]*$/99/' other_format

# What a flag is not for is refused: with --json an MCAP file was served as a page until Ctrl-C.
refused() { # TEXT WORDS...
  local text=$1 code=0
  shift
  timeout 10 "$FLEETCTL" replay "$@" >"$SCRATCH/out" 2>&1 || code=$?
  { [[ $code -eq 2 ]] && grep -q -- "$text" "$SCRATCH/out"; } || fail "replay $*: exit code $code: $(cat "$SCRATCH/out")"
}
printf '\x89MCAP0\r\n' >"$SCRATCH/run.mcap"
refused 'leave out --json' "$SCRATCH/run.mcap" --json
refused 'leave out --json' "$SCRATCH/run.mcap" --trace "$SCRATCH/trace.tsv"
refused 'for a single MCAP file' "$crossing/vehicle-1.recording" --html "$SCRATCH/page.html"

[[ $failures -eq 0 ]]
