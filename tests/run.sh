#!/usr/bin/env bash
# Sets up, builds, runs the tests, and ends with a table and one line that counts them all.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../services/setup.sh"
source "$GIVEWAY_ROOT/tests/support/run_ctest.sh"
cd "$GIVEWAY_ROOT"

QUICK_STAGES=(format rules unit golden link crossing virtual)
# With --all, stages that run processes in real time go in order, and those that only compute in the
# background at idle priority, in two runs: the second needs the images, which are built meanwhile, for unit and
# golden are held to no time. The last stages run alone. asan and fuzz run in the container of asan13, asan_link
# in that of debian13. clang, dev and tidy are for --full.
FIRST_STAGES=(unit golden images)
THEN_STAGES=(link system attack manuals web containers debian13)
LAST_STAGES=(timed tsan)
BACKGROUND_STAGES=(format rules deploy tsan_build virtual defects model tidy_sample)
BACKGROUND_IMAGES_STAGES=(asan13)

# Seconds each stage may take on two quiet cores with warm caches. A target, not a failure: machines are
# shared.
declare -A BUDGET=([format]=20 [rules]=60 [tidy]=120 [tidy_sample]=60 [clang]=120 [deploy]=60 [unit]=60 [golden]=30 [link]=120 [crossing]=30
  [virtual]=150 [defects]=90 [model]=240 [system]=420 [timed]=240 [attack]=120 [manuals]=120 [web]=180 [tsan_build]=30 [tsan]=120
  [images]=60 [asan13]=180 [debian13]=330 [containers]=360 [asan]=180 [asan_link]=120 [fuzz]=120 [dev]=60)

usage() {
  cat <<'TEXT'
Usage: bash tests/run.sh [STAGE ...] [--all] [--full]

Without a stage: format, rules, unit, golden, link, one crossing and 20 seeds a generator, some
minutes. With --all, as CI: every stage but crossing, which is one of system, asan, asan_link
and fuzz, which asan13 and debian13 run in their container, and tidy, clang and dev, which are for
--full: tidy takes 20 minutes from nothing, and CI checks another thirtieth with each commit. What only
computes runs in the background, at idle priority. Stages:
  format   clang-format over every tracked source
  rules    include arrows, sizes, names, shell scripts, generation
  tidy     clang-tidy over the services and the world, with the checks of .clang-tidy
  tidy_sample
           the same over a thirtieth of the units, which the commit's hash chooses
  clang    every program compiled by clang without sanitizers; unit, and golden, whose hashes are the same
  deploy   the manifests of Kubernetes against its schemas and against each other
  unit     pure tests: no sockets, no clocks
  golden   hashes that must never change
  crossing one crossing of two real vehicles
  virtual  fleets of 2-50 in virtual time, 200 seeds a generator, judged by invariants
  defects  defects injected into the rules are detected by the invariants
  model    SPIN: the right of way of two and three vehicles, exhaustively
  link     Fast DDS between participants of one process
  system   real processes: crossings, kills, bad input
  timed    real processes held to times: stopwatch, tune, interrupt, health
  attack   an intruder on the network of a fleet that drives: forged, fuzzed and flooding; needs root
  manuals  every command that README.md and the manuals show
  web      the observer's page in a browser, its recordings in the field's own readers, its metrics in Prometheus
  asan     every program compiled by clang with the address and undefined-behaviour sanitizers; golden, and
           unit: the slow ones of fleets with --full
  asan_link link under the same
  fuzz     malformed scenarios, profiles, packets, beacons, scans and recordings in the asan build, a third of a minute each
  tsan_build, tsan
           what tsan needs is compiled; link and one crossing under the thread sanitizer
  dev      every file of the services compiled alone, with the includes it names, warned of hidden names
  images   the images that asan13, debian13 and containers need
  asan13   asan and fuzz on Debian 13 with Fast DDS 3.1
  debian13 asan_link and system tests on Debian 13, and a mixed fleet
  containers  images, composed fleets of two and eight, and what may happen to them; needs root

  --all    every stage
  --full   more repetitions of the system tests, the largest models, five minutes a fuzz target,
           10 000 seeds a generator (hours); with --all clang, dev and tidy too

The last line counts test cases: N passed, N failed.
TEXT
}

