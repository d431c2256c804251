// What of the packet filter's work is logged: that it dropped something, by reason, in one line a
// minute at most, whatever is sent at it. Pure.
#pragma once

#include <optional>
#include <string>

#include "services/types/figures/packet_counters.h"
#include "services/types/time.h"

namespace giveway {

class PacketLog {
 public:
  static constexpr Nanoseconds kApart = std::chrono::minutes(1);

  // The line to log; nothing where nothing was dropped since the last one, or that was lately.
  std::optional<std::string> Note(const PacketCounters& counters, SteadyTime now);

 private:
  PacketCounters logged_;
  SteadyTime next_{0};
};

// Logs it as a warning.
void LogDrops(const PacketCounters& counters, SteadyTime now, PacketLog* log);

}  // namespace giveway
