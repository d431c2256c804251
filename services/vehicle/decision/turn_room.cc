#include "services/vehicle/decision/turn_room.h"

#include <algorithm>

#include "services/types/math/math.h"

namespace giveway {
namespace {

// Between a corner and the middle of a cell that something was heard in.
constexpr double kPasses_m = 0.02;
// Looked at in such steps, and no further than a vehicle turns within a second or two.
constexpr double kStep_rad = 0.05;
constexpr double kFurthest_rad = 1;

// How deep a point is inside a box round the axle centre: 0 outside and on its edge.
double DepthInBox(Vec2 point_body, Vec2 half_m) {
  const double depth_m =
      std::min(half_m.x - Magnitude(point_body.x), half_m.y - Magnitude(point_body.y));
  return std::max(0.0, depth_m);
}

// Whether turning by so much takes any of the places further into the body.
bool SweepsOver(double turned_rad, Vec2 half_m, std::span<const Vec2> places) {
  const Vec2 forward = {Cos(turned_rad), Sin(turned_rad)};
  return std::ranges::any_of(places, [&](const Vec2& place) {
    const Vec2 then = {Dot(forward, place), Cross(forward, place)};
    return DepthInBox(then, half_m) > DepthInBox(place, half_m);
  });
}

}  // namespace

double TurnWithinRoom(double turn_rad, const RobotModel& body, std::span<const Vec2> places) {
  if (body.shape != BodyShape::kBox || places.empty()) return turn_rad;
  const Vec2 half_m = body.box_half_m + Vec2{kPasses_m, kPasses_m};
  const double side = turn_rad < 0 ? -1 : 1;
  const double most_rad = std::min(Magnitude(turn_rad), kFurthest_rad);
  for (double free_rad = 0; free_rad < most_rad; free_rad += kStep_rad) {
    if (SweepsOver(side * (free_rad + kStep_rad), half_m, places)) return side * free_rad;
  }
  return turn_rad;
}

}  // namespace giveway
