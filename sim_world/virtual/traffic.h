// What a run comes to beyond held or broken: what its vehicles spent their time on, how often they
// stopped, and how often they took back that they give way to a peer. Counts; judges nothing. A
// single run says little by it; over many seeds its means hardly depend on what the radio loses, so
// that a bound on them shows defects that no tick shows (tests/virtual/bounds.txt).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "services/types/decision.h"
#include "sim_world/virtual/observed.h"

namespace giveway::sim {

inline constexpr std::size_t kRuleCount = static_cast<std::size_t>(kLastRule) + 1;

// Integers, so that the sum over runs does not depend on the order in which they end.
struct TrafficFigures {
  // By rule: how long vehicles that had not arrived drove or stood by it.
  std::array<std::uint64_t, kRuleCount> by_rule_ns{};
  std::uint64_t stops = 0;       // before the goal; starting to move is none
  std::uint64_t taken_back = 0;  // gave way to one vehicle, then to none or another; passing too

  TrafficFigures& operator+=(const TrafficFigures& other);
};

class Traffic {
 public:
  Traffic(std::size_t vehicles, std::uint64_t tick_ns);

  // Processes one tick; vehicles always in the same order.
  void Observe(std::span<const Observed> vehicles);
  const TrafficFigures& Figures() const { return figures_; }

 private:
  struct Track {
    bool moved = false;
    VehicleId gives_way_to = kNoVehicle;
  };

  std::uint64_t tick_ns_;
  std::vector<Track> tracks_;
  TrafficFigures figures_;
};

}  // namespace giveway::sim
