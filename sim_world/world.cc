#include "sim_world/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/types/check.h"
#include "sim_world/start_place.h"

namespace giveway::sim {
namespace {

bool IsFinite(WheelSpeeds wheels) {
  return std::isfinite(wheels.left_rad_s) && std::isfinite(wheels.right_rad_s);
}

// Null if no body has that id.
template <typename Bodies>
auto* FindIn(Bodies& bodies, VehicleId vehicle) {
  const auto found = std::ranges::lower_bound(bodies, vehicle, {}, &Body::vehicle);
  return found == bodies.end() || found->vehicle != vehicle ? nullptr : &*found;
}

void AddTo(StateHash* hash, Vec2 position_world) {
  hash->Add(position_world.x);
  hash->Add(position_world.y);
}

}  // namespace

World::World(const Scenario& scenario, WorldEpoch epoch, ParallelFor parallel)
    : epoch_(epoch),
      seed_(scenario.seed),
      dt_s_(Seconds(scenario.tick_period)),
      watchdog_ticks_(scenario.watchdog_ticks),
      parallel_(std::move(parallel)),
      obstacles_(scenario.obstacles.begin(), scenario.obstacles.end()),
      doors_(scenario.doors.begin(), scenario.doors.end()),
      contacts_(scenario.walls),
      separation_(scenario.expect.parted),
      sensing_(scenario) {
  GIVEWAY_CHECK(std::ranges::is_sorted(scenario.vehicles, {}, &VehicleOptions::id));
  bodies_.reserve(scenario.vehicles.size());
  collidables_.motions.resize(obstacles_.size());
  collidables_.leaves.resize(doors_.size());
  collidables_.present.resize(obstacles_.size() + doors_.size());
  for (const VehicleOptions& options : scenario.vehicles) Insert(options);
  new_contacts_.reserve(bodies_.size());
}

Body* World::Find(VehicleId vehicle) { return FindIn(bodies_, vehicle); }
const Body* World::Find(VehicleId vehicle) const { return FindIn(bodies_, vehicle); }

std::uint32_t World::ThingOf(const Body& body) const {
  return static_cast<std::uint32_t>(&body - bodies_.data());
}

// Inserts at the body's index into every list that is indexed like bodies_.
void World::Insert(const VehicleOptions& options) {
  Body body;
  body.vehicle = options.id;
  body.profile = options.profile;
  body.goal = options.goal;
  body.goal.set = HasGoal(options);
  body.start_world = options.start_world;
  body.sonar_refresh = options.sonar_refresh;
  const auto at = std::ranges::lower_bound(bodies_, options.id, {}, &Body::vehicle);
  const auto place = at - bodies_.begin();
  bodies_.insert(at, body);
  collidables_.motions.insert(collidables_.motions.begin() + place,
                              StandingAt(options.profile, options.start_world));
  collidables_.present.insert(collidables_.present.begin() + place, 0);
  ++collidables_.bodies;
  sensing_.Insert(static_cast<std::size_t>(place), options.profile);
}

void World::Appear(Body* body) {
  body->joined = true;
  body->present = true;
  body->world_from_body = body->start_world;
  body->wheels = {};
  body->encoders = {};
  body->counted = {};
  body->ground = {};
  body->obeyed = false;
  body->command = {};
  body->sonar = {};
  collidables_.motions[ThingOf(*body)] = StandingAt(body->profile, body->start_world);
}

void World::Join(VehicleId vehicle) {
  Body* body = Find(vehicle);
  GIVEWAY_CHECK(body != nullptr && !body->present, Number(vehicle));
  Appear(body);
}

void World::Join(const VehicleOptions& options) {
  if (Body* known = Find(options.id)) {
    GIVEWAY_CHECK(!known->present, Number(options.id));
    known->profile = options.profile;
    known->goal = options.goal;
    known->goal.set = HasGoal(options);
    known->start_world = options.start_world;
    known->sonar_refresh = options.sonar_refresh;
    sensing_.Replace(ThingOf(*known), options.profile);
  } else {
    Insert(options);
  }
  Join(options.id);
}

void World::Remove(VehicleId vehicle) {
  Body* body = Find(vehicle);
  GIVEWAY_CHECK(body != nullptr && body->present, Number(vehicle));
  body->present = false;
  body->wheels = {};
  body->encoders = {};
  body->ground = {};
  collidables_.present[ThingOf(*body)] = 0;
  active_contacts_.EndIf([&](const ContactPair& pair) {
    return pair.vehicle == vehicle ||
           (pair.touched == Touched::kVehicle && pair.other == Number(vehicle));
  });
}

// Erases the body's index from every list that is indexed like bodies_.
void World::Forget(VehicleId vehicle) {
  const Body* body = Find(vehicle);
  GIVEWAY_CHECK(body != nullptr && !body->present, Number(vehicle));
  const auto place = static_cast<std::ptrdiff_t>(ThingOf(*body));
  bodies_.erase(bodies_.begin() + place);
  collidables_.motions.erase(collidables_.motions.begin() + place);
  collidables_.present.erase(collidables_.present.begin() + place);
  --collidables_.bodies;
  sensing_.Erase(static_cast<std::size_t>(place));
}

bool World::IsFree(const VehicleOptions& options) const {
  const Motion wanted = StandingAt(options.profile, options.start_world);
  const auto touches = [&](const auto& other) { return GapAt(wanted, other, 0) <= kTouch_m; };
  const double unaware_s = watchdog_ticks_ * dt_s_;
  const double leaving_s = driving_ ? LeavingSeconds(options.profile) : 0;
  return !contacts_.TouchesWall(wanted) && std::ranges::none_of(bodies_, [&](const Body& body) {
    return body.present && body.vehicle != options.id && HitsWhileStopping(body, unaware_s, wanted);
  }) && std::ranges::none_of(obstacles_, [&](const MovingObstacle& obstacle) {
    return HitsOnItsCourse(obstacle, leaving_s, dt_s_, wanted);
  }) && std::ranges::none_of(doors_, [&](const SlidingDoor& door) {
    return door.Opening() < 1 && touches(door.Plan(false, 0, dt_s_));
  });
}

bool World::Take(const MotorCommand& command) {
  const auto refuse = [](std::uint32_t* counter) {
    ++*counter;
    return false;
  };
  if (command.epoch != epoch_) return refuse(&commands_.wrong_epoch);
  Body* body = Find(command.vehicle);
  if (body == nullptr || !body->present) return refuse(&commands_.unknown_vehicle);
  if (!IsFinite(command.target)) return refuse(&commands_.not_finite);
  if (command.tick < body->command.tick || command.tick > now_) {
    return refuse(&commands_.out_of_order);
  }
  body->command = command;
  ++commands_.accepted;
  return true;
}

Checkpoint World::Save() const {
  Checkpoint checkpoint{.now = now_, .driven_ticks = driven_ticks_, .contacts = contact_count_};
  for (const Body& body : bodies_) {
    if (body.joined) {
      checkpoint.bodies.push_back({body.vehicle, body.world_from_body, body.wheels, body.counted,
                                   body.command, body.present});
    }
  }
  for (const MovingObstacle& obstacle : obstacles_) {
    checkpoint.obstacles.push_back(obstacle.State());
  }
  for (const SlidingDoor& door : doors_) checkpoint.door_openings.push_back(door.Opening());
  checkpoint.touching = active_contacts_.Pairs();
  checkpoint.separation = separation_.Save();
  return checkpoint;
}

bool World::Restore(const Checkpoint& checkpoint) {
  const bool fits = checkpoint.obstacles.size() == obstacles_.size() &&
                    checkpoint.door_openings.size() == doors_.size() &&
                    std::ranges::all_of(checkpoint.bodies, [&](const BodyState& state) {
                      return !state.present || Find(state.vehicle) != nullptr;
                    });
  if (!fits) return false;
  now_ = checkpoint.now;
  driven_ticks_ = checkpoint.driven_ticks;
  contact_count_ = checkpoint.contacts;
  for (const Body& body : bodies_) {
    if (body.present) Remove(body.vehicle);
  }
  for (const BodyState& state : checkpoint.bodies) {
    Body* body = Find(state.vehicle);
    if (body == nullptr) continue;  // of a vehicle without a slot that was removed
    Appear(body);
    body->present = state.present;
    body->world_from_body = state.world_from_body;
    body->wheels = state.wheels;
    body->counted = state.counted;
    body->command = state.command;
  }
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    obstacles_[i].Restore(checkpoint.obstacles[i]);
  }
  for (std::size_t i = 0; i < doors_.size(); ++i) doors_[i].Restore(checkpoint.door_openings[i]);
  active_contacts_.Restore(checkpoint.touching);
  separation_.Restore(checkpoint.separation);
  return true;
}

