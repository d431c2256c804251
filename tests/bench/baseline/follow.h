// Wheel speeds that keep a differential drive on a plan: where it should be on its path now, and
// how fast. Exact on straight paths; where the path starts to bend the wheels lag a little.
#pragma once

#include "services/types/robot_model.h"
#include "tests/bench/baseline/arc_path.h"
#include "tests/bench/baseline/pilot.h"

namespace giveway::bench {

struct Planned {
  double driven_m = 0;   // now
  double speed_m_s = 0;  // at the end of the tick
};

WheelSpeeds FollowPath(const RobotModel& profile, const ArcPath& path, const Planned& planned,
                       const Pose& world_from_body);

// Enough to turn on the spot by an angle under FollowPath, starting and ending at rest.
double SecondsToTurn(const RobotModel& profile, double angle_rad);

}  // namespace giveway::bench
