// Wheel speeds that keep a differential drive on a plan: where it should be on its path now, and
// how fast. Exact on straight paths; where the path starts to bend the wheels lag a little.
#pragma once

#include "services/types/profile.h"
#include "tests/bench/baseline/pilot.h"
#include "tests/bench/baseline/way.h"

namespace giveway::bench {

struct Planned {
  double driven_m = 0;   // now
  double speed_m_s = 0;  // at the end of the tick
};

WheelSpeeds FollowWay(const VehicleProfile& profile, const Way& way, const Planned& planned,
                      const Pose& world_from_body);

// Enough to turn on the spot by an angle under FollowWay, starting and ending at rest.
double SecondsToTurn(const VehicleProfile& profile, double angle_rad);

}  // namespace giveway::bench
