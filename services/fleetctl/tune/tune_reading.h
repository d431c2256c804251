// What a vehicle's recording shows of QoS: replays its inputs through a new brain, and checks at
// each step which peers it trusts (vehicle/peer_table.h, IsFresh). So an alarm is what the vehicle
// acted on, at the time it did. Pure except for the stream it reads.
#pragma once

#include <cstdint>
#include <istream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/tune/tune_evidence.h"
#include "services/types/ids.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

// All times are on the machine's steady clock.
struct AliveWindow {
  SteadyTime from{0};  // all receive all
  SteadyTime to{0};    // just before the first is killed
};

// Since when a peer was not trusted at the recording's end, and the mechanism that reported it.
struct Silenced {
  SteadyTime at{0};
  AlarmCause cause = AlarmCause::kDeadline;
};

struct VehicleReading {
  std::string trouble;  // why it could not be read; empty if it could
  VehicleId vehicle = kNoVehicle;
  SteadyTime last_step{0};  // the last beacon it sent
  AlarmCounts alarms;       // within the window
  std::uint32_t reported_deadline = 0;
  std::uint32_t reported_liveliness = 0;
  std::vector<std::uint64_t> ages;  // beacons at a decision, by age in ticks; in the window
  Nanoseconds longest_pause{0};     // between two steps, from the window on
  std::map<VehicleId, std::optional<Silenced>> peers;  // nullopt: trusted to the end
};

VehicleReading ReadVehicle(std::istream* recording, const AliveWindow& window);

struct Killing {
  VehicleId target = kNoVehicle;
  SteadyTime at{0};
};

// Combines the readings of all vehicles. A peer that did not trust the target when it was killed,
// because of a false alarm, says nothing about its detection.
void FoldReadings(const std::vector<VehicleReading>& readings, const std::vector<Killing>& killings,
                  Nanoseconds tick, TrialEvidence* evidence);

}  // namespace giveway::fleetctl
