// One value of a QoS as a plain number. Knows no DDS: tools show and compare it.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

namespace giveway::link {

inline constexpr std::int64_t kInfiniteDuration = std::numeric_limits<std::int64_t>::max();

// Durations in nanoseconds; kinds by their number, weakest first; switches as 0 and 1.
struct ResolvedValue {
  std::string policy;  // "deadline", "max_instances"
  std::int64_t number = 0;

  friend bool operator==(const ResolvedValue&, const ResolvedValue&) = default;
};

}  // namespace giveway::link
