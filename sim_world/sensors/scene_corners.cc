#include "sim_world/sensors/scene_corners.h"

#include <algorithm>
#include <cstddef>

#include "services/types/math/math.h"
#include "sim_world/geometry/geometry.h"
#include "sim_world/geometry/wall_grid.h"

namespace giveway::sim {
namespace {

constexpr double kMeet_m = 1e-3;  // walls this near to each other meet
constexpr double kCornerCell_m = 2;
// The return of a right angle that is off by so much is off by twice that: half of the beam.
constexpr double kOffRightAngle_rad = Radians(4);
// Two walls that nearly continue each other make no corner.
constexpr double kStraight_rad = Radians(10);

// A wall as it leaves a corner.
struct Arm {
  double bearing_rad = 0;
  Vec2 direction_world;
};

void AddArm(Vec2 from, Vec2 to, std::vector<Arm>* arms) {
  constexpr double kSame_rad = 1e-3;
  const Vec2 displacement = to - from;
  const double length_m = Norm(displacement);
  if (length_m <= kMeet_m) return;
  const double bearing_rad = Atan2(displacement.y, displacement.x);
  const bool known = std::ranges::any_of(*arms, [&](const Arm& arm) {
    return Magnitude(WrapAngle(arm.bearing_rad - bearing_rad)) < kSame_rad;
  });
  if (!known) arms->push_back({bearing_rad, (1 / length_m) * displacement});
}

bool AreOnePoint(Vec2 a, Vec2 b) { return SquaredNorm(a - b) <= kMeet_m * kMeet_m; }

// All walls that end at the point or run through it, in order of their bearing.
std::vector<Arm> ArmsAt(Vec2 point, std::span<const Wall> walls, const WallGrid& grid) {
  std::vector<Arm> arms;
  grid.Near(point, kMeet_m, [&](std::uint32_t i) {
    const Wall& wall = walls[i];
    if (!AreOnePoint(NearestOnSegment(wall.from_world, wall.to_world, point), point)) return;
    AddArm(point, wall.from_world, &arms);
    AddArm(point, wall.to_world, &arms);
  });
  std::ranges::sort(arms, {}, &Arm::bearing_rad);
  return arms;
}

void AddCorners(Vec2 point, const std::vector<Arm>& arms, std::vector<SceneCorner>* edges,
                std::vector<SceneCorner>* reflectors) {
  if (arms.size() == 1) {
    const Vec2 along = arms[0].direction_world;
    edges->push_back({point, along, along, true, true});
    return;
  }
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const Arm& arm = arms[i];
    const Arm& next = arms[(i + 1) % arms.size()];
    double open_rad = next.bearing_rad - arm.bearing_rad;
    if (open_rad <= 0) open_rad += 2 * kPi;
    const bool wide = open_rad > kPi;
    const SceneCorner corner{point, arm.direction_world, next.direction_world, wide, false};
    if (open_rad > kPi + kStraight_rad) edges->push_back(corner);
    if (Magnitude(open_rad - kPi / 2) <= kOffRightAngle_rad) reflectors->push_back(corner);
  }
}

}  // namespace

bool SceneCorner::Answers(Vec2 point_world) const {
  if (round) return true;
  const Vec2 to_point = point_world - at_world;
  const bool after_from = Cross(from_world, to_point) >= 0;
  const bool before_to = Cross(to_point, to_world) >= 0;
  return wide ? after_from || before_to : after_from && before_to;
}

SceneCorners::SceneCorners(std::span<const Wall> walls) {
  const WallGrid grid(walls);
  for (std::uint32_t i = 0; i < walls.size(); ++i) {
    for (const Vec2 point : {walls[i].from_world, walls[i].to_world}) {
      // Once for all walls that end here: with the first of them.
      bool is_first = true;
      grid.Near(point, kMeet_m, [&](std::uint32_t other) {
        is_first = is_first && (other >= i || (!AreOnePoint(walls[other].from_world, point) &&
                                               !AreOnePoint(walls[other].to_world, point)));
      });
      if (is_first)
        AddCorners(point, ArmsAt(point, walls, grid), &edges_.corners, &reflectors_.corners);
    }
  }
  edges_.Build();
  reflectors_.Build();
}

void SceneCorners::Index::Build() {
  std::vector<Vec2> places;
  places.reserve(corners.size());
  for (const SceneCorner& corner : corners) places.push_back(corner.at_world);
  grid.Rebuild(places, kCornerCell_m);
}

}  // namespace giveway::sim