all=false
stages=()
export GIVEWAY_REPEATS=10 GIVEWAY_KILLS=2 GIVEWAY_FULL=false
seeds=''
fuzz_seconds=20
full=false
for argument in "$@"; do
  case $argument in
    --help | -h)
      usage
      exit 0
      ;;
    --full)
      GIVEWAY_REPEATS=50 GIVEWAY_KILLS=10 GIVEWAY_FULL=true
      fuzz_seconds=300 seeds=10000 full=true
      ;;
    all | --all) all=true ;;
    *)
      [[ -v BUDGET[$argument] ]] || die "unknown stage '$argument'; known: --all $(printf '%s\n' "${!BUDGET[@]}" | sort | xargs)"
      stages+=("$argument")
      ;;
  esac
done
if [[ ${#stages[@]} -eq 0 && $all == false ]]; then
  stages=("${QUICK_STAGES[@]}")
  seeds=${seeds:-20}
fi
seeds=${seeds:-200}

export GIVEWAY_FUZZ_SECONDS=${GIVEWAY_FUZZ_SECONDS:-$fuzz_seconds}

# In CI warnings are errors, and debug info is limited to what a sanitizer's stack trace needs: all of it is a
# fifth of the compile time.
configuration=()
[[ ${CI:-} == true ]] && configuration=(-DGIVEWAY_WERROR=ON "-DCMAKE_CXX_FLAGS_DEBUG=-g1"
  "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O2 -g0 -DNDEBUG")
# One cache for every checkout: files compiled in another folder are not compiled again.
export CCACHE_BASEDIR=$GIVEWAY_ROOT CCACHE_NOHASHDIR=1
# The library frees some objects with another size than it allocated them with.
export ASAN_OPTIONS=new_delete_type_mismatch=0:${ASAN_OPTIONS:-}
export UBSAN_OPTIONS=print_stacktrace=1:${UBSAN_OPTIONS:-}
export TSAN_OPTIONS=suppressions=$GIVEWAY_ROOT/tests/support/tsan.supp:${TSAN_OPTIONS:-}

passed_total=0
failed_total=0
table=()
failed_names=()
passed=0
failed=0
stage=set-up
said=$(mktemp) # what failed tests printed, said again at the end
background=()  # process and log of each run in the background
background_logs=()
engine=$(mktemp) # the process of the container engine, where a stage had to start one
images=''        # the process that builds the images, where it was started before their stage
images_log=$(mktemp)

# The end of every run, also of one that could not continue: then the stage it was in failed.
ending() {
  if [[ -n $stage ]]; then
    passed_total=$((passed_total + passed))
    failed_total=$((failed_total + failed + 1))
    failed_names+=("$stage: could not continue")
  fi
  if [[ -s $said ]]; then
    say "what failed tests printed"
    cat "$said"
  fi
  [[ ${#background[@]} -eq 0 ]] || kill -- "${background[@]/#/-}" 2>/dev/null || true
  [[ -z $images ]] || kill -- "-$images" 2>/dev/null || true
  [[ -z ${built13:-} ]] || docker volume rm -f "$built13" >/dev/null 2>&1 || true
  [[ ! -s $engine ]] || kill "$(<"$engine")" 2>/dev/null || true
  rm -f "$said" "$engine" "$images_log" "${background_logs[@]}"
  printf '\n%-10s %7s %7s %8s %8s\n' stage passed failed time budget
  printf '%s\n' "${table[@]}"
  [[ $failed_total -eq 0 ]] || printf 'failed: %s\n' "${failed_names[@]}"
  printf '\n%d passed, %d failed\n' "$passed_total" "$failed_total"
}
trap ending EXIT

# check NAME COMMAND...: one test case.
check() {
  local name=$1
  shift
  if "$@"; then
    passed=$((passed + 1))
    echo "ok      $name"
  else
    failed=$((failed + 1))
    failed_names+=("$name")
    echo "FAILED  $name"
  fi
}

# check_lines COMMAND...: a test case for each line "ok" or "FAILED" that the command prints, and as many as a
# line "N passed, N failed" of another run of tests counts, which lists them as "failed:". Lines that start
# with "| " say why something failed.
check_lines() {
  local lines code=0 good bad names
  lines=$("$@") || code=$?
  printf '%s\n' "$lines"
  grep '^| ' <<<"$lines" >>"$said" || true
  good=$(awk '/^ok /{n++} /^[0-9]+ passed, [0-9]+ failed$/{n += $1} END{print n + 0}' <<<"$lines")
  bad=$(awk '/^FAILED /{n++} /^[0-9]+ passed, [0-9]+ failed$/{n += $3} END{print n + 0}' <<<"$lines")
  mapfile -t names < <(sed -n 's/^FAILED  *//p; s/^failed: //p' <<<"$lines")
  if [[ $code -ne 0 && $bad -eq 0 ]]; then
    bad=1
    names=("$*: exit code $code")
  fi
  passed=$((passed + good))
  failed=$((failed + bad))
  failed_names+=("${names[@]}")
}

# note_time STAGE SECONDS: its line of the table, with a warning if it exceeded its budget.
note_time() {
  local over=''
  if [[ $2 -gt ${BUDGET[$1]} ]]; then
    over='  OVER'
    say "stage $1 took $2 s; its budget is ${BUDGET[$1]} s"
  fi
  table+=("$(printf '%-10s %7d %7d %6d s %6d s%s' "$1" "$passed" "$failed" "$2" "${BUDGET[$1]}" "$over")")
}

# prepare PRESET [TARGETS]
prepare() {
  configure "$1" "${configuration[@]}"
  build "$@"
}

stage_format() {
  mapfile -t sources < <(git ls-files '*.h' '*.cc')
  check "formatting of ${#sources[@]} files" clang-format --dry-run -Werror "${sources[@]}"
}

stage_rules() {
  mapfile -t scripts < <(git ls-files '*.sh' .ci/run)
  check "include rules" bash tests/rules/include_rules.sh
  check "include rules find each violation" bash tests/rules/include_rules_test.sh
  check "the table of modules in services/README.md" bash tests/rules/modules_table.sh --check
  check "lengths and links of the manuals" bash tests/rules/manuals.sh
  check "the rules over manuals find each violation" bash tests/rules/manuals_test.sh
  check "commands of manuals are run or checked" bash tests/manuals/commands_test.sh
  check "words of the vocabulary" bash tests/rules/words.sh
  check "words are counted where people read them" bash tests/rules/words_test.sh
  check "known vulnerabilities against the installed packages" bash tests/rules/exposure.sh
  check "the check of vulnerabilities finds each contradiction" bash tests/rules/exposure_test.sh
  check "empty reports and late machines are judged as they should be" bash tests/rules/support_test.sh
  check "shell scripts" shellcheck "${scripts[@]}"
  check "the wire types are generated next to another user's" bash tests/rules/generate_test.sh
}

# A thirtieth costs CI a minute; commit by commit, all are checked.
stage_tidy_sample() {
  local hash
  hash=$(git rev-parse --short=6 HEAD)
  check "clang-tidy over a thirtieth of the services and the world" bash tests/tidy/tidy.sh --sample "$((16#${hash:0:6} % 30))"
  tidy_test
}
stage_tidy() {
  check "clang-tidy over the services and the world" bash tests/tidy/tidy.sh
  tidy_test
}
tidy_test() {
  check "injected defects are findings; what passed is not checked again" bash tests/tidy/tidy_test.sh
}

stage_clang() {
  prepare clang unit_tests golden_tests giveway-bench giveway-observer giveway-vehicle giveway-world fleetctl
  run_ctest clang unit "$(nproc)"
  run_ctest clang golden "$(nproc)"
}

# Kubernetes' schemas come as an npm package; compose needs no engine to print what it reads.
deploy_packages() { node_packages && printf '%s\n' prometheus jq docker-compose; }
stage_deploy() {
  mapfile -t wanted < <(deploy_packages)
  install_packages "${wanted[@]}"
  check_lines bash tests/deploy/kubernetes.sh
  check_lines bash tests/deploy/kubernetes_test.sh
  check_lines bash tests/deploy/monitoring.sh
  check_lines bash tests/deploy/compose.sh
}

stage_unit() { prepare release unit_tests && run_ctest release unit "$(nproc)"; }
stage_golden() { prepare release golden_tests && run_ctest release golden "$(nproc)"; }
stage_crossing() {
  prepare release giveway-vehicle giveway-world fleetctl
  check "a crossing of two vehicles" env GIVEWAY_BIN_DIR="$GIVEWAY_ROOT/build/release/bin" \
    bash tests/system/crossing.sh intersection_yield
}
# Twelve cells: contacts / other invariants broken / arrived.
mixed_fleets() {
  local printed
  printed=$(bash tests/virtual/table.sh 1 swarm parking) && printf '%s\n' "$printed" &&
    [[ $(grep -oE ' 0 / [0-9]+ / 8 ' <<<"$printed" | wc -l) -eq 12 ]]
}
stage_virtual() {
  prepare release fleetctl
  for generator in crossing roundabout corridor swarm merge convoy warehouse; do
    check "$seeds seeds of $generator" \
      bash tests/virtual/campaign.sh --generators "$generator" --seeds "$seeds"
  done
  check "mixed fleets of eight arrive without contact" mixed_fleets
  check "fleets spend their time as recorded" bash tests/virtual/bounds.sh
}
stage_defects() {
  prepare release fleetctl fleetctl_with_defects && check_lines bash tests/virtual/defects.sh
  $full || return 0
  prepare release fleetctl_mutants
  check "defects chosen at random are detected" bash tests/virtual/mutants.sh --least 29
}

stage_model() {
  prepare release fleetctl
  run_ctest release model "$(nproc)"
  if $full; then run_ctest release model_full 1; fi
}

stage_link() { prepare release link_tests && run_ctest release link 4; }
stage_system() { prepare release && run_ctest release system 5; }
stage_timed() { prepare release && run_ctest release timed 1; }
stage_manuals() {
  prepare release giveway-observer giveway-vehicle giveway-world fleetctl
  check_lines bash tests/manuals/commands.sh
}

# The first has a network of its own; the other two share the loopback, in domains of their own.
stage_attack() {
  prepare release giveway-vehicle giveway-world fleetctl attacker speak_attacker
  local attacks=(env GIVEWAY_BIN_DIR="$GIVEWAY_ROOT/build/release/bin" bash)
  check_lines "${attacks[@]}" tests/attack/attack.sh
  check_lines parallel --will-cite "${attacks[@]}" ::: tests/attack/speak.sh tests/attack/admin_key.sh
}

# By clang, which compiles a unit with sanitizers in half of g++'s time: so every program passes its warnings,
# and golden compares its hashes with g++'s. With --full alone, for they take half of the time: fleets in many
# situations, of the same code that golden drives fleets of, the baselines, and single cases of many seconds.
stage_asan() {
  local slow='VirtualBatch.*:Scenarios/*:ComparedSoaks.*:ResourcesOverTime.*:PlaceRules.AFullFleetOnOneSpot*'
  local units
  configure asan "${configuration[@]}"
  mapfile -t units < <(ctest --test-dir build/asan -N -L '^unit$' | sed -n 's/^ *Test *#[0-9]*: //p' |
    { if $full; then cat; else grep -vxE 'unit_(baseline|vehicle_in_world|virtual)'; fi; })
  [[ ${#units[@]} -gt 0 ]] || die "no unit test in build/asan"
  build asan "${units[@]}" golden_tests link_tests giveway-observer giveway-vehicle giveway-world fleetctl
  ! $full || slow=''
  GTEST_FILTER="*-$slow" run_ctest asan unit "$(nproc)" -R "^($(IFS='|' && echo "${units[*]}"))\$"
  run_ctest asan golden "$(nproc)"
}

# Participants wait more than they compute, under a sanitizer too.
stage_asan_link() { prepare asan link_tests && run_ctest asan link 3; }

stage_fuzz() { prepare asan fuzz_tests && run_ctest asan fuzz "$(nproc)"; }

# The services are under test; the fleetctl that starts them is the release's.
tsan_crossing() {
  local programs="$GIVEWAY_ROOT/build/tsan/watched/bin"
  mkdir -p "$programs"
  ln -sf "$GIVEWAY_ROOT"/build/tsan/bin/giveway-{vehicle,world} "$programs"
  cp "$GIVEWAY_ROOT/build/release/bin/fleetctl" "$programs"
  GIVEWAY_CONFIG_DIR="$GIVEWAY_ROOT/config" GIVEWAY_BIN_DIR="$programs" \
    bash tests/system/crossing.sh intersection_yield
}

stage_dev() {
  prepare dev link_tests giveway-vehicle giveway-world
  check "every file of the services compiles alone" true
}

stage_tsan_build() { prepare tsan link_tests giveway-vehicle giveway-world; }
stage_tsan() {
  prepare release fleetctl
  stage_tsan_build
  run_ctest tsan link 3
  check "a crossing under the thread sanitizer" tsan_crossing
}

start_images() {
  set -m # a process group of its own, so that it can be ended
  GIVEWAY_ENGINE_FILE=$engine bash tests/containers/all.sh images >"$images_log" 2>&1 </dev/null &
  set +m
  images=$!
}
# Its time is what is left of it.
stage_images() {
  local code=0
  [[ -n $images ]] || start_images
  wait "$images" || code=$?
  images=''
  check_lines said_by_images "$code"
}
said_by_images() { cat "$images_log" && return "$1"; }
stage_asan13() { check_lines bash tests/containers/all.sh asan13; }
stage_debian13() {
  prepare release giveway-vehicle giveway-world
  check_lines bash tests/containers/all.sh debian13
}
stage_web() {
  mapfile -t wanted < <(web_packages && deploy_packages && echo curl)
  install_packages "${wanted[@]}"
  prepare release giveway-observer giveway-vehicle giveway-world fleetctl
  check_lines bash tests/web/web.sh
  check_lines env GIVEWAY_BIN_DIR="$GIVEWAY_ROOT/build/release/bin" bash tests/web/scrape.sh
}
stage_containers() { check_lines bash tests/containers/all.sh containers; }

run_stages() {
  local started
  for stage in "$@"; do
    say "stage $stage"
    passed=0 failed=0 started=$SECONDS
    "stage_$stage"
    passed_total=$((passed_total + passed))
    failed_total=$((failed_total + failed))
    note_time "$stage" $((SECONDS - started))
  done
}

# start_background STAGE...: another run of this script, which gets only the processor time that other
# processes leave. In a session of its own: the kernel shares the processor between sessions first.
start_background() {
  local log words=("$@")
  log=$(mktemp)
  [[ $full == false ]] || words+=(--full)
  # shellcheck disable=SC2016 # the variables of that shell
  setsid bash -c '{ echo 19 >/proc/self/autogroup; } 2>/dev/null || true; exec chrt --idle 0 bash "$@"' bash \
    tests/run.sh "${words[@]}" >"$log" 2>&1 </dev/null &
  background+=($!)
  background_logs+=("$log")
}

# Waits for the runs in the background, prints what they printed, and counts their cases as one stage's.
join_background() {
  local log
  stage=background passed=0 failed=0
  say "the stages in the background"
  for log in "${background_logs[@]}"; do
    wait "${background[0]}" || true
    background=("${background[@]:1}")
    cat "$log"
    check_lines of_run "$log"
    mapfile -t -O "${#table[@]}" table < <(sed -nE 's/^([a-z0-9_]+ +[0-9]+ +[0-9]+ +[0-9]+ s) +[0-9]+ s.*/\1     idle/p' "$log")
    sed -n '/^== what failed tests printed$/,/^stage  *passed/{//!p}' "$log" >>"$said"
  done
  passed_total=$((passed_total + passed))
  failed_total=$((failed_total + failed))
}

# The count at the end of another run's log, and the names of what failed: behind its last table, for the runs within
# containers have tables of their own in it.
of_run() {
  local last
  last=$(tac "$1" | sed '/^stage  *passed/q')
  grep -E '^[0-9]+ passed, [0-9]+ failed$' <<<"$last" || echo "FAILED  a run in the background, which has no count"
  grep '^failed: ' <<<"$last" || true
}

# The packages of deploy now and not in the background: an installer at idle priority would block others.
mapfile -t packages < <(build_packages && test_packages && java_package && { ! $all || deploy_packages; })
install_packages "${packages[@]}"
check_java

if $all; then
  # The build folder that asan13 and debian13 share.
  export GIVEWAY_RUN=$EPOCHSECONDS-$$
  built13=giveway-build13-$GIVEWAY_RUN
  start_background "${BACKGROUND_STAGES[@]}"
  start_images
  run_stages "${FIRST_STAGES[@]}"
  ! $full || run_stages dev tidy clang
  start_background "${BACKGROUND_IMAGES_STAGES[@]}"
  run_stages "${THEN_STAGES[@]}"
  join_background
  run_stages "${LAST_STAGES[@]}"
fi
run_stages "${stages[@]}"

stage=
[[ $failed_total -eq 0 && $passed_total -gt 0 ]]
