#include "tests/bench/baseline/rvo.h"

#include <algorithm>

#include "services/types/math/math.h"

namespace giveway::bench {
namespace {

Vec2 Unit(Vec2 v) {
  const double length = Norm(v);
  return length > 0 ? 1 / length * v : Vec2{1, 0};
}

// From the relative velocity to the nearest point on the rim of the obstacle, and the direction
// outwards there.
struct ConeExit {
  Vec2 change;
  Vec2 outward;  // of length 1
};

ConeExit FromDisc(Vec2 relative_velocity, Vec2 centre, double radius) {
  const Vec2 offset = relative_velocity - centre;
  const Vec2 outward = Unit(offset);
  return {(radius - Norm(offset)) * outward, outward};
}

// The sides of the cone of velocities that lead into a disc at `apart`.
ConeExit FromSide(Vec2 relative_velocity, Vec2 apart, double radius) {
  const double reach = Sqrt(SquaredNorm(apart) - radius * radius);
  const bool on_left = Cross(apart, relative_velocity) > 0;
  const Vec2 side =
      1 / SquaredNorm(apart) * (reach * apart + (on_left ? radius : -radius) * Left(apart));
  const Vec2 along = Unit(side);
  return {Dot(relative_velocity, along) * along - relative_velocity,
          on_left ? Left(along) : -1 * Left(along)};
}

ConeExit OutOfObstacle(Vec2 relative_velocity, Vec2 apart, double radius, double horizon_s) {
  const Vec2 centre = 1 / horizon_s * apart;
  const Vec2 offset = relative_velocity - centre;
  const double back = Dot(offset, apart);
  // The rounded end of the cone faces what is slower than reaching the disc at the horizon.
  if (back < 0 && back * back > radius * radius * SquaredNorm(offset)) {
    return FromDisc(relative_velocity, centre, radius / horizon_s);
  }
  return FromSide(relative_velocity, apart, radius);
}

}  // namespace

HalfPlane ReciprocalPlane(const Mover& own, const Mover& other, double horizon_s, double step_s) {
  const Vec2 apart = other.position_world - own.position_world;
  const Vec2 relative_velocity = own.velocity_world - other.velocity_world;
  const double radius = own.radius_m + other.radius_m;
  const bool overlap = SquaredNorm(apart) <= radius * radius;
  const ConeExit out = overlap ? FromDisc(relative_velocity, 1 / step_s * apart, radius / step_s)
                               : OutOfObstacle(relative_velocity, apart, radius, horizon_s);
  return {own.velocity_world + 0.5 * out.change, out.outward};
}

Rvo::Rvo(const Scenario& scenario, const RvoSettings& settings)
    : settings_(settings),
      step_s_(Seconds(scenario.tick_period)),
      vehicles_(scenario.vehicles),
      random_(scenario.seed, scenario.vehicles.size()),
      movers_(scenario.vehicles.size()) {}

Mover Rvo::MoverOf(const VehicleOptions& options, const Seen& seen) const {
  const Twist twist = TwistFromWheels(options.profile.drive, seen.wheels);
  const Vec2 forward = Forward(seen.world_from_body);
  const double ahead_m = settings_.ahead_m;
  return {
      .position_world = seen.world_from_body.position_world + ahead_m * forward,
      .velocity_world = twist.forward_m_s * forward + twist.turn_rad_s * ahead_m * Left(forward),
      .radius_m = options.profile.body_radius_m + ahead_m + settings_.margin_m};
}

void Rvo::FindPlanes(std::size_t own) {
  const auto distance = [&](std::size_t i) {
    return SquaredNorm(movers_[i].position_world - movers_[own].position_world);
  };
  nearest_.clear();
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    if (i == own || distance(i) > settings_.neighbour_m * settings_.neighbour_m) continue;
    nearest_.push_back(i);
  }
  std::ranges::sort(nearest_, {}, distance);
  if (nearest_.size() > settings_.neighbours) nearest_.resize(settings_.neighbours);
  planes_.clear();
  for (const std::size_t i : nearest_) {
    planes_.push_back(ReciprocalPlane(movers_[own], movers_[i], settings_.horizon_s, step_s_));
  }
}

Vec2 Rvo::Wanted(const VehicleOptions& options, const Seen& seen) {
  const Vec2 jitter{random_.Uniform(-1, 1), random_.Uniform(-1, 1)};
  const Vec2 to_goal = options.goal.at_world - seen.world_from_body.position_world;
  constexpr double kPushedOff_m = 0.3;
  const bool stays = seen.arrived && Norm(to_goal) < kPushedOff_m;
  const Vec2 wanted = stays ? Vec2{} : options.cruise_m_s * Unit(to_goal);
  return wanted + settings_.jitter_m_s * jitter;
}

WheelSpeeds Rvo::Follow(const VehicleOptions& options, const Pose& pose,
                        Vec2 velocity_world) const {
  const Vec2 forward = Forward(pose);
  const double turn = Dot(velocity_world, Left(forward)) / settings_.ahead_m;
  const double most = options.profile.max_turn_rad_s;
  return WheelsFromTwist(options.profile.drive,
                         {Dot(velocity_world, forward), std::clamp(turn, -most, most)});
}

void Rvo::Drive(std::uint32_t tick, std::span<const Seen> fleet, std::span<WheelSpeeds> wheels) {
  static_cast<void>(tick);
  for (std::size_t i = 0; i < vehicles_.size(); ++i) movers_[i] = MoverOf(vehicles_[i], fleet[i]);
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    FindPlanes(i);
    const Vec2 wanted = Wanted(vehicles_[i], fleet[i]);
    const Vec2 velocity = NearestTolerable(planes_, vehicles_[i].cruise_m_s, wanted);
    wheels[i] = Follow(vehicles_[i], fleet[i].world_from_body, velocity);
  }
}

}  // namespace giveway::bench
