#!/usr/bin/env bash
# Which failed runs are repeated, and how often: reports as fleetctl writes them, and a stub fleetctl that
# fails so many times before it passes.
source "$(dirname "${BASH_SOURCE[0]}")/../support/fleet.sh"
cd "$SCRATCH"
mkdir logs
halted='halted: expected 2, got 1 2'

# report REASON CONTACTS LATE_TICKS ORDER_VIOLATIONS
report() {
  printf '{"reason":"%s","contacts":%d,"tick_overruns":%d,"violations":{"order":%d}}' "$@" >run.json
}
# log LATE_SCANS [WORDS]
log() { printf 'vehicle 1: link: ranges_skipped=%d x=0\n%s\n' "$1" "${2:-}" | sed 's/^/at /' >logs/vehicle-1.log; }
is() { excused run.json logs >/dev/null || fail "$1: not excused"; }
is_not() { ! excused run.json logs >/dev/null || fail "$1: excused"; }

log 0
report "$halted" 0 1 0 && is_not "nothing was late"
report "$halted" 0 2 0 && is "the world was late"
report "$halted" 1 9 0 && is_not "a contact"
report "$halted" 0 9 1 && is_not "an invariant"
report "$halted; arrived: expected 1 2, got 1" 0 9 0 && is_not "one did not arrive"
report "arrived: expected 1 2, got 1" 0 9 0 && is_not "another reason"
report "$halted" 0 0 0
log 2 && is "a vehicle was late"
log 2 'vehicle 1: impairment: packets=3' && is_not "its channel was impaired"
rm run.json && is_not "no report"

# Fails with the prepared report as long as there is something in ./failures.
FLEETCTL=$SCRATCH/fleetctl
cat >"$FLEETCTL" <<'TEXT'
#!/usr/bin/env bash
mkdir -p logs && echo 'at vehicle 1: link: ranges_skipped=0 x=0' >logs/vehicle-1.log
[[ -s failures ]] || exec echo '{"reason":"expectations_met","contacts":0}'
sed -i 1d failures
echo '{"reason":"halted: expected 2, got 1","contacts":0,"tick_overruns":9,"violations":{"order":0}}'
exit 1
TEXT
chmod +x "$FLEETCTL"
for times in 0 1 2 3; do
  seq "$times" >failures
  code=0
  judged_run run.json logs crossing 2>/dev/null || code=$?
  again=0
  [[ ! -e run.json.again ]] || again=$(wc -l <run.json.again)
  [[ $code -eq $((times == 3)) ]] || fail "$times failures: exit code $code"
  [[ $again -eq $((times < 3 ? times : 2)) ]] || fail "$times failures: repeated $again times"
done

[[ $failures -eq 0 ]]
