// World::Advance: one tick. The rest is in world.cc.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "sim_world/dynamics/drive.h"
#include "sim_world/world.h"

namespace giveway::sim {
namespace {

// A touching pair has parted once its gap is wider than this: shells sliding along each other at
// kTouch_m are one contact, not hundreds.
constexpr double kRelease_m = 1e-3;

// Slip and encoder noise of one vehicle in one tick: a stream of its own, independent of all other
// draws.
Random RollRandom(std::uint32_t seed, VehicleId vehicle, std::uint32_t tick) {
  constexpr std::uint64_t kRoll = 0x726f6c6cULL << 32;
  return Random(kRoll | seed, std::uint64_t{Number(vehicle)} << 32 | tick);
}

WheelSpeeds Scaled(double share, WheelSpeeds wheels) {
  return {share * wheels.left_rad_s, share * wheels.right_rad_s};
}

// The disc that a leaf cannot leave within the tick.
Ball BallRound(const Leaf& leaf, double dt_s, std::uint32_t thing) {
  return {.centre_world = 0.5 * (leaf.from_world + leaf.to_world),
          .reach_m = 0.5 * Norm(leaf.to_world - leaf.from_world) + TravelBound(leaf, dt_s),
          .thing = thing};
}

}  // namespace

void World::Advance(bool driving) {
  now_ = After(now_, 1);
  driving_ = driving;
  if (driving && ++driven_ticks_ == 1) {
    for (Body& body : bodies_) body.sonar = {};  // how far a round was depends on the wait
  }
  new_contacts_.clear();
  Plan(driving);
  const std::span<const NearPair> near_bodies = FindPairs(driving);
  for (const Hit& hit : contacts_.StopAll(neighbours_.Pairs(), dt_s_, parallel_, &collidables_)) {
    Note(hit);
  }
  Settle();
  if (driving) separation_.Observe(bodies_, collidables_, near_bodies, dt_s_);
  active_contacts_.EndIf([this](const ContactPair& pair) { return HasParted(pair); });
  sensing_.Sense(SonarTickOf(driving), dt_s_, collidables_, parallel_, bodies_);
}

// While the run waits, slots go by on a count of their own. Draws are those of the tick to come: a
// vehicle remembers the last of them, which so does not depend on the length of the wait.
SonarTick World::SonarTickOf(bool driving) const {
  if (driving) return {now_, Tick{driven_ticks_}, Tick{driven_ticks_}};
  return {now_, Tick{driven_ticks_ + 1}, Tick{Number(now_) - driven_ticks_}};
}

// The motion of everything in this tick if nothing obstructed it.
void World::Plan(bool driving) {
  const auto plan = [&](std::size_t begin, std::size_t end) {
    for (; begin != end; ++begin) {
      if (bodies_[begin].present) PlanBody(driving, begin);
    }
  };
  parallel_(bodies_.size(), std::ref(plan));
  PlanOthers(driving);
}

const DriveFault* World::FaultOf(VehicleId vehicle) const {
  const auto fault = std::ranges::lower_bound(drive_faults_, vehicle, {}, &DriveFault::vehicle);
  return fault == drive_faults_.end() || fault->vehicle != vehicle ? nullptr : &*fault;
}

void World::PlanBody(bool driving, std::size_t i) {
  Body& body = bodies_[i];
  body.obeyed = driving && body.command.tick != kNoTick &&
                TicksBetween(body.command.tick, now_) <= watchdog_ticks_;
  WheelSpeeds target = body.obeyed ? body.command.target : WheelSpeeds{};
  const DriveFault* fault = drive_faults_.empty() ? nullptr : FaultOf(body.vehicle);
  if (fault != nullptr) target = Scaled(fault->reaches, target);
  const bool stuck = fault != nullptr && fault->stuck.has_value();
  body.wheels = stuck ? *fault->stuck : MoveWheels(body.profile, body.wheels, target, dt_s_);
  const Rolled rolled =
      Roll(body.profile, body.wheels, RollRandom(seed_, body.vehicle, driven_ticks_));
  body.ground = rolled.ground;
  body.encoders = fault == nullptr ? rolled.encoders : Scaled(fault->counts, rolled.encoders);
  Motion& motion = collidables_.motions[i];
  motion.start_world = body.world_from_body;
  motion.twist = TwistFromWheels(body.profile.drive, body.ground);
  motion.stop_s = dt_s_;
  collidables_.present[i] = 1;
}

void World::PlanOthers(bool driving) {
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    collidables_.motions[bodies_.size() + i] = obstacles_[i].Plan(driving, dt_s_);
    collidables_.present[bodies_.size() + i] = 1;
  }
  for (std::size_t i = 0; i < doors_.size(); ++i) {
    const Leaf leaf = doors_[i].Plan(driving, driven_ticks_ * dt_s_, dt_s_);
    collidables_.leaves[i] = leaf;
    collidables_.present[collidables_.motions.size() + i] = doors_[i].Opening() < 1 || Moves(leaf);
  }
}

