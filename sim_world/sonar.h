// Ultrasonic ranges of the ideal tier: the exact distance from the transducer to the nearest point
// of a disc or wall inside its cone, in closed form. No noise, no incidence limit, no crosstalk.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "services/types/profile.h"
#include "services/types/range_scan.h"
#include "services/types/scenario.h"

namespace giveway::sim {

// What a transducer can hear: all points within max_range_m of the apex and within the half angle
// of the axis. Apex, axis and the objects share one frame; the half angle is below a right angle.
struct Cone {
  Vec2 apex;
  Vec2 axis;  // unit vector
  double cos_half = 1;
  double sin_half = 0;
  double max_range_m = 0;
};

// Distance from the apex to the nearest point in the cone; none if the object is outside it, 0 if
// the apex is in or on the object.
std::optional<double> RangeToDisc(const Cone& cone, Vec2 centre, double radius_m);
std::optional<double> RangeToSegment(const Cone& cone, Vec2 from, Vec2 to);

struct Disc {
  Vec2 centre_world;
  double radius_m = 0;
};

using Readings = std::array<RangeReading, kSensorCount>;

// A vehicle's ring of transducers, in its body frame.
class SonarRing {
 public:
  explicit SonarRing(const VehicleProfile& profile);

  // Readings from `world_from_body` at `tick`; transducers switched off give no data. bodies[self]
  // is the own body, which no transducer hears.
  Readings Sense(const Pose& world_from_body, Tick tick, std::span<const Disc> bodies,
                 std::size_t self, std::span<const Wall> walls) const;

 private:
  void HearDisc(Vec2 centre_body, double radius_m, Readings* readings) const;
  void HearWall(Vec2 from_body, Vec2 to_body, Readings* readings) const;

  std::array<Cone, kSensorCount> cones_body_{};
  std::array<bool, kSensorCount> enabled_{};
  double reach_m_ = 0;  // farthest point any cone reaches from the axle centre
};

}  // namespace giveway::sim
