// Whether a beacon's numbers can be believed at all, before anything is concluded from them.
#pragma once

#include <optional>

#include "services/types/beacon.h"
#include "services/types/refusal.h"

namespace giveway {

// True if every floating-point field is a finite number.
bool IsFinite(const Beacon& beacon);

// The first field, in the order of fleet.idl, that is not finite or that no vehicle of this fleet
// can have, and its range: see the limits in the .cc.
std::optional<FieldFault> FaultOf(const Beacon& beacon);

// True if there is none; then every field is finite too.
bool IsInRange(const Beacon& beacon);

// The speed bucket of the order: round(cruise / 0.05 m/s).
constexpr std::uint32_t SpeedBucket(double cruise_m_s) {
  constexpr double kSpeedBucket_m_s = 0.05;
  return static_cast<std::uint32_t>(cruise_m_s / kSpeedBucket_m_s + 0.5);
}

}  // namespace giveway
