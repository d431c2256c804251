#include "sim_world/sensors/sonar_schedule.h"

#include "services/types/check.h"
#include "services/types/math/random.h"

namespace giveway::sim {
namespace {

// Separates the choice of places from other random streams of the same seed.
constexpr std::uint64_t kPlaceStream = 0x736c6f74ULL << 32;

}  // namespace

FiringSchedule::FiringSchedule(Nanoseconds slot, Nanoseconds tick_period, std::uint32_t seed)
    : slot_ns_(static_cast<std::uint64_t>(slot.count())),
      tick_ns_(static_cast<std::uint64_t>(tick_period.count())),
      seed_(seed) {
  GIVEWAY_CHECK(slot.count() > 0 && tick_period.count() > 0, slot.count(), tick_period.count());
}

std::uint64_t FiringSchedule::Since0_ns(Tick tick) const { return Number(tick) * tick_ns_; }

SlotRange FiringSchedule::StartingIn(Tick tick) const {
  if (tick == kNoTick) return {};
  const std::uint64_t now_ns = Since0_ns(tick);
  return {(now_ns - tick_ns_) / slot_ns_ + 1, now_ns / slot_ns_ + 1};
}

double FiringSchedule::StartsBefore_s(std::uint64_t slot, Tick tick) const {
  return static_cast<double>(Since0_ns(tick) - slot * slot_ns_) * 1e-9;
}

std::array<std::size_t, kArrayCount> FiringSchedule::Firing(VehicleId vehicle,
                                                            std::uint64_t slot) const {
  const std::uint64_t shift = Random(kPlaceStream ^ seed_, Number(vehicle)).Next() % kArraySize;
  const std::size_t in_array = (slot + shift) % kArraySize;
  return {in_array, kArraySize + in_array};
}

}  // namespace giveway::sim
