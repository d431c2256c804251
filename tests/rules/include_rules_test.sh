#!/usr/bin/env bash
# Plants one violation at a time in an otherwise clean tree: each must be caught, and nothing else.
set -euo pipefail
rules=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/include_rules.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0

# Fresh, clean, one file in every room.
lay_out() {
  rm -rf "${tree:?}"/*
  plant services/types/pose.h '#include <cstdint>'
  plant services/vehicle/decide.cc '#include "services/types/pose.h"'
  plant services/vehicle/fit.cc '#include <Eigen/Core>'
  plant services/link/topics.cc '#include <fastdds/dds/topic/Topic.hpp>'
  plant services/link/convert.cc '#include "fleet.h"'
  plant services/qos/check.cc '#include "services/types/pose.h"'
  plant services/qos/xml_tree.cc '#include <tinyxml2.h>'
  plant services/app/scenario.cc '#include <google/protobuf/text_format.h>'
  plant services/app/health_server.cc '#include <httplib.h>'
  plant services/fleetctl/main.cc '#include "services/link/topics.h"'
  plant services/fleetctl/replay.cc '#include "services/vehicle/vehicle.h"'
  plant services/vehicle_main.cc '#include "services/vehicle/decide.h"'
  plant sim_world/world.cc '#include "services/types/pose.h"'
  plant sim_world/virtual/fleet.cc '#include "services/vehicle/decide.h"'
  plant sim_world/world_main.cc '#include "services/app/tick.h"'
  plant tests/unit/decide_test.cc '#include "services/vehicle/decide.h"'
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

expect_caught services/types/bad.h '#include "services/vehicle/decide.h"'
expect_caught services/vehicle/bad.cc '#include "sim_world/world.h"'
expect_caught services/vehicle/bad.cc '#include "services/link/topics.h"'
expect_caught services/vehicle/bad.cc '#  include  <mutex>'
expect_caught services/vehicle/bad.cc '#include <unistd.h>'
expect_caught services/vehicle/bad.cc 'auto now = std::chrono::steady_clock::now();'
expect_caught services/vehicle/bad.cc 'double y = std::sin(x);'
expect_caught services/qos/bad.cc '#include <tinyxml2.h>'
expect_caught services/qos/bad.cc '#include <fastdds/dds/topic/Topic.hpp>'
expect_caught services/qos/bad.cc '#include "services/link/topics.h"'
expect_caught sim_world/bad.cc '#include "services/vehicle/decide.h"'
expect_caught sim_world/bad.cc '#include "sim_world/virtual/fleet.h"'
expect_caught sim_world/bad.cc '#include <atomic>'
expect_caught sim_world/bad.cc '#include <spdlog/spdlog.h>'
expect_caught sim_world/virtual/bad.cc '#include <thread>'
expect_caught sim_world/virtual/bad.cc '#include "services/link/topics.h"'
expect_caught services/link/bad.cc '#include "services/app/tick.h"'
expect_caught services/link/bad.cc '#include <spdlog/spdlog.h>'
expect_caught services/app/bad.cc '#include "services/link/topics.h"'
expect_caught services/app/bad.cc '#include <fastdds/dds/topic/Topic.hpp>'
expect_caught services/app/bad.cc '#include <httplib.h>'
expect_caught services/fleetctl/bad.cc '#include <prometheus/registry.h>'
expect_caught services/fleetctl/bad.cc '#include <fastrtps/log/Log.h>'
expect_caught services/fleetctl/bad.cc '#include "sim_world/world.h"'
expect_caught services/link/bad.cc '#include <CLI/CLI.hpp>'
expect_caught services/vehicle_main.cc '#include "sim_world/world.h"'
expect_caught sim_world/world_main.cc '#include "services/vehicle/decide.h"'
expect_caught tests/unit/bad_test.cc 'std::this_thread::sleep_for(kLong);'
expect_caught services/app/string_utils.cc ''
expect_caught services/link/common.h ''
expect_caught services/link/peer_manager.cc ''
expect_caught services/types/long.h "$(yes '// line' | head -n 501)"
expect_caught services/link/helper/x.cc ''
expect_caught services/extra/x.cc ''

[[ $failures -eq 0 ]]
