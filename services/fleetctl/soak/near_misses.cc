#include "services/fleetctl/soak/near_misses.h"

#include <algorithm>
#include <cmath>

namespace giveway::fleetctl {
namespace {

// The other's truth may be this much older: the two of one tick do not arrive together.
constexpr double kSameTime_s = 0.2;

bool ByTime(const NearMiss& a, const NearMiss& b) { return a.time_s < b.time_s; }

}  // namespace

std::map<VehicleId, double> RadiiOf(const Scenario& scenario, const std::vector<VehicleId>& fleet) {
  double largest_m = 0;
  for (const VehicleOptions& spawn : scenario.spawns) {
    largest_m = std::max(largest_m, spawn.profile.body_radius_m);
  }
  std::map<VehicleId, double> radius_m;
  for (const VehicleId vehicle : fleet) radius_m[vehicle] = largest_m;
  for (const VehicleOptions& vehicle : scenario.vehicles) {
    radius_m[vehicle.id] = vehicle.profile.body_radius_m;
  }
  return radius_m;
}

void NearMisses::Fold(std::span<const Truth> truths, double lag_s) {
  for (const Truth& truth : truths) {
    if (!truth.present) {
      newest_.erase(truth.vehicle);
      continue;
    }
    const Body body{truth, radius_m_[truth.vehicle]};
    newest_[truth.vehicle] = body;
    Observe(body, lag_s);
  }
}

void NearMisses::Observe(const Body& body, double lag_s) {
  const Truth& truth = body.truth;
  const Vec2 here = truth.world_from_body.position_world;
  for (const auto& [other, theirs] : newest_) {
    if (other == truth.vehicle || std::abs(theirs.truth.time_s - truth.time_s) > kSameTime_s)
      continue;
    const Vec2 there = theirs.truth.world_from_body.position_world;
    const double distance_m = Norm(here - there) - body.radius_m - theirs.radius_m;
    const NearMiss now{truth.time_s + lag_s, truth.vehicle, other, here.x, here.y, distance_m};
    if (!nearest_ || distance_m < nearest_->distance_m) nearest_ = now;
    const auto pair = std::minmax(truth.vehicle, other);
    const auto under_way = under_way_.find(pair);
    if (under_way == under_way_.end()) {
      if (distance_m >= kNear_m) continue;
      ++count_;
      under_way_.emplace(pair, now);
    } else if (distance_m > kApart_m) {
      Keep(under_way->second);
      under_way_.erase(under_way);
    } else if (distance_m < under_way->second.distance_m) {
      under_way->second = now;
    }
  }
}

void NearMisses::Keep(const NearMiss& miss) {
  kept_.push_back(miss);
  if (kept_.size() <= kMostKept) return;
  kept_.erase(std::ranges::max_element(kept_, {}, &NearMiss::distance_m));
}

std::vector<NearMiss> NearMisses::Narrowest() const {
  std::vector<NearMiss> all = kept_;
  for (const auto& [pair, miss] : under_way_) all.push_back(miss);
  std::ranges::sort(all, ByTime);
  return all;
}

}  // namespace giveway::fleetctl
