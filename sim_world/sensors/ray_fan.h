// Adjacent rays, such as a lidar's beams or a camera's columns, and what each of them hits first.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sim_world/sensors/scene.h"
#include "sim_world/sensors/sensor.h"

namespace giveway::sim {

struct RayHit {
  bool hit = false;
  double range_m = 0;      // only if hit
  Owner owner = kNoOwner;  // of what was hit; walls have none
};

class RayFan {
 public:
  // Ray i looks at first_rad + i * step_rad; all of them within a quarter turn of straight ahead.
  RayFan(double first_rad, double step_rad, std::size_t count);

  std::size_t Count() const { return directions_body_.size(); }
  double Bearing(std::size_t ray) const {
    return first_rad_ + static_cast<double>(ray) * step_rad_;
  }
  // Fills hits[i] for ray i, of everything up to range_m away. Of two at one range the lower owner.
  void Cast(const SensorView& view, double range_m, std::span<RayHit> hits) const;

 private:
  struct Rays {
    std::size_t begin = 0;
    std::size_t end = 0;
  };
  Rays All() const { return {0, directions_body_.size()}; }
  Rays Between(double from_rad, double to_rad) const;
  Rays MeetingDisc(Vec2 centre_body, double radius_m) const;
  Rays MeetingSegment(Vec2 from_body, Vec2 to_body) const;

  double first_rad_;
  double step_rad_;
  std::vector<Vec2> directions_body_;
};

}  // namespace giveway::sim