// Finds the pairs that may touch in this tick. Returns, perhaps among others of these, the pairs of
// bodies that may come nearer than any two did before: that may be far, and other things are not
// searched that far.
std::span<const NearPair> World::FindPairs(bool driving) {
  balls_.clear();
  std::size_t bodies = 0;
  for (std::uint32_t i = 0; i < collidables_.Count(); ++i) {
    if (collidables_.present[i] == 0) continue;
    if (collidables_.IsBody(i)) ++bodies;  // their balls come first
    if (collidables_.IsLeaf(i)) {
      balls_.push_back(BallRound(collidables_.LeafOf(i), dt_s_, i));
    } else {
      const Motion& motion = collidables_.motions[i];
      balls_.push_back(
          {motion.start_world.position_world, motion.radius_m + TravelBound(motion, dt_s_), i});
    }
  }
  const auto of_bodies = std::span<const Ball>(balls_).first(bodies);
  const bool records = driving && bodies > 1;
  const double record_m = records ? separation_.Reach().value_or(kTouch_m) : kTouch_m;
  const bool alike = bodies == balls_.size();  // one search finds both
  neighbours_.Find(balls_, alike ? std::max(kTouch_m, record_m) : kTouch_m, parallel_);
  if (records && !separation_.Reach()) {
    FindFirstPairs(of_bodies);
  } else if (!alike && record_m > kTouch_m) {
    body_neighbours_.Find(of_bodies, record_m, parallel_);
  } else {
    return neighbours_.Pairs();
  }
  return body_neighbours_.Pairs();
}

// Without a record to come nearer than: the nearest two, searched in ever wider circles. However
// they move, the nearest in this tick is no further than they are now.
void World::FindFirstPairs(std::span<const Ball> of_bodies) {
  double nearest_m = std::numeric_limits<double>::infinity();
  double searched_m = 0;
  for (double margin_m = 1; nearest_m > searched_m; margin_m = std::min(4 * margin_m, nearest_m)) {
    body_neighbours_.Find(of_bodies, margin_m, parallel_);
    searched_m = margin_m;
    for (const NearPair& pair : body_neighbours_.Pairs()) {
      nearest_m =
          std::min(nearest_m, GapAt(collidables_.motions[pair.a], collidables_.motions[pair.b], 0));
    }
  }
}

void World::Note(const Hit& hit) {
  const std::uint32_t lower = hit.wall ? hit.a : hit.b;
  if (!collidables_.IsBody(lower)) return;  // a cart that was held up by something
  const Motion& motion = collidables_.motions[lower];
  // The lower id comes first, so that an event reads the same however the pair was found.
  Contact contact{.vehicle = bodies_[lower].vehicle, .position_world = PositionAt(motion, hit.t_s)};
  ContactPair pair{.vehicle = contact.vehicle};
  const Outline outline = OutlineAt(motion, hit.t_s);
  if (hit.wall) {
    contact.touched = Touched::kWall;
    pair.other = hit.b;
    contact.other_position_world =
        NearestBetween(outline, OutlineOf(contacts_.Walls()[hit.b])).on_b_world;
  } else if (collidables_.IsBody(hit.a)) {
    contact.other = bodies_[hit.a].vehicle;
    pair.other = Number(contact.other);
    contact.other_position_world = PositionAt(collidables_.motions[hit.a], hit.t_s);
  } else {
    const bool door = collidables_.IsLeaf(hit.a);
    contact.touched = door ? Touched::kDoor : Touched::kObstacle;
    pair.other =
        static_cast<std::uint32_t>(hit.a - (door ? collidables_.motions.size() : bodies_.size()));
    const Outline other = door ? OutlineAt(collidables_.LeafOf(hit.a), hit.t_s)
                               : OutlineAt(collidables_.motions[hit.a], hit.t_s);
    contact.other_position_world = NearestBetween(outline, other).on_b_world;
  }
  pair.touched = contact.touched;
  if (!active_contacts_.Begin(pair)) return;
  ++contact_count_;
  new_contacts_.push_back(contact);
}

void World::Settle() {
  const auto settle = [&](std::size_t begin, std::size_t end) {
    for (; begin != end; ++begin) {
      if (bodies_[begin].present) SettleBody(begin);
    }
  };
  parallel_(bodies_.size(), std::ref(settle));
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    obstacles_[i].Settle(collidables_.motions[bodies_.size() + i], driving_, dt_s_);
  }
  for (std::size_t i = 0; i < doors_.size(); ++i) doors_[i].Settle(collidables_.leaves[i], dt_s_);
}

void World::SettleBody(std::size_t i) {
  Body& body = bodies_[i];
  if (collidables_.motions[i].stop_s < dt_s_) {
    // The wheels turned for a part of the tick only: over the whole of it, that much slower.
    const double share = collidables_.motions[i].stop_s / dt_s_;
    body.encoders = Scaled(share, body.encoders);
    body.ground = Scaled(share, body.ground);
    body.wheels = {};
  }
  body.counted = CountOn(body.counted, body.encoders, dt_s_);
  // From the speeds over the whole tick, so that any integration of them gives the same bits.
  body.heading.Follow(body.world_from_body);
  body.world_from_body = AdvanceArc(body.world_from_body, body.heading.forward_world,
                                    TwistFromWheels(body.profile.drive, body.ground), dt_s_);
}

bool World::HasParted(const ContactPair& pair) const {
  const Body* body = Find(pair.vehicle);
  const Motion& motion = collidables_.motions[ThingOf(*body)];
  const auto parted = [&](const auto& other) { return GapAt(motion, other, dt_s_) > kRelease_m; };
  switch (pair.touched) {
    case Touched::kWall:
      return parted(contacts_.Walls()[pair.other]);
    case Touched::kObstacle:
      return parted(collidables_.motions[bodies_.size() + pair.other]);
    case Touched::kDoor:
      return doors_[pair.other].Opening() == 1 || parted(collidables_.leaves[pair.other]);
    case Touched::kVehicle:
      return parted(collidables_.motions[ThingOf(*Find(VehicleId{pair.other}))]);
  }
  return true;
}

}  // namespace giveway::sim
