#!/usr/bin/env bash
# Adds one violation at a time to an otherwise clean tree: each must be reported, and nothing else.
set -euo pipefail
rules=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/include_rules.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0

# A fresh tree of valid files in most modules.
lay_out() {
  rm -rf "${tree:?}"/*
  put services/types/math/pose.h '#include <cstdint>'
  put services/vehicle/decision/decide.cc '#include "services/types/math/pose.h"'
  put services/vehicle/estimation/fit.cc '#include <Eigen/Core>'
  put services/link/topics.cc '#include <fastdds/dds/topic/Topic.hpp>'
  put services/link/convert/convert.cc '#include "fleet.h"'
  put sim_world/sensors/sonar_kernel.cc '#include <immintrin.h>'
  put services/qos/profile_check.cc '#include "services/types/math/pose.h"'
  put services/qos/xml_tree.cc '#include <tinyxml2.h>'
  put services/config/scenario_file.cc '#include <google/protobuf/text_format.h>'
  put services/health/health_server.cc '#include <httplib.h>'
  put services/fleetctl/main.cc '#include "services/link/fastdds/topics.h"'
  put services/fleetctl/replay/replay.cc '#include "services/vehicle/vehicle.h"'
  put services/fleetctl/tune/front.cc 'double error = std::hypot(x, y);'
  put services/fleetctl/process/child.h '#include "services/runtime/clock.h"'
  put services/vehicle_node/main.cc '#include "services/vehicle/vehicle.h"'
  put sim_world/world.cc '#include "services/types/math/pose.h"'
  put sim_world/virtual/fleet.cc '#include "services/vehicle/vehicle.h"'
  put services/world_node/main.cc '#include "services/runtime/clock.h"'
  put services/runtime/clock.h '#include <chrono>'
  put tests/unit/vehicle/decide_test.cc '#include "services/vehicle/decision/decide.h"'
  put tests/link/topics_test.cc '#include <thread>'
}

put() {
  mkdir -p "$(dirname "$tree/$1")"
  printf '%s\n' "$2" >"$tree/$1"
}

# expect_violation FILE LINE: LINE in FILE is one violation, and the report names the file.
expect_violation() {
  lay_out
  put "$1" "$2"
  local report code=0
  report=$(bash "$rules" "$tree") || code=$?
  if [[ $code -ne 1 || $report != *"$1: "* || $report != *" 1 violations" ]]; then
    printf 'not reported: %s in %s\n%s\n' "$2" "$1" "$report"
    failures=$((failures + 1))
  fi
}

lay_out
if ! bash "$rules" "$tree" >/dev/null; then
  echo "the clean tree is not clean:"
  bash "$rules" "$tree" || true
  exit 1
fi

expect_violation services/types/bad.h '#include "services/vehicle/decision/decide.h"'
expect_violation services/vehicle/bad.cc '#include "sim_world/world.h"'
expect_violation services/vehicle/bad.cc '#include "services/link/fastdds/topics.h"'
expect_violation services/vehicle/bad.cc '#  include  <mutex>'
expect_violation services/vehicle/bad.cc '#include <unistd.h>'
expect_violation services/vehicle/bad.cc 'auto now = std::chrono::steady_clock::now();'
expect_violation services/vehicle/bad.cc 'double y = std::sin(x);'
expect_violation services/fleetctl/virtual/bad.cc 'double y = low * std::exp(x);'
expect_violation services/qos/bad.cc '#include <tinyxml2.h>'
expect_violation services/qos/bad.cc '#include <fastdds/dds/topic/Topic.hpp>'
expect_violation services/qos/bad.cc '#include "services/link/fastdds/topics.h"'
expect_violation sim_world/bad.cc '#include "services/vehicle/decision/decide.h"'
expect_violation sim_world/bad.cc '#include "sim_world/virtual/fleet.h"'
expect_violation sim_world/bad.cc '#include <atomic>'
expect_violation sim_world/bad.cc '#include <spdlog/spdlog.h>'
expect_violation sim_world/virtual/bad.cc '#include <thread>'
expect_violation sim_world/virtual/bad.cc '#include "services/link/fastdds/topics.h"'
expect_violation services/link/bad.cc '#include "services/runtime/clock.h"'
expect_violation services/link/bad.cc '#include <spdlog/spdlog.h>'
expect_violation services/config/bad.cc '#include "services/link/fastdds/topics.h"'
expect_violation services/runtime/bad.cc '#include <fastdds/dds/topic/Topic.hpp>'
expect_violation services/health/bad.cc '#include <httplib.h>'
expect_violation services/fleetctl/bad.cc '#include <prometheus/registry.h>'
expect_violation services/fleetctl/bad.cc '#include <fastrtps/log/Log.h>'
expect_violation services/fleetctl/bad.cc '#include "sim_world/world.h"'
expect_violation services/link/bad.cc '#include <CLI/CLI.hpp>'
expect_violation services/vehicle_node/main.cc '#include "sim_world/world.h"'
expect_violation services/world_node/main.cc '#include "services/vehicle/decision/decide.h"'
expect_violation services/link/bad.cc 'const std::string text{std::istreambuf_iterator<char>(file), {}};'
expect_violation tests/unit/bad_test.cc 'std::this_thread::sleep_for(kLong);'
expect_violation services/runtime/string_utils.cc ''
expect_violation services/link/common.h ''
expect_violation services/link/peer_manager.cc ''
expect_violation services/types/long.h "$(yes '// line' | head -n 501)"
expect_violation services/link/helper/x.cc ''
expect_violation services/extra/x.cc ''
expect_violation services/report/bad.cc '#include <spdlog/spdlog.h>'
expect_violation services/runtime/bad.cc '#include "report.pb.h"'
expect_violation services/fleetctl/process/bad.cc '#include <CLI/CLI.hpp>'
expect_violation services/fleetctl/run/bad.cc '#include "services/fleetctl/tune/tune_plan.h"'
expect_violation services/vehicle/estimation/bad.cc '#include "services/vehicle/situation/peer_relation.h"'
expect_violation services/vehicle/situation/bad.cc '#include "services/vehicle/decision/decide.h"'
expect_violation sim_world/dynamics/bad.cc '#include <immintrin.h>'
expect_violation services/types/bad.h '#include "tests/unit/types/door.h"'

# expect_circle KIND FILE LINE [FILE LINE ...]: the lines together make one circle of that kind.
expect_circle() {
  local kind=$1 lines="$*" report code=0
  shift
  lay_out
  while [[ $# -gt 0 ]]; do
    put "$1" "$2"
    shift 2
  done
  report=$(bash "$rules" "$tree") || code=$?
  if [[ $code -ne 1 || $report != *"circle of ${kind}s: "* || $report != *" 1 violations" ]]; then
    printf 'no circle found: %s\n%s\n' "$lines" "$report"
    failures=$((failures + 1))
  fi
}
expect_circle file services/types/a.h '#include "services/types/b.h"' \
  services/types/b.cc '#include "services/types/a.h"'
expect_circle file services/link/a.cc '#include "services/link/b.h"' \
  services/link/b.h '#include "services/link/c.h"' services/link/c.h '#include "services/link/a.h"'

# A circle of modules needs a table with one: both arrows are allowed there.
lay_out
looped=$(mktemp -d)
cp "$(dirname "$rules")"/include_rules.{sh,awk} "$looped"
printf '%s\n' 'services/a | edge | services/b | - | a' 'services/b | edge | services/a | - | b' \
  >"$looped/modules.txt"
rm -rf "${tree:?}"/*
put services/a/x.h '#include "services/b/y.h"'
put services/b/z.h '#include "services/a/w.h"'
bash "$looped/include_rules.sh" "$tree" >"$looped/report" && failures=$((failures + 1))
if ! grep -q '^circle of modules: services/[ab]' "$looped/report"; then
  echo "no circle of modules found:"
  cat "$looped/report"
  failures=$((failures + 1))
fi
rm -rf "$looped"

# A folder of 41 sources is one violation.
lay_out
for i in $(seq 1 41); do put "services/report/part_$i.cc" ''; done
report=$(bash "$rules" "$tree") && failures=$((failures + 1))
if [[ $report != *"more than 40 sources"* || $report != *" 1 violations" ]]; then
  printf 'a full folder was not reported:\n%s\n' "$report"
  failures=$((failures + 1))
fi

[[ $failures -eq 0 ]]
