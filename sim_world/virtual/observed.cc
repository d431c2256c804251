#include "sim_world/virtual/observed.h"

#include <algorithm>

namespace giveway::sim {

double RimSpeed(const DriveGeometry& drive, WheelSpeeds wheels) {
  return drive.wheel_radius_m *
         std::max({wheels.left_rad_s, -wheels.left_rad_s, wheels.right_rad_s, -wheels.right_rad_s});
}

}  // namespace giveway::sim
