// The whole fleet in the text format of Prometheus: the families that each vehicle serves itself,
// here with a label `vehicle`, and histograms of beacon age and reaction. Pure.
#pragma once

#include <cstdint>
#include <string>

#include "services/observer/fleet/fleet_view.h"
#include "services/types/time.h"

namespace giveway {

// The observer itself.
struct ObserverHealth {
  std::uint64_t frames = 0;  // made so far
  int streams = 0;           // clients that follow now
  std::uint64_t refused_requests = 0;
  std::uint64_t refused_samples = 0;  // see Observed::refused
  double cpu_s = 0;
  double resident_bytes = 0;
  int foxglove_clients = 0;
  std::uint64_t foxglove_refused = 0;  // connections and messages of clients
};

std::string FleetMetrics(const FleetView& view, const ObserverHealth& observer, SteadyTime now);

}  // namespace giveway
