// The results of a stopwatch's trials: for each fault and mechanism how soon it was seen, and
// whether that is what the profile promises. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "services/fleetctl/stopwatch/stopwatch_table.h"
#include "services/types/ids.h"

namespace giveway::fleetctl {

// One peer saw one fault through one mechanism.
struct Sighting {
  Mechanism mechanism = Mechanism::kBeaconAge;
  Nanoseconds after{0};  // the fault
  Nanoseconds pause{0};  // the machine's longest, from a beacon period before the fault until then
};

// One fault of one vehicle.
struct Trial {
  Fault fault = Fault::kKill;
  std::uint32_t watchers = 0;       // peers without a problem throughout
  std::vector<Sighting> sightings;  // at most one a watcher and mechanism
};

struct Distribution {
  std::uint32_t n = 0;  // the rest is 0 where this is
  Nanoseconds min{0}, p50{0}, p99{0}, max{0};
};
// Percentiles by nearest rank.
Distribution DistributionOf(std::vector<Nanoseconds> times);

// How one mechanism reported one fault, in all trials.
struct Cell {
  Fault fault = Fault::kKill;
  Mechanism mechanism = Mechanism::kBeaconAge;
  Duty duty = Duty::kNone;
  Nanoseconds promised{0};  // without pauses
  std::uint32_t trials = 0;
  std::uint32_t asked = 0;       // trials times their watchers
  Distribution seen;             // time from fault to sighting
  std::uint32_t unseen = 0;      // that had to be seen
  std::uint32_t excused = 0;     // later than promised, by no more than the pause of that sighting
  std::uint32_t late = 0;        // later than promised and the pause of that sighting
  Nanoseconds worst_excess{0};   // of the late ones, beyond both
  Nanoseconds longest_pause{0};  // that excused a sighting
  std::uint32_t uncalled_for = 0;  // seen, though they must not be

  bool Kept() const { return unseen == 0 && late == 0 && uncalled_for == 0; }
};

// A cell for each mechanism of each fault that was tried, in the order of the table.
std::vector<Cell> EvaluateTrials(std::span<const Trial> trials, const Limits& limits);

}  // namespace giveway::fleetctl
