// The QoS of every endpoint of the fleet as the library makes it of the loaded profiles, and as
// code changes it afterwards; plain numbers, for whoever shows or compares them. Needs no network.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "services/link/link_options.h"

namespace giveway::link {

inline constexpr std::int64_t kInfiniteDuration = std::numeric_limits<std::int64_t>::max();

// Durations in nanoseconds; kinds by their number, weakest first; switches as 0 and 1.
struct ResolvedValue {
  std::string policy;  // "deadline", "max_instances"
  std::int64_t number = 0;
};

struct ResolvedEntity {
  std::string profile;
  std::string topic;  // empty for the participant
  std::vector<ResolvedValue> values;
};

// The participant, then a writer and a reader for each topic. Throws LinkError.
std::vector<ResolvedEntity> ResolveQos(const LinkOptions& options);

}  // namespace giveway::link
