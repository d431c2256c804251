// What a service counts, in the names and units of Prometheus and in its text format. Counts
// nothing itself.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "services/health/health.h"

namespace giveway {

// What the operating system says of this process, and its log. Seconds, bytes.
struct ProcessFigures {
  double started_s = 0;  // since 1970, when this program image started
  double cpu_s = 0;
  double resident_bytes = 0;
  std::optional<std::uint64_t> heap_bytes;  // in use
  std::uint64_t log_lines_dropped = 0;      // because stderr was not read
};
ProcessFigures ReadProcessFigures();

std::string MetricsText(const VehicleHealth& vehicle, const ProcessFigures& process,
                        SteadyTime now);
std::string MetricsText(const WorldHealth& world, const ProcessFigures& process, SteadyTime now);

}  // namespace giveway
