#include "sim_world/virtual/traffic.h"

#include "services/types/check.h"
#include "services/types/math/math.h"

namespace giveway::sim {
namespace {

// Faster than this it has set off again: one that creeps up to a line stops once.
constexpr double kMoves_m_s = 0.05;

}  // namespace

TrafficFigures& TrafficFigures::operator+=(const TrafficFigures& other) {
  for (std::size_t i = 0; i < kRuleCount; ++i) by_rule_ns[i] += other.by_rule_ns[i];
  stops += other.stops;
  taken_back += other.taken_back;
  return *this;
}

Traffic::Traffic(std::size_t vehicles, std::uint64_t tick_ns)
    : tick_ns_(tick_ns), tracks_(vehicles) {}

void Traffic::Observe(std::span<const Observed> vehicles) {
  GIVEWAY_CHECK(vehicles.size() == tracks_.size());
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    const Observed& now = vehicles[i];
    Track& track = tracks_[i];
    if (!now.present || !now.lives || now.arrived) {
      track = {};
      continue;
    }
    figures_.by_rule_ns[static_cast<std::size_t>(now.decision.rule)] += tick_ns_;
    const bool gave = track.gives_way_to != kNoVehicle;
    if (gave && now.gives_way_to != track.gives_way_to) ++figures_.taken_back;
    track.gives_way_to = now.gives_way_to;
    const double pace_m_s = Magnitude(now.forward_m_s);
    if (track.moved && pace_m_s < kStandstill_m_s) {
      ++figures_.stops;
      track.moved = false;
    }
    track.moved = track.moved || pace_m_s > kMoves_m_s;
  }
}

}  // namespace giveway::sim