OwnerFacts World::FactsOf(Owner owner) const {
  if (collidables_.IsLeaf(owner)) {
    const Leaf& leaf = collidables_.LeafOf(owner);
    return {.velocity_world = leaf.stop_s < dt_s_ ? Vec2{} : leaf.to_velocity_world,
            .seen_class = SeenClass::kFixture};
  }
  const Motion& motion = collidables_.motions[owner];
  OwnerFacts facts;
  if (collidables_.IsBody(owner)) {
    facts.seen_class = SeenClass::kVehicle;
  } else {
    const bool cart = obstacles_[owner - bodies_.size()].EverMoves();
    facts.seen_class = cart ? SeenClass::kCart : SeenClass::kFixture;
  }
  if (motion.stop_s < dt_s_) return facts;
  facts.velocity_world = motion.slide_world;
  if (collidables_.IsBody(owner)) {
    facts.velocity_world = motion.twist.forward_m_s * Forward(bodies_[owner].world_from_body);
    facts.turn_rad_s = motion.twist.turn_rad_s;
  }
  return facts;
}

void World::AddTo(StateHash* hash) const {
  for (const Body& body : bodies_) {
    hash->Add(body.vehicle);
    hash->Add(body.present);
    sim::AddTo(hash, body.world_from_body.position_world);
    hash->Add(body.world_from_body.heading_rad);
    hash->Add(body.wheels.left_rad_s);
    hash->Add(body.wheels.right_rad_s);
    hash->Add(body.counted.left_rad);
    hash->Add(body.counted.right_rad);
  }
  hash->Add(contact_count_);
  for (const MovingObstacle& obstacle : obstacles_) {
    sim::AddTo(hash, obstacle.State().position_world);
    hash->Add(obstacle.State().progress_m);
  }
  for (const SlidingDoor& door : doors_) hash->Add(door.Opening());
}

}  // namespace giveway::sim
