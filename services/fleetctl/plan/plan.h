// What a fleet of N vehicles takes from its hosts, computed before it is started. Pure: from the
// costs measured by tests/bench/fleet_costs.sh, the request and the QoS profile set. Hosts are
// alike; one of them also runs the world and its observers. All receive all, whatever the
// scenario's emission radius: the samples arrive, and the brain ignores those from too far.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/qos/profile_check.h"

namespace giveway::fleetctl {

struct PlanRequest {
  std::uint32_t vehicles = 2;
  std::uint32_t hosts = 1;
  bool containers = false;    // every process has a network, and so ports, of its own
  double cores = 0;           // a host
  double memory_mib = 0;      // a host
  double link_mbit_s = 1000;  // between two hosts
  std::int64_t tick_ns = 50'000'000;
  qos::ProfileFile set;   // of every process
  int library_major = 2;  // of the Fast DDS of every process
};

// One row: of a vehicle, of the busiest host, of the fleet; and what the host has. Some are absent.
struct PlanRow {
  std::string name;  // with its unit
  std::optional<double> vehicle;
  std::optional<double> host;
  std::optional<double> fleet;
  std::optional<double> limit;  // of a host
};

struct PlanReport {
  std::vector<PlanRow> rows;
  qos::Findings findings;  // errors refuse the fleet
  // What would fit, if this does not; absent if no change of that one value does.
  std::optional<std::uint32_t> fewer_vehicles;
  std::optional<std::uint32_t> more_hosts;

  bool Fits() const;
};

PlanReport Plan(const PlanRequest& request);

std::string ToText(const PlanRequest& request, const PlanReport& report);
std::string ToJson(const PlanRequest& request, const PlanReport& report);

}  // namespace giveway::fleetctl
