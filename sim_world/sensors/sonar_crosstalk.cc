#include "sim_world/sensors/sonar_crosstalk.h"

#include <algorithm>

#include "sim_world/sensors/line_of_sight.h"

namespace giveway::sim {
namespace {

constexpr double kHearingCell_m = 4;

}  // namespace

Pulses PulsesOf(const SonarRing& ring, const Pose& world_from_body,
                const std::array<std::size_t, kArrayCount>& transducers) {
  const Vec2 forward = Forward(world_from_body);
  const auto turned = [&](Vec2 body) { return body.x * forward + body.y * Left(forward); };
  Pulses pulses;
  for (std::size_t array = 0; array < kArrayCount; ++array) {
    const Cone& cone = ring.ConeBody(transducers[array]);
    pulses[array] = {.fired = ring.Enabled(transducers[array]),
                     .apex_world = world_from_body.position_world + turned(cone.apex),
                     .axis_world = turned(cone.axis),
                     .cos_half = cone.cos_half,
                     .max_range_m = cone.max_range_m};
  }
  return pulses;
}

double CrosstalkRange(const Pulse& listener, const Pulse& talker) {
  if (!listener.fired || !talker.fired) return kSilence_m;
  const Vec2 displacement = talker.apex_world - listener.apex_world;
  const double distance_m = Norm(displacement);
  const bool mutual = Dot(listener.axis_world, displacement) >= distance_m * listener.cos_half &&
                      -Dot(talker.axis_world, displacement) >= distance_m * talker.cos_half;
  return mutual && distance_m / 2 <= listener.max_range_m ? distance_m / 2 : kSilence_m;
}

void Crosstalk::Clear() {
  owners_.clear();
  positions_world_.clear();
  pulses_.clear();
  farthest_m_ = 0;
}

void Crosstalk::Add(Owner owner, Vec2 position_world, const Pulses& pulses) {
  owners_.push_back(owner);
  positions_world_.push_back(position_world);
  pulses_.push_back(pulses);
  for (const Pulse& pulse : pulses) {
    // Twice the range apart, and as far off as the transducers sit from the positions.
    const double reach_m = pulse.max_range_m + Norm(pulse.apex_world - position_world);
    farthest_m_ = std::max(farthest_m_, 2 * reach_m);
  }
}

void Crosstalk::Index() { grid_.Rebuild(positions_world_, kHearingCell_m); }

double Crosstalk::Nearest(const Scene& scene, std::size_t i, std::size_t array) const {
  const Pulse& listener = pulses_[i][array];
  double nearest_m = kSilence_m;
  grid_.Near(positions_world_[i], farthest_m_, [&](std::uint32_t begin, std::uint32_t end) {
    for (; begin != end; ++begin) {
      const std::size_t other = grid_.Order()[begin];
      if (other == i) continue;
      for (const Pulse& talker : pulses_[other]) {
        const double range_m = CrosstalkRange(listener, talker);
        if (range_m >= nearest_m) continue;
        if (IsBlocked(scene, listener.apex_world, talker.apex_world, owners_[i], owners_[other])) {
          continue;
        }
        nearest_m = range_m;
      }
    }
  });
  return nearest_m;
}

}  // namespace giveway::sim
