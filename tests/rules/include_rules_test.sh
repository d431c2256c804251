#!/usr/bin/env bash
# Plants one violation at a time in an otherwise clean tree: each must be caught, and nothing else.
set -euo pipefail
rules=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/include_rules.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0

# Fresh, clean, files in most modules.
lay_out() {
  rm -rf "${tree:?}"/*
  plant services/types/math/pose.h '#include <cstdint>'
  plant services/vehicle/decision/decide.cc '#include "services/types/math/pose.h"'
  plant services/vehicle/estimation/fit.cc '#include <Eigen/Core>'
  plant services/link/topics.cc '#include <fastdds/dds/topic/Topic.hpp>'
  plant services/link/convert/convert.cc '#include "fleet.h"'
  plant sim_world/sensors/sonar_kernel.cc '#include <immintrin.h>'
  plant services/qos/check.cc '#include "services/types/math/pose.h"'
  plant services/qos/xml_tree.cc '#include <tinyxml2.h>'
  plant services/config/scenario_file.cc '#include <google/protobuf/text_format.h>'
  plant services/health/health_server.cc '#include <httplib.h>'
  plant services/fleetctl/main.cc '#include "services/link/fastdds/topics.h"'
  plant services/fleetctl/replay/replay.cc '#include "services/vehicle/vehicle.h"'
  plant services/fleetctl/process/child.h '#include "services/runtime/clock.h"'
  plant services/vehicle_node/main.cc '#include "services/vehicle/vehicle.h"'
  plant sim_world/world.cc '#include "services/types/math/pose.h"'
  plant sim_world/virtual/fleet.cc '#include "services/vehicle/vehicle.h"'
  plant services/world_node/main.cc '#include "services/runtime/clock.h"'
  plant services/runtime/clock.h '#include <chrono>'
  plant tests/unit/vehicle/decide_test.cc '#include "services/vehicle/decision/decide.h"'
  plant tests/link/topics_test.cc '#include <thread>'
}

plant() {
  mkdir -p "$(dirname "$tree/$1")"
  printf '%s\n' "$2" >"$tree/$1"
}

# expect_caught FILE LINE: planting LINE in FILE is one violation, and the report names the file.
expect_caught() {
  lay_out
  plant "$1" "$2"
  local report code=0
  report=$(bash "$rules" "$tree") || code=$?
  if [[ $code -ne 1 || $report != *"$1: "* || $report != *" 1 violations" ]]; then
    printf 'not caught: %s in %s\n%s\n' "$2" "$1" "$report"
    failures=$((failures + 1))
  fi
}

lay_out
if ! bash "$rules" "$tree" >/dev/null; then
  echo "the clean tree is not clean:"
  bash "$rules" "$tree" || true
  exit 1
fi

expect_caught services/types/bad.h '#include "services/vehicle/decision/decide.h"'
expect_caught services/vehicle/bad.cc '#include "sim_world/world.h"'
expect_caught services/vehicle/bad.cc '#include "services/link/fastdds/topics.h"'
expect_caught services/vehicle/bad.cc '#  include  <mutex>'
expect_caught services/vehicle/bad.cc '#include <unistd.h>'
expect_caught services/vehicle/bad.cc 'auto now = std::chrono::steady_clock::now();'
expect_caught services/vehicle/bad.cc 'double y = std::sin(x);'
expect_caught services/qos/bad.cc '#include <tinyxml2.h>'
expect_caught services/qos/bad.cc '#include <fastdds/dds/topic/Topic.hpp>'
expect_caught services/qos/bad.cc '#include "services/link/fastdds/topics.h"'
expect_caught sim_world/bad.cc '#include "services/vehicle/decision/decide.h"'
expect_caught sim_world/bad.cc '#include "sim_world/virtual/fleet.h"'
expect_caught sim_world/bad.cc '#include <atomic>'
expect_caught sim_world/bad.cc '#include <spdlog/spdlog.h>'
expect_caught sim_world/virtual/bad.cc '#include <thread>'
expect_caught sim_world/virtual/bad.cc '#include "services/link/fastdds/topics.h"'
expect_caught services/link/bad.cc '#include "services/runtime/clock.h"'
expect_caught services/link/bad.cc '#include <spdlog/spdlog.h>'
expect_caught services/config/bad.cc '#include "services/link/fastdds/topics.h"'
expect_caught services/runtime/bad.cc '#include <fastdds/dds/topic/Topic.hpp>'
expect_caught services/health/bad.cc '#include <httplib.h>'
expect_caught services/fleetctl/bad.cc '#include <prometheus/registry.h>'
expect_caught services/fleetctl/bad.cc '#include <fastrtps/log/Log.h>'
expect_caught services/fleetctl/bad.cc '#include "sim_world/world.h"'
expect_caught services/link/bad.cc '#include <CLI/CLI.hpp>'
expect_caught services/vehicle_node/main.cc '#include "sim_world/world.h"'
expect_caught services/world_node/main.cc '#include "services/vehicle/decision/decide.h"'
expect_caught tests/unit/bad_test.cc 'std::this_thread::sleep_for(kLong);'
expect_caught services/runtime/string_utils.cc ''
expect_caught services/link/common.h ''
expect_caught services/link/peer_manager.cc ''
expect_caught services/types/long.h "$(yes '// line' | head -n 501)"
expect_caught services/link/helper/x.cc ''
expect_caught services/extra/x.cc ''
expect_caught services/report/bad.cc '#include <spdlog/spdlog.h>'
expect_caught services/runtime/bad.cc '#include "report.pb.h"'
expect_caught services/fleetctl/process/bad.cc '#include <CLI/CLI.hpp>'
expect_caught services/fleetctl/run/bad.cc '#include "services/fleetctl/tune/tune_plan.h"'
expect_caught services/vehicle/estimation/bad.cc '#include "services/vehicle/situation/look.h"'
expect_caught services/vehicle/situation/bad.cc '#include "services/vehicle/decision/decide.h"'
expect_caught sim_world/dynamics/bad.cc '#include <immintrin.h>'
expect_caught services/types/bad.h '#include "tests/unit/types/door.h"'

# expect_circle KIND FILE LINE [FILE LINE ...]: the lines planted together are one circle of that kind.
expect_circle() {
  local kind=$1 planted="$*" report code=0
  shift
  lay_out
  while [[ $# -gt 0 ]]; do
    plant "$1" "$2"
    shift 2
  done
  report=$(bash "$rules" "$tree") || code=$?
  if [[ $code -ne 1 || $report != *"circle of ${kind}s: "* || $report != *" 1 violations" ]]; then
    printf 'no circle found: %s\n%s\n' "$planted" "$report"
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
plant services/a/x.h '#include "services/b/y.h"'
plant services/b/z.h '#include "services/a/w.h"'
bash "$looped/include_rules.sh" "$tree" >"$looped/report" && failures=$((failures + 1))
if ! grep -q '^circle of modules: services/[ab]' "$looped/report"; then
  echo "no circle of modules found:"
  cat "$looped/report"
  failures=$((failures + 1))
fi
rm -rf "$looped"

# A folder of 41 sources is one violation.
lay_out
for i in $(seq 1 41); do plant "services/report/part_$i.cc" ''; done
report=$(bash "$rules" "$tree") && failures=$((failures + 1))
if [[ $report != *"more than 40 sources"* || $report != *" 1 violations" ]]; then
  printf 'a full folder was not caught:\n%s\n' "$report"
  failures=$((failures + 1))
fi

[[ $failures -eq 0 ]]
