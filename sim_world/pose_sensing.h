// Pose fixes of every vehicle that has such a sensor, once a tick. They read the state of the world
// at the tick's end and change nothing in it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/types/scenario.h"
#include "sim_world/body.h"

namespace giveway::sim {

class PoseSensing {
 public:
  explicit PoseSensing(const Scenario& scenario);

  // The tick that was just made, numbered from 1 since the start signal; 0: not a driving tick.
  // Then nothing moved, and there are no fixes.
  void Sense(WorldEpoch epoch, Tick tick, std::uint32_t driven_tick, std::span<const Body> bodies);

  // Of the last Sense, by vehicle.
  std::span<PoseFix> Fixes() { return fixes_; }
  std::span<const PoseFix> Fixes() const { return fixes_; }
  // Removes those for which `is_lost` returns true.
  template <typename IsLost>
  void Lose(IsLost is_lost) {
    std::erase_if(fixes_, is_lost);
  }

 private:
  std::uint32_t seed_;
  double dt_s_;
  std::vector<PoseFix> fixes_;
};

}  // namespace giveway::sim
