// The times of a soak, from its duration and its fleet, and the blocks that it is cut into. Pure.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/faults/expand.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

// A fleet takes ten to start.
inline constexpr double kLeastSoak_s = 30;

// Seconds since the start signal.
struct SoakPhases {
  double faults_from_s = 0;   // before it: warm-up without faults
  double faults_until_s = 0;  // after it: healing without faults
  double end_s = 0;
};

// Every live vehicle drives again within this time after the last fault.
inline constexpr double kHealWithin_s = 5;

inline SoakPhases PhasesOf(double duration_s, std::size_t vehicles) {
  return {faults::WarmUpOfSoak_s(duration_s, vehicles),
          duration_s - faults::HealingOfSoak_s(duration_s), duration_s};
}

// Until a soak saves again what it has seen, after a save of that processor time: it holds every
// fault so far, so that each save costs more than the one before, and all of them together take a
// thousandth of one core at most: a thirtieth of what it takes to watch 20 vehicles.
inline Nanoseconds UntilNextSave(Nanoseconds cost) {
  return std::max<Nanoseconds>(std::chrono::seconds(10), 1000 * cost);
}

// Blocks of time of equal length. What happens within one may have a single cause: for a comparison
// of two soaks each block counts as one observation, however many values it has.
inline constexpr std::size_t kSoakBlocks = 20;

inline double BlockSeconds(double duration_s) {
  return duration_s / static_cast<double>(kSoakBlocks);
}

// What comes before the start belongs to the first block, what comes after the end to the last.
inline std::size_t BlockOf(double time_s, double block_s) {
  if (!(block_s > 0 && time_s > 0)) return 0;  // nor is it a number, in some files
  const double block = std::clamp(time_s / block_s, 0.0, static_cast<double>(kSoakBlocks - 1));
  return static_cast<std::size_t>(block);
}

// Events by block, up to the last block that has any.
class BlockCounts {
 public:
  explicit BlockCounts(double block_s) : block_s_(block_s) {}

  void Note(double time_s, std::uint64_t events) {
    if (events == 0 || !(block_s_ > 0)) return;
    const std::size_t block = BlockOf(time_s, block_s_);
    if (counts_.size() <= block) counts_.resize(block + 1);
    counts_[block] += events;
  }
  const std::vector<std::uint64_t>& Counts() const { return counts_; }

 private:
  double block_s_;
  std::vector<std::uint64_t> counts_;
};

}  // namespace giveway::fleetctl
