#include "services/config/vehicle_read.h"

#include <fmt/format.h>

#include <algorithm>

#include "services/config/pose_read.h"
#include "services/types/fleet_limits.h"
#include "services/types/math/math.h"

namespace giveway {
namespace {

constexpr int kFrontSensors = 8;
constexpr Allowed kHalfSide{0.05, 10, "m"};

Goal ReadGoal(const Section& section, double cruise_m_s, Nanoseconds tick_period) {
  Goal goal{.set = true, .at_world = ReadPoint(section)};
  goal.radius_m = section.NumberOr(goal.radius_m, "radius_m", {0, 100, "m", true});
  const double tick_travel_m = cruise_m_s * Seconds(tick_period);
  if (goal.radius_m < tick_travel_m) {
    section.AddError("radius_m",
                     fmt::format("{} m is less than the {:.3f} m driven in a tick at cruise speed: "
                                 "the vehicle may jump over its goal",
                                 goal.radius_m, tick_travel_m),
                     fmt::format("write at least {:.3f}", tick_travel_m));
  }
  return goal;
}

void ReadWeights(const Section& section, const char* field,
                 std::array<double, kSensorCount>* weights) {
  const int count = section.Count(field);
  if (count != kFrontSensors && count != static_cast<int>(kSensorCount)) {
    section.AddError(field, fmt::format("has {} values", count),
                     "write 8 values (front ring) or 16, in left and in right");
    return;
  }
  const std::vector<double> given = section.Numbers(field, {-100, 100, "rad/s"}, kSensorCount);
  weights->fill(0);
  std::copy(given.begin(), given.end(), weights->begin());
}

BraitenbergWeights ReadBraitenberg(const Section& section, const BraitenbergWeights& defaults) {
  BraitenbergWeights read = defaults;
  read.base_rad_s = section.NumberOr(read.base_rad_s, "base_rad_s", {0, 100, "rad/s"});
  read.near_gate_m = section.NumberOr(read.near_gate_m, "near_gate_m", {0, 5, "m", true});
  read.far_gate_m = section.NumberOr(read.far_gate_m, "far_gate_m", {0, 5, "m", true});
  if (read.near_gate_m >= read.far_gate_m) {
    section.AddError(section.Has("near_gate_m") ? "near_gate_m" : "far_gate_m",
                     fmt::format("the near gate ({} m) must be below the far gate ({} m)",
                                 read.near_gate_m, read.far_gate_m),
                     "lower the near gate or raise the far gate");
  }
  if (section.Has("left") || section.Has("right")) {
    ReadWeights(section, "left", &read.left);
    ReadWeights(section, "right", &read.right);
  }
  return read;
}

// The wheel on the outside, at top speed and in the tightest turn.
void CheckWheels(const Section& section, const RobotModel& profile) {
  const double fastest_rad_s =
      WheelsFromTwist(profile.drive, {profile.max_speed_m_s, profile.max_turn_rad_s}).right_rad_s;
  if (fastest_rad_s > kMaxWheel_rad_s) {
    section.AddError("profile",
                     fmt::format("at top speed in the tightest turn a wheel rolls at {:.1f} rad/s: "
                                 "peers believe at most {}",
                                 fastest_rad_s, kMaxWheel_rad_s),
                     "lower max_speed_m_s or max_turn_rad_s, or raise wheel_radius_m");
  }
}

// The shape a section writes; one that writes none leaves the body as it was.
void ReadBody(const Section& section, RobotModel* profile) {
  const auto box = section.Child("box");
  if (box) {
    profile->shape = BodyShape::kBox;
    profile->box_half_m = ReadBox(*box);
    profile->body_radius_m = Norm(profile->box_half_m);
  }
  if (!section.Has("body_radius_m")) return;
  if (box) {
    section.AddError("body_radius_m", "is given together with box, whose half diagonal it is",
                     "remove one of the two");
    return;
  }
  profile->shape = BodyShape::kDisc;
  profile->box_half_m = {};
  profile->body_radius_m = section.Number("body_radius_m", {0.05, 10, "m"});
}

void ReadSensors(const std::optional<Section>& section, RobotModel* profile) {
  if (!section) return;
  profile->radar = section->FlagOr(profile->radar, "radar");
  profile->lidar = section->FlagOr(profile->lidar, "lidar");
  profile->camera = section->FlagOr(profile->camera, "camera");
}

Route ReadRoute(const Section& section) {
  Route route;
  const std::vector<Section> waypoints = section.Children("waypoint");
  if (waypoints.size() > kMaxWaypoints) {
    section.AddError("waypoint", fmt::format("there are {} waypoints", waypoints.size()),
                     fmt::format("keep at most {}", kMaxWaypoints));
    return route;
  }
  for (const Section& waypoint : waypoints) {
    route.waypoints_world[route.count++] = ReadPoint(waypoint);
  }
  route.loop = section.FlagOr(false, "loop");
  if (route.loop && route.count == 0) {
    section.AddError("loop", "is true without a waypoint", "write waypoints, or remove loop");
  }
  return route;
}

// All but the id.
VehicleOptions ReadDriver(const Section& section, const VehicleOptions& common,
                          std::optional<Behaviour> forced) {
  VehicleOptions vehicle = common;
  ReadProfile(section.Child("profile"), &vehicle.profile);
  CheckWheels(section, vehicle.profile);
  const auto own = ReadBehaviour(section);  // read even where forced, for its problems
  vehicle.behaviour = forced.value_or(own.value_or(common.behaviour));
  vehicle.start_world = ReadStart(section.RequiredChild("start"));
  // A refused top speed is a problem already; the vehicle's cruise is then judged by its own cap.
  const double top = vehicle.profile.max_speed_m_s;
  vehicle.cruise_m_s =
      section.Number("cruise_m_s", {0, top == top ? top : kMaxSpeed_m_s, "m/s", true});
  if (const auto goal = section.Child("goal")) {
    vehicle.goal = ReadGoal(*goal, vehicle.cruise_m_s, vehicle.tick_period);
  }
  vehicle.braitenberg = WeightsOf(vehicle.behaviour);
  if (const auto weights = section.Child("braitenberg")) {
    vehicle.braitenberg = ReadBraitenberg(*weights, vehicle.braitenberg);
  }
  vehicle.route = ReadRoute(section);
  if (const auto metric = section.Enum("distance_metric")) {
    vehicle.distance_metric =
        static_cast<DistanceMetric>(*metric);  // numbered alike, as behaviours
  }
  return vehicle;
}

}  // namespace

double ReadHeading(const Section& section) {
  const double heading_deg = section.Number("heading_deg", {-360, 360, "degrees"});
  return heading_deg == heading_deg ? WrapAngle(Radians(heading_deg)) : 0;
}

Pose ReadStart(const std::optional<Section>& section, std::optional<double> default_heading_rad) {
  if (!section) return {{kUnusable, kUnusable}, 0};
  const Vec2 position_world = ReadPoint(*section);
  if (default_heading_rad && !section->Has("heading_deg")) {
    return {position_world, *default_heading_rad};
  }
  return {position_world, ReadHeading(*section)};
}

Vec2 ReadBox(const Section& section) {
  return {section.Number("half_length_m", kHalfSide), section.Number("half_width_m", kHalfSide)};
}

Vec2 ReadPoint(const Section& section) {
  return {section.Number("x_m", kCoordinate), section.Number("y_m", kCoordinate)};
}

std::optional<Behaviour> ReadBehaviour(const Section& section) {
  const std::optional<int> choice = section.Enum("behaviour");
  if (!choice) return std::nullopt;
  return static_cast<Behaviour>(*choice);  // numbered alike; a test holds them together
}

void ReadProfile(const std::optional<Section>& section, RobotModel* profile) {
  if (!section) return;
  const auto read = [&](const char* field, const Allowed& allowed, double* value) {
    *value = section->NumberOr(*value, field, allowed);
  };
  ReadBody(*section, profile);
  read("wheel_radius_m", {0.01, 5, "m"}, &profile->drive.wheel_radius_m);
  read("axle_m", {0.02, 20, "m"}, &profile->drive.axle_m);
  read("max_speed_m_s", {0, kMaxSpeed_m_s, "m/s", true}, &profile->max_speed_m_s);
  read("max_turn_rad_s", {0, 20, "rad/s", true}, &profile->max_turn_rad_s);
  read("acceleration_m_s2", {0, 20, "m/s^2", true}, &profile->acceleration_m_s2);
  read("deceleration_m_s2", {0, 20, "m/s^2", true}, &profile->deceleration_m_s2);
  read("wheel_slip", {0, 0.5}, &profile->wheel_slip);
  read("encoder_noise", {0, 0.5}, &profile->encoder_noise);
  ReadSensors(section->Child("sensors"), profile);
  ReadPoseKeeping(*section, profile);
  for (std::size_t i = kSensorCount / 2; i < kSensorCount; ++i) {
    profile->sonar[i].enabled = section->FlagOr(profile->sonar[i].enabled, "rear_sonar");
  }
}

VehicleOptions ReadVehicle(const Section& section, const VehicleOptions& common,
                           std::optional<Behaviour> forced) {
  const VehicleId id{section.Uint("id", kId)};
  VehicleOptions vehicle = ReadDriver(section, common, forced);
  vehicle.id = id;
  return vehicle;
}

VehicleOptions ReadSpawn(const Section& section, const VehicleOptions& common,
                         std::optional<Behaviour> forced) {
  return ReadDriver(section, common, forced);
}

}  // namespace giveway
