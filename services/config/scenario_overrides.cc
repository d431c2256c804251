#include "services/config/scenario_overrides.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/types/math/random.h"

namespace giveway {

void PerturbBySeed(Scenario* scenario) {
  if (scenario->seed == 0) return;
  for (VehicleOptions& vehicle : scenario->vehicles) {
    // A stream by id: adding a vehicle to a file leaves the others where they were.
    Random random(scenario->seed, Number(vehicle.id));
    const double dx_m = random.Uniform(-0.05, 0.05);
    const double dy_m = random.Uniform(-0.05, 0.05);
    const double turn_rad = Radians(random.Uniform(-2, 2));
    const double factor = random.Uniform(0.98, 1.02);
    Pose& start = vehicle.start_world;
    start.position_world = start.position_world + Vec2{dx_m, dy_m};
    start.heading_rad = WrapAngle(start.heading_rad + turn_rad);
    vehicle.cruise_m_s = std::min(vehicle.cruise_m_s * factor, vehicle.profile.max_speed_m_s);
  }
}

}  // namespace giveway
