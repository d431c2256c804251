// What a vehicle's loop logs about its peers: which join and leave, what of theirs is refused, and
// whose beacons are fresh enough to decide by. Each once, when it changes.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/runtime/line_budget.h"
#include "services/runtime/packet_log.h"
#include "services/runtime/refusal_log.h"
#include "services/types/refusal.h"
#include "services/types/vehicle_io.h"
#include "services/types/vehicle_options.h"
#include "services/vehicle/vehicle.h"
#include "services/vehicle_node/beacon_freshness.h"

namespace giveway {

class VehicleLog {
 public:
  // What the link could not read, and endpoints that will never match.
  void LogLink(std::span<const Refusal> refusals, const std::vector<std::string>& unfit,
               SteadyTime now);
  // What was dropped of the packets that reached this process.
  void LogPackets(const PacketCounters& packets, SteadyTime now);
  // What the middleware says of the peers. Joining and leaving is info, the rest a warning; a lost
  // beacon is neither on a radio, and would be logged many times a second. So many lines a second:
  // one participant may have any number of writers.
  void LogEvents(std::span<const QosEvent> events, const Vehicle& vehicle, SteadyTime now);
  // What the brain refused of these. What is broken or misnamed the link has said, and knows more
  // of it.
  void LogRefusals(std::span<const ReceivedBeacon> beacons, const Vehicle& vehicle, SteadyTime now);
  // Which peers' beacons became fresh or stale. `now` is the brain's time.
  void LogFreshness(const Vehicle& vehicle, const VehicleOptions& options, SteadyTime now,
                    SteadyTime woke);
  // Once, when it is known.
  void LogBlackouts(const std::optional<SteadyTime>& since);

 private:
  BeaconFreshnessMonitor beacon_freshness_;
  RefusalLog refusal_log_;
  PacketLog packet_log_;
  LineBudget event_lines_{256};  // all that a fleet of as many says when it starts
  bool logged_blackouts_ = false;
};

}  // namespace giveway
