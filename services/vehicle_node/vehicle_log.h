// What a vehicle's loop logs about its peers: which join and leave, what of theirs is refused, and
// whose beacons are fresh enough to decide by. Each once, when it changes.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/runtime/packet_log.h"
#include "services/runtime/refusal_log.h"
#include "services/types/refusal.h"
#include "services/types/vehicle_io.h"
#include "services/types/vehicle_options.h"
#include "services/vehicle/vehicle.h"
#include "services/vehicle_node/beacon_news.h"

namespace giveway {

class VehicleLog {
 public:
  // What the link could not read, and endpoints that will never match.
  void TellOfLink(std::span<const Refusal> refusals, const std::vector<std::string>& unfit,
                  SteadyTime now);
  // What was dropped of the packets that reached this process.
  void TellOfPackets(const PacketCounters& packets, SteadyTime now);
  // What the middleware says of the peers. Joining and leaving is info, the rest a warning; a lost
  // beacon is neither on a radio, and would be logged many times a second.
  void TellOfEvents(std::span<const QosEvent> events, const Vehicle& vehicle);
  // What the brain refused of these. What is broken or misnamed the link has said, and knows more
  // of it.
  void TellOfRefusals(std::span<const ReceivedBeacon> beacons, const Vehicle& vehicle,
                      SteadyTime now);
  // Which peers' beacons became fresh or stale. `now` is the brain's time.
  void TellOfBeacons(const Vehicle& vehicle, const VehicleOptions& options, SteadyTime now,
                     SteadyTime woke);
  // Once, when it is known.
  void TellOfBlackouts(const std::optional<SteadyTime>& since);

 private:
  BeaconNews beacon_news_;
  RefusalLog refusal_log_;
  PacketLog packet_log_;
  bool told_blackouts_ = false;
};

}  // namespace giveway
