#!/usr/bin/env bash
# check.sh fails when SPIN finds nothing where it must find something, and vice versa.
# Usage: verdict_test.sh FOLDER
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
copy=$1/model
rm -rf "$1"
mkdir -p "$copy"
cp "$here"/*.{pml,sh,awk} "$copy"
cat >"$copy/runs.txt" <<'TEXT'
a_defect_that_is_none      always safety order     -DN=2 -DONCE -DEVEN
no_cycle_where_one_is_due  always passes passes    -DN=2 -DONCE -DEVEN
a_broken_model             always safety holds     -DN=2 -DONCE -DEVEN -DPRIORITY_REVERSED
the_wrong_property         always safety exclusion -DN=2 -DONCE -DEVEN -DPRIORITY_REVERSED
a_model_that_halts_at_once always passes holds     -DN=2 -DONCE -DEVEN -DOWN_BEACON_HEARD
TEXT

# fails_with FOLDER NAME CODE
failed=0
fails_with() {
  local code=0
  bash "$copy/check.sh" "$2" "$1/$2" >"$copy/$2.log" 2>&1 || code=$?
  if [[ $code -ne $3 ]]; then
    printf 'FAILED: %s: exit code %d, not %d\n' "$2" "$code" "$3"
    cat "$copy/$2.log"
    failed=1
  fi
}
while read -r name _; do
  fails_with "$1" "$name" 1
done <"$copy/runs.txt"
fails_with "$1" no_such_run 2
exit "$failed"
