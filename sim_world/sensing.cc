#include "sim_world/sensing.h"

#include <functional>

namespace giveway::sim {

Sensing::Sensing(const Scenario& scenario)
    : sonar_(scenario.sonar, scenario.seed, scenario.tick_period), scene_(scenario.walls) {}

void Sensing::Insert(std::size_t index, const RobotModel& profile) {
  ring_of_.insert(ring_of_.begin() + static_cast<std::ptrdiff_t>(index), &rings_.Of(profile));
}

void Sensing::Replace(std::size_t index, const RobotModel& profile) {
  ring_of_[index] = &rings_.Of(profile);
}

void Sensing::Erase(std::size_t index) {
  ring_of_.erase(ring_of_.begin() + static_cast<std::ptrdiff_t>(index));
  at_end_ = false;
}

void Sensing::Fill(double before_s, double dt_s, const Collidables& collidables,
                   std::span<const Body> bodies) {
  scene_.Clear();
  for (std::size_t i = 0; i < collidables.Count(); ++i) {
    if (collidables.present[i] == 0) continue;
    const auto owner = static_cast<Owner>(i);
    if (collidables.IsLeaf(i)) {
      const Leaf& leaf = collidables.LeafOf(i);
      scene_.AddSegment(leaf.from_world, TipAt(leaf, dt_s - before_s), owner);
      continue;
    }
    const Motion& motion = collidables.motions[i];
    // A body's own pose where there is one: the arc from the start need not end on the same bits.
    const Pose pose = before_s == 0 && collidables.IsBody(i) ? bodies[i].world_from_body
                                                             : PoseAt(motion, dt_s - before_s);
    if (motion.IsBox()) {
      scene_.AddBox(pose, motion.box_half_m, owner);
    } else {
      scene_.AddDisc(pose.position_world, motion.radius_m, owner);
    }
  }
  scene_.Index();
  at_end_ = before_s == 0;
}

void Sensing::Sense(const SonarTick& tick, double dt_s, const Collidables& collidables,
                    const ParallelFor& parallel, std::span<Body> bodies) {
  at_end_ = false;
  const auto instant_before = [&](double before_s) {
    Fill(before_s, dt_s, collidables, bodies);
    subjects_.clear();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      Body& body = bodies[i];
      if (!body.present) continue;
      const Pose pose =
          before_s == 0 ? body.world_from_body : PoseAt(collidables.motions[i], dt_s - before_s);
      subjects_.push_back({.vehicle = body.vehicle,
                           .owner = static_cast<Owner>(i),
                           .world_from_body = pose,
                           .ring = ring_of_[i],
                           .state = &body.sonar});
    }
    return SonarInstant{&scene_, subjects_};
  };
  sonar_.Sense(tick, std::ref(instant_before), parallel);
}

const Scene& Sensing::SceneAtEnd(double dt_s, const Collidables& collidables,
                                 std::span<const Body> bodies) {
  if (!at_end_) Fill(0, dt_s, collidables, bodies);
  return scene_;
}

}  // namespace giveway::sim
