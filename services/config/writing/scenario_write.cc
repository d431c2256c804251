#include "services/config/writing/scenario_write.h"

#include <google/protobuf/text_format.h>

#include <cmath>
#include <sstream>

#include "scenario.pb.h"
#include "services/config/impair.h"
#include "services/config/problem.h"
#include "services/types/check.h"
#include "services/types/math/math.h"

namespace giveway {
namespace {

double Thousandths(double value) { return std::round(value * 1000) / 1000; }
Vec2 Thousandths(Vec2 point) { return {Thousandths(point.x), Thousandths(point.y)}; }

// What the reader makes of the degrees that are written.
double HeadingAsRead(double heading_rad) {
  return WrapAngle(Radians(Thousandths(Degrees(heading_rad))));
}

void Set(Vec2 point, schema::Point* message) {
  message->set_x_m(point.x);
  message->set_y_m(point.y);
}

void Set(const VehicleOptions& options, schema::Vehicle* message) {
  message->set_id(Number(options.id));
  message->mutable_start()->set_x_m(options.start_world.position_world.x);
  message->mutable_start()->set_y_m(options.start_world.position_world.y);
  message->mutable_start()->set_heading_deg(Thousandths(Degrees(options.start_world.heading_rad)));
  message->set_cruise_m_s(options.cruise_m_s);
  if (options.goal.set) {
    message->mutable_goal()->set_x_m(options.goal.at_world.x);
    message->mutable_goal()->set_y_m(options.goal.at_world.y);
    message->mutable_goal()->set_radius_m(options.goal.radius_m);
  }
  message->set_behaviour(static_cast<schema::Behaviour>(options.behaviour));
  for (std::uint32_t i = 0; i < options.route.count; ++i) {
    Set(options.route.waypoints_world[i], message->add_waypoint());
  }
  if (options.route.loop) message->set_loop(true);
  if (options.distance_metric != DistanceMetric::kEuclidean) {
    message->set_distance_metric(static_cast<schema::DistanceMetric>(options.distance_metric));
  }
}

void Set(const PlannedFault& fault, schema::Fault* message) {
  message->set_kill(Number(fault.vehicle));
  if (fault.at_s) message->set_at_s(*fault.at_s);
  if (fault.before_crossing_m) message->set_before_crossing_m(*fault.before_crossing_m);
}

// Wheels, caps and rates distinguish robots; the sensors follow from them.
bool IsPioneer(const RobotModel& profile) {
  const RobotModel pioneer = PioneerP3dx();
  return profile.shape == BodyShape::kDisc && profile.body_radius_m == pioneer.body_radius_m &&
         profile.drive.axle_m == pioneer.drive.axle_m &&
         profile.drive.wheel_radius_m == pioneer.drive.wheel_radius_m &&
         profile.max_speed_m_s == pioneer.max_speed_m_s &&
         profile.max_turn_rad_s == pioneer.max_turn_rad_s &&
         profile.acceleration_m_s2 == pioneer.acceleration_m_s2 &&
         profile.deceleration_m_s2 == pioneer.deceleration_m_s2 && profile.wheel_slip == 0 &&
         profile.encoder_noise == 0 && !profile.radar && !profile.lidar && !profile.camera &&
         !profile.pose_fix.Fitted() && !profile.wheel_error.Any() && profile.pose_limit_m == 0 &&
         !profile.sonar[kSensorCount - 1].enabled;
}

void CheckWritable(const Scenario& scenario) {
  bool writable = scenario.spawns.empty() && scenario.obstacles.empty() && scenario.doors.empty() &&
                  scenario.signals.empty() && scenario.sonar.tier == SonarTier::kIdeal;
  for (const VehicleOptions& options : scenario.vehicles) {
    writable = writable && IsPioneer(options.profile);
  }
  if (writable) return;
  throw InputError({{.file = scenario.name,
                     .message = "holds obstacles, doors, signals, spawn places, another sonar tier "
                                "or another robot than the P3-DX: these are not written",
                     .remedy = "remove them from a copy of the file"}});
}

void SetPlace(const Scenario& scenario, schema::Scenario* message) {
  Set(scenario.crossing_world, message->mutable_crossing());
  for (const Wall& wall : scenario.walls) {
    schema::Wall* written = message->add_wall();
    Set(wall.from_world, written->mutable_from());
    Set(wall.to_world, written->mutable_to());
  }
  for (const OneLane& lane : scenario.one_lanes) {
    schema::OneLane* written = message->add_one_lane();
    Set(lane.from_world, written->mutable_from());
    Set(lane.to_world, written->mutable_to());
    written->set_width_m(lane.width_m);
  }
}

// Numbers that are as without the rule are left out.
void SetNumbers(const ImpairmentRule& rule, google::protobuf::Message* message) {
  const ImpairmentRule plain;
  for (const ImpairField& field : ImpairFields()) {
    const double value = rule.*field.member;
    if (value == plain.*field.member) continue;
    const auto* written = message->GetDescriptor()->FindFieldByName(std::string(field.field));
    GIVEWAY_CHECK(written != nullptr, field.field);
    message->GetReflection()->SetDouble(message, written, value * field.per_si);
  }
}

void Set(const ImpairmentRule& rule, schema::Impair* message) {
  if (rule.from == ImpairedSender::kOneVehicle) {
    message->set_from_vehicle(Number(rule.from_vehicle));
  } else if (rule.from != ImpairedSender::kAnyone) {
    message->set_from(static_cast<schema::ImpairedSender>(rule.from));
  }
  if (rule.to_vehicle != kNoVehicle) message->set_to_vehicle(Number(rule.to_vehicle));
  SetNumbers(rule, message);
  if (rule.from_s) message->set_from_s(*rule.from_s);
  if (rule.to_s) message->set_to_s(*rule.to_s);
  for (const Blackout& blackout : rule.blackouts) {
    schema::Blackout* written = message->add_blackout();
    written->set_from_s(blackout.from_s);
    written->set_to_s(blackout.to_s);
  }
}

void SetExpectation(const Expectation& expect, schema::Expect* message) {
  message->set_contacts(expect.contacts);
  message->set_any_halted(expect.any_halted);
  if (expect.any_arrived) message->set_any_arrived(true);
  if (expect.halted_for) {
    schema::Reason reason = schema::give_way;
    GIVEWAY_CHECK(schema::Reason_Parse(std::string(Name(*expect.halted_for)), &reason));
    message->set_halted_for(reason);
  }
  for (const VehicleId id : expect.halted) message->add_halted(Number(id));
  for (const VehicleId id : expect.arrived) message->add_arrived(Number(id));
}

schema::Scenario ToSchema(const Scenario& scenario) {
  schema::Scenario message;
  message.set_name(scenario.name);
  message.set_description(scenario.description);
  message.set_tick_period_ms(Milliseconds(scenario.tick_period));
  message.set_duration_s(scenario.duration_s);
  message.set_remove_after_s(scenario.remove_after_s);
  message.set_watchdog_ticks(scenario.watchdog_ticks);
  if (!scenario.vehicles.empty()) {
    const VehicleOptions& options = scenario.vehicles.front();
    message.set_emission_radius_m(options.emission_radius_m);
    message.set_gate_enter_m(options.gate_enter_m);
    message.set_gate_exit_m(options.gate_exit_m);
    message.set_beacon_age_limit_ms(Milliseconds(options.beacon_age_limit));
  }
  SetPlace(scenario, &message);
  for (const VehicleOptions& options : scenario.vehicles) Set(options, message.add_vehicle());
  for (const PlannedFault& fault : scenario.faults) Set(fault, message.add_fault());
  for (const ImpairmentRule& rule : scenario.impairment.rules) Set(rule, message.add_impair());
  if (scenario.impairment.seed) message.set_impair_seed(*scenario.impairment.seed);
  SetExpectation(scenario.expect, message.mutable_expect());
  return message;
}

std::string Commented(const std::string& comment) {
  std::istringstream lines(comment);
  std::string text;
  for (std::string line; std::getline(lines, line);) text += "# " + line + "\n";
  return text;
}

}  // namespace

std::string WriteScenario(const Scenario& scenario, const std::string& comment) {
  CheckWritable(scenario);
  std::string text;
  GIVEWAY_CHECK(google::protobuf::TextFormat::PrintToString(ToSchema(scenario), &text));
  return Commented(comment) + text;
}

Scenario RoundedAsWritten(Scenario scenario) {
  scenario.duration_s = Thousandths(scenario.duration_s);
  for (VehicleOptions& options : scenario.vehicles) {
    Pose& start = options.start_world;
    start = {Thousandths(start.position_world), HeadingAsRead(start.heading_rad)};
    options.cruise_m_s = Thousandths(options.cruise_m_s);
    options.goal.at_world = Thousandths(options.goal.at_world);
    for (Vec2& waypoint : options.route.waypoints_world) waypoint = Thousandths(waypoint);
  }
  for (OneLane& lane : scenario.one_lanes) {
    lane = {Thousandths(lane.from_world), Thousandths(lane.to_world), Thousandths(lane.width_m)};
  }
  for (VehicleOptions& options : scenario.vehicles) options.one_lanes = scenario.one_lanes;
  for (Wall& wall : scenario.walls) {
    wall = {Thousandths(wall.from_world), Thousandths(wall.to_world)};
  }
  return scenario;
}

}  // namespace giveway
