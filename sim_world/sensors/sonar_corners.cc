#include "sim_world/sensors/sonar_corners.h"

#include <bit>

#include "services/types/math/math.h"
#include "sim_world/sensors/line_of_sight.h"

namespace giveway::sim {
namespace {

// A line of sight ends so much before the corner, which is on the walls that make it.
constexpr double kBefore_m = 1e-4;

class Listener {
 public:
  Listener(const Scene& scene, const SonarRing& ring, const Pose& world_from_body, Owner self,
           std::uint32_t transducers, Lanes* range_m)
      : scene_(scene),
        ring_(ring),
        receiver_{.position_world = world_from_body.position_world,
                  .x_axis_world = Forward(world_from_body),
                  .self = self},
        transducers_(transducers),
        range_m_(range_m) {}

  // Of a corner that is heard up to `reach(off)`, and from nowhere beyond near_m of the axle
  // centre; `answers(apex_world)`: from there.
  template <typename Reach, typename Answers>
  void Hear(Vec2 at_world, double near_m, const Reach& reach, const Answers& answers) {
    if (SquaredNorm(at_world - receiver_.position_world) > near_m * near_m) return;
    const Vec2 at = receiver_.ToBody(at_world);
    for (std::uint32_t left = transducers_; left != 0; left &= left - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(left));
      const Cone& cone = ring_.ConeBody(i);
      const Vec2 to = at - cone.apex;
      const double along_m = Dot(cone.axis, to);
      const double squared_m2 = SquaredNorm(to);
      if (along_m <= 0 || along_m * along_m < cone.cos_half * cone.cos_half * squared_m2) continue;
      if (squared_m2 >= range_m_->of[i] * range_m_->of[i]) continue;
      const double distance_m = Sqrt(squared_m2);
      const double across_m = Cross(cone.axis, to);
      const double off = across_m * across_m / (squared_m2 * cone.sin_half * cone.sin_half);
      if (distance_m > reach(off)) continue;
      const Vec2 apex_world = receiver_.ToWorld(cone.apex);
      if (!answers(apex_world) || IsHidden(apex_world, at_world, distance_m)) continue;
      range_m_->of[i] = distance_m;
    }
  }

 private:
  bool IsHidden(Vec2 apex_world, Vec2 at_world, double distance_m) const {
    if (distance_m <= kBefore_m) return false;
    const Vec2 before = at_world + kBefore_m / distance_m * (apex_world - at_world);
    return IsBlocked(scene_, apex_world, before, receiver_.self, receiver_.self);
  }

  const Scene& scene_;
  const SonarRing& ring_;
  Receiver receiver_;
  std::uint32_t transducers_;
  Lanes* range_m_;
};

}  // namespace

void HearCorners(const Scene& scene, const SonarRing& ring, const Pose& world_from_body, Owner self,
                 double edge_reach_m, std::uint32_t transducers, Lanes* range_m) {
  Listener listener(scene, ring, world_from_body, self, transducers, range_m);
  const Vec2 centre_world = world_from_body.position_world;
  const double near_m = ring.ApexReach() + edge_reach_m;
  const auto edge_reach = [&](double off) { return EdgeReachOff(edge_reach_m, off); };
  const auto anywhere = [](Vec2) { return true; };
  scene.Corners().EdgesNear(centre_world, near_m, [&](const SceneCorner& corner) {
    listener.Hear(corner.at_world, near_m, edge_reach,
                  [&](Vec2 apex) { return corner.Answers(apex); });
  });
  scene.LeavesNear(centre_world, near_m, [&](const SceneSegment& leaf) {
    if (leaf.owner == self) return;
    listener.Hear(leaf.from_world, near_m, edge_reach, anywhere);
    listener.Hear(leaf.to_world, near_m, edge_reach, anywhere);
  });
  scene.BoxesNear(centre_world, near_m, [&](const SceneBox& box) {
    if (box.owner == self) return;
    for (const Vec2 corner : box.corners_world) listener.Hear(corner, near_m, edge_reach, anywhere);
  });
  const double max_m = ring.MaxRange();
  scene.Corners().ReflectorsNear(
      centre_world, ring.ApexReach() + max_m, [&](const SceneCorner& corner) {
        listener.Hear(
            corner.at_world, ring.ApexReach() + max_m, [max_m](double) { return max_m; },
            [&](Vec2 apex) { return corner.Answers(apex); });
      });
}

}  // namespace giveway::sim
