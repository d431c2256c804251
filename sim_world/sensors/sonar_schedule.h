// Which transducer fires when, in the tiers that keep the real schedule: time is cut into slots
// from tick 0 on, which the caller chooses; in each, one transducer of each array fires at its
// start and listens to its end. Vehicles go round in the same order, each from a place of its own.
#pragma once

#include <array>
#include <cstdint>

#include "services/types/ids.h"
#include "services/types/robot_model.h"
#include "services/types/time.h"

namespace giveway::sim {

inline constexpr std::size_t kArrayCount = 2;  // front ring 0-7, rear ring 8-15
inline constexpr std::size_t kArraySize = kSensorCount / kArrayCount;

// Slots [first, end).
struct SlotRange {
  std::uint64_t first = 0;
  std::uint64_t end = 0;
};

class FiringSchedule {
 public:
  // Both positive.
  FiringSchedule(Nanoseconds slot, Nanoseconds tick_period, std::uint32_t seed);

  // The slots that start after the tick before `tick` and not after `tick`.
  SlotRange StartingIn(Tick tick) const;
  // How long before `tick` the slot, one of those starting in it, starts. Below a tick period.
  double StartsBefore_s(std::uint64_t slot, Tick tick) const;
  // The transducer of each array that fires in the slot.
  std::array<std::size_t, kArrayCount> Firing(VehicleId vehicle, std::uint64_t slot) const;

 private:
  std::uint64_t Since0_ns(Tick tick) const;

  std::uint64_t slot_ns_;
  std::uint64_t tick_ns_;
  std::uint32_t seed_;
};

}  // namespace giveway::sim
