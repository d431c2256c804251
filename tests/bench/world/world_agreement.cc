#include "tests/bench/world/world_agreement.h"

#include <algorithm>

#include "services/types/check.h"
#include "services/types/math/math.h"
#include "sim_world/geometry/geometry.h"

namespace giveway::bench {
namespace {

constexpr double kOneOnEachSide = 1.1001;  // cos 45 / cos 50

// Beyond the range nothing echoes: that is a range of its own, for either side.
double RangeOf(const RangeReading& reading, double max_range_m) {
  GIVEWAY_CHECK(reading.kind != Echo::kNoData);
  return reading.kind == Echo::kEcho ? reading.range_m : max_range_m;
}

double DiscBound(double range_m, double radius_m) {
  const double distance_m = range_m + radius_m;
  const double off_m = distance_m * Sin(kRayStep_rad / 2);
  const double half_chord_m = Sqrt(std::max(0.0, radius_m * radius_m - off_m * off_m));
  return distance_m * Cos(kRayStep_rad / 2) - half_chord_m;
}

// A transducer and what bounds its rays.
struct Receiver {
  Vec2 apex_world;
  double body_radius_m;
  double max_range_m;
  std::span<const Wall> walls;
};

// The longest range seven rays may return where the exact one is range_m.
double LongestOfRays(const Receiver& receiver, double range_m) {
  const bool wall_is_near = std::ranges::any_of(receiver.walls, [&](const Wall& wall) {
    const Vec2 nearest = sim::NearestOnSegment(wall.from_world, wall.to_world, receiver.apex_world);
    return Norm(nearest - receiver.apex_world) <= range_m + kRounding_m;
  });
  const double disc_m = DiscBound(range_m, receiver.body_radius_m);
  const double bound_m = wall_is_near ? std::max(disc_m, kOneOnEachSide * range_m) : disc_m;
  return std::min(bound_m, receiver.max_range_m);
}

bool Within(const Receiver& receiver, double least_m, double most_m, double peer_m) {
  if (peer_m < least_m - kRounding_m) return false;
  if (peer_m <= DiscBound(most_m, receiver.body_radius_m) + kRounding_m) return true;
  return peer_m <= LongestOfRays(receiver, most_m) + kRounding_m;
}

void CompareReading(const Receiver& receiver, double exact_m, double least_m, double most_m,
                    double peer_m, Agreement* agreement) {
  GIVEWAY_CHECK(least_m <= exact_m && exact_m <= most_m, exact_m);
  ++agreement->readings;
  if (least_m < kOnSurface_m) {
    ++agreement->on_surface;
  } else if (Within(receiver, exact_m, exact_m, peer_m)) {
    agreement->worst_excess_m = std::max(agreement->worst_excess_m, peer_m - exact_m);
  } else if (Within(receiver, least_m, most_m, peer_m)) {
    ++agreement->grazing;
  } else {
    ++agreement->disagreements;
  }
}

}  // namespace

void Compare(const SensedBodies& world, std::span<const RayRanges> peer,
             std::span<const Wall> walls, Agreement* agreement) {
  for (std::size_t i = 0; i < world.exact.size(); ++i) {
    const sim::Body& body = world.exact[i];
    GIVEWAY_CHECK(body.world_from_body == world.wider[i].world_from_body);
    GIVEWAY_CHECK(body.world_from_body == world.narrower[i].world_from_body);
    const double max_range_m = body.profile.sonar_max_range_m;
    for (std::size_t cone = 0; cone < kSensorCount; ++cone) {
      const Receiver receiver = {
          ToWorld(body.world_from_body, body.profile.sonar[cone].position_body),
          body.profile.body_radius_m, max_range_m, walls};
      CompareReading(receiver, RangeOf(body.sonar.readings[cone], max_range_m),
                     RangeOf(world.wider[i].sonar.readings[cone], max_range_m),
                     RangeOf(world.narrower[i].sonar.readings[cone], max_range_m),
                     std::min(static_cast<double>(peer[i][cone]), max_range_m), agreement);
    }
  }
}

}  // namespace giveway::bench
