#include "sim_world/world.h"

#include <algorithm>
#include <cmath>

#include "services/types/check.h"
#include "sim_world/drive.h"
#include "sim_world/geometry.h"

namespace giveway::sim {
namespace {

// A touching pair has parted once its gap is wider than this: shells sliding along each other at
// kTouch_m are one contact, not hundreds.
constexpr double kRelease_m = 1e-3;

Body BodyOf(const VehicleOptions& options) {
  Body body;
  body.vehicle = options.id;
  body.profile = options.profile;
  body.goal = options.goal;
  return body;
}

bool IsFinite(WheelSpeeds wheels) {
  return std::isfinite(wheels.left_rad_s) && std::isfinite(wheels.right_rad_s);
}

double TravelBound(const Motion& motion, double dt_s) {
  return std::abs(motion.twist.forward_m_s) * dt_s;
}

bool Within(Vec2 offset, double reach_m) { return SquaredNorm(offset) <= reach_m * reach_m; }

}  // namespace

World::World(const Scenario& scenario, WorldEpoch epoch)
    : epoch_(epoch),
      dt_s_(Seconds(scenario.tick_period)),
      watchdog_ticks_(scenario.watchdog_ticks),
      walls_(scenario.walls),
      motions_(scenario.vehicles.size()),
      touching_pairs_(PairCount(scenario.vehicles.size())),
      touching_walls_(scenario.vehicles.size() * scenario.walls.size()),
      separation_(scenario.vehicles.size()) {
  for (const VehicleOptions& options : scenario.vehicles) {
    bodies_.push_back(BodyOf(options));
    starts_world_.push_back(options.start_world);
    rings_.emplace_back(options.profile);
  }
  GIVEWAY_CHECK(std::ranges::is_sorted(bodies_, {}, &Body::vehicle));
  discs_.reserve(bodies_.size());
  new_contacts_.reserve(bodies_.size());
}

Body* World::Find(VehicleId vehicle) {
  const auto found = std::ranges::lower_bound(bodies_, vehicle, {}, &Body::vehicle);
  return found == bodies_.end() || found->vehicle != vehicle ? nullptr : &*found;
}

void World::Join(VehicleId vehicle) {
  Body* body = Find(vehicle);
  GIVEWAY_CHECK(body != nullptr && !body->joined, Number(vehicle));
  body->joined = true;
  body->present = true;
  body->world_from_body = starts_world_[static_cast<std::size_t>(body - bodies_.data())];
}

void World::Remove(VehicleId vehicle) {
  Body* body = Find(vehicle);
  GIVEWAY_CHECK(body != nullptr && body->present, Number(vehicle));
  body->present = false;
  body->wheels = {};
  body->encoders = {};
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

void World::Advance(bool driving) {
  now_ = After(now_, 1);
  new_contacts_.clear();
  TurnWheels(driving);
  StopAtContacts();
  if (driving) separation_.Observe(bodies_, motions_, dt_s_);
  Settle();
  ReleaseContacts();
  Sense();
}

void World::TurnWheels(bool driving) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    if (!body.present) continue;
    body.obeyed = driving && body.command.tick != kNoTick &&
                  TicksBetween(body.command.tick, now_) <= watchdog_ticks_;
    const WheelSpeeds target = body.obeyed ? body.command.target : WheelSpeeds{};
    body.wheels = MoveWheels(body.profile, body.wheels, target, dt_s_);
    body.encoders = body.wheels;
    motions_[i] = {.start_world = body.world_from_body,
                   .twist = TwistFromWheels(body.profile.drive, body.wheels),
                   .stop_s = dt_s_,
                   .radius_m = body.profile.body_radius_m};
  }
}

// Every hit stops a body that moved, so this ends.
void World::StopAtContacts() {
  double from_s = 0;
  while (const std::optional<Hit> hit = EarliestHit(from_s)) {
    Stop(*hit);
    from_s = hit->t_s;
  }
}

std::optional<World::Hit> World::EarliestHit(double from_s) const {
  std::optional<Hit> earliest;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i].present) continue;
    EarliestBodyHit(i, from_s, &earliest);
    EarliestWallHit(i, from_s, &earliest);
  }
  return earliest;
}

void World::EarliestBodyHit(std::size_t body, double from_s, std::optional<Hit>* earliest) const {
  const Motion& motion = motions_[body];
  for (std::size_t other = 0; other < body; ++other) {
    if (!bodies_[other].present) continue;
    const Motion& against = motions_[other];
    const double travel_m = TravelBound(motion, dt_s_) + TravelBound(against, dt_s_);
    if (travel_m == 0) continue;
    const Vec2 offset = motion.start_world.position_world - against.start_world.position_world;
    if (!Within(offset, motion.radius_m + against.radius_m + travel_m + kTouch_m)) continue;
    const double to_s = *earliest ? (*earliest)->t_s : dt_s_;
    const std::optional<double> t_s = FirstContact(motion, against, from_s, to_s);
    if (t_s && (!*earliest || *t_s < to_s)) *earliest = Hit{*t_s, body, other, 0};
  }
}

