#include "services/fleetctl/soak/fault_clock.h"

#include <algorithm>
#include <set>

namespace giveway::fleetctl {

FaultClock::FaultClock(std::span<const faults::Fault> schedule,
                       const std::function<bool(const faults::Fault&)>& follows)
    : schedule_(schedule) {
  for (std::size_t i = 0; i < schedule.size(); ++i) {
    const faults::Fault& fault = schedule[i];
    if (follows && !follows(fault)) continue;
    edges_.push_back({i, fault.at_s, true});
    if (fault.for_s > 0) edges_.push_back({i, fault.EndsAt_s(), false});
    last_end_s_ = std::max(last_end_s_, fault.EndsAt_s());
  }
  std::ranges::stable_sort(edges_, [](const FaultEdge& a, const FaultEdge& b) {
    return a.at_s != b.at_s ? a.at_s < b.at_s : !a.begins && b.begins;
  });
}

std::span<const FaultEdge> FaultClock::TakeDue(double now_s) {
  const std::size_t first = next_;
  while (next_ < edges_.size() && edges_[next_].at_s <= now_s) {
    const FaultEdge& edge = edges_[next_];
    const auto started = std::span(edges_).subspan(first, next_ - first);
    if (!edge.begins && std::ranges::count(started, edge.fault, &FaultEdge::fault) > 0) break;
    ++next_;
  }
  return std::span(edges_).subspan(first, next_ - first);
}

std::span<const FaultEdge> FaultClock::EndAll(double now_s) {
  for (const std::size_t fault : UnderWay()) early_ends_.push_back({fault, now_s, false});
  next_ = edges_.size();
  return early_ends_;
}

std::vector<std::size_t> FaultClock::UnderWay() const {
  std::set<std::size_t> under_way;
  for (const FaultEdge& edge : std::span(edges_).first(next_)) {
    if (!edge.begins) {
      under_way.erase(edge.fault);
    } else if (schedule_[edge.fault].for_s > 0) {
      under_way.insert(edge.fault);
    }
  }
  return {under_way.begin(), under_way.end()};
}

void WorldTime::Follow(std::span<const Truth> truths, SteadyTime now) {
  if (truths.empty()) return;
  if (!newest_ || truths.back().time_s > newest_->time_s) moved_at_ = now;
  newest_ = truths.back();
  received_at_ = now;
}

}  // namespace giveway::fleetctl
