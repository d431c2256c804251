// Which ticks of a world can be true, by the time that has passed here since the first: a world
// never ticks faster than its scenario says. Pure; what time it is, is the caller's.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "services/types/ids.h"
#include "services/types/time.h"

namespace giveway::link {

class TickGate {
 public:
  // A tick may be so many ahead: what came late at first, and clocks that run apart.
  static constexpr std::uint32_t kAhead = 64;
  // Without any that could be true for this long, the next one is believed: this machine slept.
  static constexpr Nanoseconds kForgets = std::chrono::seconds(5);

  // `least_period`: from one tick to the next; above 0.
  explicit TickGate(Nanoseconds least_period) : least_period_(least_period) {}

  // The latest tick of the epoch that can be true now; nothing where any can: of a new epoch, or
  // after a long time.
  std::optional<Tick> Latest(WorldEpoch epoch, SteadyTime now) const;
  // Whether it can; the first of an epoch is what later ones are held against.
  bool Passes(WorldEpoch epoch, Tick tick, SteadyTime now);

 private:
  Nanoseconds least_period_;
  WorldEpoch epoch_ = kNoEpoch;
  Tick first_ = kNoTick;
  SteadyTime since_{0};
  SteadyTime passed_{0};
};

}  // namespace giveway::link