void World::EarliestWallHit(std::size_t body, double from_s, std::optional<Hit>* earliest) const {
  const Motion& motion = motions_[body];
  const double travel_m = TravelBound(motion, dt_s_);
  if (travel_m == 0) return;
  const Vec2 position = motion.start_world.position_world;
  for (std::size_t wall = 0; wall < walls_.size(); ++wall) {
    const Vec2 nearest = NearestOnSegment(walls_[wall].from_world, walls_[wall].to_world, position);
    if (!Within(position - nearest, motion.radius_m + travel_m + kTouch_m)) continue;
    const double to_s = *earliest ? (*earliest)->t_s : dt_s_;
    const std::optional<double> t_s = FirstContact(motion, walls_[wall], from_s, to_s);
    if (t_s && (!*earliest || *t_s < to_s)) *earliest = Hit{*t_s, body, std::nullopt, wall};
  }
}

std::uint8_t& World::Touching(const Hit& hit) {
  if (hit.other) return touching_pairs_[PairIndex(hit.body, *hit.other)];
  return touching_walls_[hit.body * walls_.size() + hit.wall];
}

void World::Stop(const Hit& hit) {
  const auto stop = [&](std::size_t i) {
    motions_[i].stop_s = std::min(motions_[i].stop_s, hit.t_s);
  };
  stop(hit.body);
  if (hit.other) stop(*hit.other);
  std::uint8_t& touching = Touching(hit);
  if (touching != 0) return;
  touching = 1;
  ++contacts_;
  const Vec2 position = PositionAt(motions_[hit.body], hit.t_s);
  // The lower id comes first, so that an event reads the same however the pair was found.
  if (hit.other) {
    new_contacts_.push_back({.vehicle = bodies_[*hit.other].vehicle,
                             .other = bodies_[hit.body].vehicle,
                             .position_world = PositionAt(motions_[*hit.other], hit.t_s),
                             .other_position_world = position});
  } else {
    const Wall& wall = walls_[hit.wall];
    new_contacts_.push_back(
        {.vehicle = bodies_[hit.body].vehicle,
         .other = kNobody,
         .position_world = position,
         .other_position_world = NearestOnSegment(wall.from_world, wall.to_world, position)});
  }
}

void World::Settle() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    if (!body.present) continue;
    if (motions_[i].stop_s < dt_s_) {
      // The encoders turned for a part of the tick only: over the whole of it, that much slower.
      const double share = motions_[i].stop_s / dt_s_;
      body.encoders = {share * body.wheels.left_rad_s, share * body.wheels.right_rad_s};
      body.wheels = {};
    }
    // From the encoders, so that whoever integrates them lands on the same bits.
    body.world_from_body =
        AdvanceArc(body.world_from_body, TwistFromWheels(body.profile.drive, body.encoders), dt_s_);
  }
}

void World::ReleaseContacts() {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Body& body = bodies_[b];
    const Vec2 position = body.world_from_body.position_world;
    const double radius_m = body.profile.body_radius_m;
    for (std::size_t a = 0; a < b; ++a) {
      const double reach_m = radius_m + bodies_[a].profile.body_radius_m + kRelease_m;
      const Vec2 offset = position - bodies_[a].world_from_body.position_world;
      if (!Within(offset, reach_m)) touching_pairs_[PairIndex(a, b)] = 0;
    }
    for (std::size_t w = 0; w < walls_.size(); ++w) {
      const Vec2 nearest = NearestOnSegment(walls_[w].from_world, walls_[w].to_world, position);
      if (!Within(position - nearest, radius_m + kRelease_m)) {
        touching_walls_[b * walls_.size() + w] = 0;
      }
    }
  }
}

void World::Sense() {
  discs_.clear();
  for (const Body& body : bodies_) {
    if (body.present) {
      discs_.push_back({body.world_from_body.position_world, body.profile.body_radius_m});
    }
  }
  std::size_t self = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i].present) continue;
    bodies_[i].readings = rings_[i].Sense(bodies_[i].world_from_body, now_, discs_, self, walls_);
    ++self;
  }
}

void World::AddTo(StateHash* hash) const {
  for (const Body& body : bodies_) {
    hash->Add(body.vehicle);
    hash->Add(body.present);
    hash->Add(body.world_from_body.position_world.x);
    hash->Add(body.world_from_body.position_world.y);
    hash->Add(body.world_from_body.heading_rad);
    hash->Add(body.wheels.left_rad_s);
    hash->Add(body.wheels.right_rad_s);
  }
  hash->Add(contacts_);
}

}  // namespace giveway::sim
