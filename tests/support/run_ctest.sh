# shellcheck shell=bash disable=SC2034,SC2154
# Runs tests by ctest and counts them, case by case: into `passed`, `failed`, `failed_names` and the file `said`
# of tests/run.sh, which sources it. Never run.

# An attribute of the first testsuite element of a JUnit file; 0 if there is none.
junit() {
  local value
  value=$(sed -n "s/^[[:space:]]*$2=\"\([0-9]*\)\".*/\1/p" "$1" 2>/dev/null | head -n 1)
  echo "${value:-0}"
}

# The part of ctest's output, read on stdin, that belongs to failed tests.
of_failed() {
  awk '/^ *[0-9]+\/[0-9]+ Test +#[0-9]+:/ {shown = /\*\*\*(Failed|Timeout|Exception|Not Run)/}
       /^ +Start +[0-9]+:/ {shown = 0}
       /tests passed, [0-9]+ tests? failed/ {shown = 0}
       shown'
}

# count_cases PRESET LABEL: cases that ran and cases that failed in the programs that run all their cases in
# one process, then the names of those that failed. A program that ended before it wrote its file is a failed
# test of ctest, which counts it.
count_cases() {
  local files
  mapfile -t files < <(find "$GIVEWAY_ROOT/build/$1/cases/$2" -name '*.xml' 2>/dev/null)
  [[ ${#files[@]} -gt 0 ]] || return 0
  awk '/<testsuites / {match($0, / tests="[0-9]+"/); ran += substr($0, RSTART + 8)
                       match($0, / failures="[0-9]+"/); bad += substr($0, RSTART + 11)}
       /<testcase / {match($0, / name="[^"]*"/); name = substr($0, RSTART + 7, RLENGTH - 8)
                     match($0, / classname="[^"]*"/)
                     name = substr($0, RSTART + 12, RLENGTH - 13) "." name}
       /<failure / && name != last {last = name; names = names name "\n"}
       END {print ran + 0, bad + 0; printf "%s", names}' "${files[@]}"
}

# run_ctest PRESET LABEL JOBS [CTEST_ARGUMENTS]
run_ctest() {
  local preset=$1 label=$2 jobs=$3 report code=0 ran bad bad_cases skipped names cases
  shift 3
  rm -rf "$GIVEWAY_ROOT/build/$preset/cases/$label"
  report="$GIVEWAY_ROOT/build/$preset/junit-$label.xml"
  rm -f "$report"
  ctest --test-dir "build/$preset" -L "^$label\$" -j "$jobs" --output-on-failure --no-tests=error \
    --output-junit "$report" "$@" | tee "$report.log" || code=$?
  of_failed <"$report.log" >>"$said"
  ran=$(junit "$report" tests)
  bad=$(junit "$report" failures)
  skipped=$(($(junit "$report" skipped) + $(junit "$report" disabled)))
  # No test at all, or tests that could not be run, are failures too.
  if [[ $code -ne 0 && $bad -eq 0 ]]; then
    bad=$((skipped > 0 ? skipped : 1))
    skipped=0
    ran=$((ran > bad ? ran : bad))
  fi
  mapfile -t cases < <(count_cases "$preset" "$label")
  if [[ ${#cases[@]} -gt 0 ]]; then
    read -r ran bad_cases <<<"${cases[0]}"
    # More programs than cases: some failed outside their cases, or left no file.
    bad=$((bad_cases > bad ? bad_cases : bad))
    ran=$((ran > bad ? ran : bad))
    failed_names+=("${cases[@]:1}")
  fi
  passed=$((passed + ran - bad - skipped))
  failed=$((failed + bad))
  # Programs that failed because of their cases need no line of their own.
  [[ ${bad_cases:-0} -eq 0 ]] || return 0
  mapfile -t names < <(sed -n "s|.*<testcase name=\"\([^\"]*\)\".* status=\"fail\".*|$preset/\1|p" "$report" 2>/dev/null)
  [[ $code -eq 0 || ${#names[@]} -gt 0 ]] || names=("$preset/$label: ctest's exit code $code")
  failed_names+=("${names[@]}")
}
