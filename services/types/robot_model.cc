#include "services/types/robot_model.h"

#include "services/types/math/math.h"

namespace giveway {

RobotModel PioneerP3dx() {
  // ARIA's p3dx parameter file: x, y in millimetres, heading in degrees.
  struct Row {
    double x_mm, y_mm, bearing_deg;
  };
  constexpr Row kRing[kSensorCount] = {
      {69, 136, 90},     {114, 119, 50},     {148, 78, 30},     {166, 27, 10},
      {166, -27, -10},   {148, -78, -30},    {114, -119, -50},  {69, -136, -90},
      {-157, -136, -90}, {-203, -119, -130}, {-237, -78, -150}, {-255, -27, -170},
      {-255, 27, 170},   {-237, 78, 150},    {-203, 119, 130},  {-157, 136, 90}};
  RobotModel profile;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    const Row& row = kRing[i];
    profile.sonar[i] = {.position_body = {row.x_mm / 1000, row.y_mm / 1000},
                        .bearing_rad = Radians(row.bearing_deg),
                        .enabled = i < 8};
  }
  return profile;
}

}  // namespace giveway
