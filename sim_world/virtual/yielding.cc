#include "sim_world/virtual/yielding.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/types/time.h"

namespace giveway::sim {
namespace {

// A vehicle that stops just before the path of another is not in it.
constexpr double kOverlaps_m = 0.05;
// Of two that meet head on, or drive one behind the other, the second stands where it is and the
// first steers round it: of paths at less than this angle, by its sine (30 degrees).
constexpr double kAcross = 0.5;

bool GivesWay(const Observed& now) {
  const Rule rule = now.decision.rule;
  return now.present && now.lives && !now.arrived && now.beacon != nullptr &&
         Magnitude(now.forward_m_s) < kStandstill_m_s &&
         (rule == Rule::kGiveWay || rule == Rule::kNotGranted);
}

bool WantsOn(const Observed& peer) {
  return peer.present && peer.lives && !peer.arrived && peer.beacon != nullptr &&
         !StaysPut(peer.decision.rule) && peer.decision.rule != Rule::kSteerRound;
}

bool Crosses(Vec2 own_path, Vec2 peer_path) {
  const double product = Norm(own_path) * Norm(peer_path);
  return Magnitude(Cross(own_path, peer_path)) > kAcross * product;
}

// Whether the peer would touch it on its path to where it says that it drives to.
bool IsInPath(const Observed& now, const Observed& peer) {
  const Vec2 path = peer.beacon->toward_world - peer.position_world;
  const double length_m = Norm(path);
  if (length_m <= 0 || !Crosses(now.beacon->toward_world - now.position_world, path)) return false;
  const Vec2 direction = (1 / length_m) * path;
  const Vec2 offset = now.position_world - peer.position_world;
  const double along_m = Dot(offset, direction);
  if (along_m <= 0 || along_m > length_m) return false;
  const double reach_m = now.beacon->body_radius_m + peer.beacon->body_radius_m - kOverlaps_m;
  return Magnitude(Cross(direction, offset)) < reach_m;
}

}  // namespace

Yielding::Yielding(const Scenario& scenario)
    : limit_ticks_(TicksCovering(FromSeconds(kNotices_s), scenario.tick_period)) {}

std::span<const std::uint32_t> Yielding::Observe(std::span<const Observed> vehicles) {
  blocking_.clear();
  blocked_ticks_.resize(vehicles.size());
  for (std::uint32_t i = 0; i < vehicles.size(); ++i) {
    const Observed& now = vehicles[i];
    const auto peer = std::ranges::lower_bound(vehicles, now.decision.peer, {}, &Observed::vehicle);
    const bool blocks = GivesWay(now) && peer != vehicles.end() &&
                        peer->vehicle == now.decision.peer && WantsOn(*peer) &&
                        IsInPath(now, *peer);
    blocked_ticks_[i] = blocks ? blocked_ticks_[i] + 1 : 0;
    if (blocked_ticks_[i] == limit_ticks_ + 1) blocking_.push_back(i);
  }
  return blocking_;
}

}  // namespace giveway::sim
