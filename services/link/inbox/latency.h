// How long a sample took: from its writer's source timestamp to its reception, or to a
// moment after it, each by the wall clock of its host. May be negative where two clocks differ.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "services/link/fastdds/fastdds_version.h"
#include "services/types/time.h"

namespace giveway::link {

// Nothing where a stamp is missing: a writer need not send one.
inline std::optional<Nanoseconds> LatencyOf(const dds::SampleInfo& info) {
  const std::int64_t sent_ns = info.source_timestamp.to_ns();
  const std::int64_t received_ns = info.reception_timestamp.to_ns();
  if (sent_ns <= 0 || received_ns <= 0) return std::nullopt;
  return Nanoseconds(received_ns - sent_ns);
}

inline std::optional<Nanoseconds> LatencyUntil(std::chrono::system_clock::time_point moment,
                                               const dds::SampleInfo& info) {
  const std::int64_t sent_ns = info.source_timestamp.to_ns();
  if (sent_ns <= 0) return std::nullopt;
  return Nanoseconds(moment.time_since_epoch()) - Nanoseconds(sent_ns);
}

}  // namespace giveway::link
