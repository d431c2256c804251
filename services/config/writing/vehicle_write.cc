#include "services/config/writing/vehicle_write.h"

#include "scenario.pb.h"
#include "services/config/writing/place_write.h"

namespace giveway {
namespace {

// What the file leaves at the P3-DX's.
template <typename Message>
void SetIfOther(double value, double pioneers, Message* message, void (Message::*set)(double)) {
  if (value != pioneers) (message->*set)(value);
}

void SetBody(const RobotModel& profile, const RobotModel& pioneer, schema::Profile* message) {
  if (profile.shape == BodyShape::kBox) {
    message->mutable_box()->set_half_length_m(profile.box_half_m.x);
    message->mutable_box()->set_half_width_m(profile.box_half_m.y);
  } else {
    SetIfOther(profile.body_radius_m, pioneer.body_radius_m, message,
               &schema::Profile::set_body_radius_m);
  }
}

void SetSensors(const RobotModel& profile, schema::Profile* message) {
  if (profile.radar) message->mutable_sensors()->set_radar(true);
  if (profile.lidar) message->mutable_sensors()->set_lidar(true);
  if (profile.camera) message->mutable_sensors()->set_camera(true);
  const PoseFixModel& fixes = profile.pose_fix;
  if (!fixes.Fitted()) return;
  schema::PoseFix* written = message->mutable_sensors()->mutable_pose_fix();
  written->set_every_s(fixes.every_s);
  written->set_sigma_m(fixes.sigma_m);
  written->set_dropout(fixes.dropout);
  written->set_sigma_heading_deg(DegreesOf(fixes.sigma_heading_rad));
}

// Without a word of it, the limit depends on what else is there.
void SetPoseKeeping(const RobotModel& profile, schema::Profile* message) {
  if (profile.wheel_error.Any()) {
    message->mutable_wheel_error()->set_diameter(profile.wheel_error.diameter);
    message->mutable_wheel_error()->set_axle(profile.wheel_error.axle);
  }
  if (profile.pose_limit_m != 0 || profile.wheel_error.Any() || profile.pose_fix.Fitted()) {
    message->set_pose_limit_m(profile.pose_limit_m);
  }
}

schema::Profile ProfileOf(const RobotModel& profile) {
  using Written = schema::Profile;
  const RobotModel pioneer = PioneerP3dx();
  Written message;
  SetBody(profile, pioneer, &message);
  const auto set = [&](double value, double pioneers, void (Written::*setter)(double)) {
    SetIfOther(value, pioneers, &message, setter);
  };
  set(profile.drive.wheel_radius_m, pioneer.drive.wheel_radius_m, &Written::set_wheel_radius_m);
  set(profile.drive.axle_m, pioneer.drive.axle_m, &Written::set_axle_m);
  set(profile.max_speed_m_s, pioneer.max_speed_m_s, &Written::set_max_speed_m_s);
  set(profile.max_turn_rad_s, pioneer.max_turn_rad_s, &Written::set_max_turn_rad_s);
  set(profile.acceleration_m_s2, pioneer.acceleration_m_s2, &Written::set_acceleration_m_s2);
  set(profile.deceleration_m_s2, pioneer.deceleration_m_s2, &Written::set_deceleration_m_s2);
  set(profile.wheel_slip, 0, &Written::set_wheel_slip);
  set(profile.encoder_noise, 0, &Written::set_encoder_noise);
  if (profile.sonar[kSensorCount - 1].enabled) message.set_rear_sonar(true);
  SetSensors(profile, &message);
  SetPoseKeeping(profile, &message);
  return message;
}

void Set(const BraitenbergWeights& weights, schema::Braitenberg* message) {
  message->set_base_rad_s(weights.base_rad_s);
  message->set_near_gate_m(weights.near_gate_m);
  message->set_far_gate_m(weights.far_gate_m);
  for (const double weight : weights.left) message->add_left(weight);
  for (const double weight : weights.right) message->add_right(weight);
}

// All but the id.
template <typename Message>
void SetDriver(const VehicleOptions& options, Message* message) {
  message->mutable_start()->set_x_m(options.start_world.position_world.x);
  message->mutable_start()->set_y_m(options.start_world.position_world.y);
  message->mutable_start()->set_heading_deg(DegreesOf(options.start_world.heading_rad));
  message->set_cruise_m_s(options.cruise_m_s);
  if (options.goal.set) {
    message->mutable_goal()->set_x_m(options.goal.at_world.x);
    message->mutable_goal()->set_y_m(options.goal.at_world.y);
    message->mutable_goal()->set_radius_m(options.goal.radius_m);
  }
  message->set_behaviour(static_cast<schema::Behaviour>(options.behaviour));
  if (options.braitenberg != WeightsOf(options.behaviour)) {
    Set(options.braitenberg, message->mutable_braitenberg());
  }
  const schema::Profile profile = ProfileOf(options.profile);
  if (profile.ByteSizeLong() > 0) *message->mutable_profile() = profile;
  for (std::uint32_t i = 0; i < options.route.count; ++i) {
    Set(options.route.waypoints_world[i], message->add_waypoint());
  }
  if (options.route.loop) message->set_loop(true);
  if (options.distance_metric != DistanceMetric::kEuclidean) {
    message->set_distance_metric(static_cast<schema::DistanceMetric>(options.distance_metric));
  }
}

}  // namespace

void Set(const VehicleOptions& options, schema::Vehicle* message) {
  message->set_id(Number(options.id));
  SetDriver(options, message);
}

void Set(const VehicleOptions& options, schema::Spawn* message) { SetDriver(options, message); }

}  // namespace giveway
