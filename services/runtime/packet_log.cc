#include "services/runtime/packet_log.h"

#include "services/runtime/process.h"

namespace giveway {

std::optional<std::string> PacketLog::Note(const PacketCounters& counters, SteadyTime now) {
  if (now < next_ || counters.Dropped() == logged_.Dropped()) return std::nullopt;
  std::string reasons;
  for (std::size_t i = 1; i < kPacketDrops; ++i) {
    const std::uint64_t fresh = counters.packets[i] - logged_.packets[i];
    if (fresh == 0) continue;
    reasons += (reasons.empty() ? "" : ", ") + std::string(Name(static_cast<PacketDrop>(i))) + " " +
               std::to_string(fresh);
  }
  const std::uint64_t passed = counters.Of(PacketDrop::kNone) - logged_.Of(PacketDrop::kNone);
  logged_ = counters;
  next_ = now + kApart;
  return "packet filter: dropped " + reasons + "; handed on " + std::to_string(passed);
}

void LogDrops(const PacketCounters& counters, SteadyTime now, PacketLog* log) {
  if (const auto line = log->Note(counters, now)) LogWarning(*line);
}

}  // namespace giveway
