// Which vehicles stand in the path of the very vehicle that they give way to: their halt clears
// nothing, the other cannot pass. By the truth of both bodies, and by where each says that it
// drives to: their paths cross, for one that it meets head on steers round it. A vehicle that
// notices drives out of the path, so that only one that stays there for some seconds is counted.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/types/scenario.h"
#include "sim_world/virtual/observed.h"

namespace giveway::sim {

class Yielding {
 public:
  // Reported after so long.
  static constexpr double kNotices_s = 3;

  explicit Yielding(const Scenario& scenario);

  // Processes one tick. Vehicles in order of their ids, each with its beacon; without one nothing
  // is judged. Returns those that block so from this tick on, by index; valid until the next.
  std::span<const std::uint32_t> Observe(std::span<const Observed> vehicles);

 private:
  std::uint32_t limit_ticks_;
  std::vector<std::uint32_t> blocked_ticks_;  // by vehicle, in a row
  std::vector<std::uint32_t> blocking_;
};

}  // namespace giveway::sim
