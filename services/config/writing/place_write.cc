#include "services/config/writing/place_write.h"

#include <cmath>

#include "scenario.pb.h"
#include "services/types/math/math.h"

namespace giveway {
namespace {

// A wall, a section, a door, a stop line.
template <typename Ends, typename Message>
void SetEnds(const Ends& ends, Message* message) {
  Set(ends.from_world, message->mutable_from());
  Set(ends.to_world, message->mutable_to());
}

void Set(const Obstacle& obstacle, schema::Obstacle* message) {
  if (obstacle.shape == BodyShape::kBox) {
    message->mutable_box()->set_half_length_m(obstacle.box_half_m.x);
    message->mutable_box()->set_half_width_m(obstacle.box_half_m.y);
  } else {
    message->set_disc_radius_m(obstacle.radius_m);
  }
  message->mutable_start()->set_x_m(obstacle.start_world.position_world.x);
  message->mutable_start()->set_y_m(obstacle.start_world.position_world.y);
  message->mutable_start()->set_heading_deg(DegreesOf(obstacle.start_world.heading_rad));
  if (obstacle.waypoints_world.empty()) return;
  for (const Vec2& point : obstacle.waypoints_world) Set(point, message->add_waypoint());
  message->set_loop(obstacle.loop);
  message->set_speed_m_s(obstacle.speed_m_s);
}

void Set(const Door& door, schema::Door* message) {
  SetEnds(door, message);
  message->set_closed_s(door.closed_s);
  message->set_open_s(door.open_s);
  message->set_move_s(door.move_s);
  message->set_offset_s(door.offset_s);
}

void Set(const SignalPlan& signal, schema::Signal* message) {
  message->set_id(Number(signal.id));
  if (signal.group != 0) message->set_group(signal.group);
  Set(signal.line_from_world, message->mutable_line()->mutable_from());
  Set(signal.line_to_world, message->mutable_line()->mutable_to());
  message->set_heading_deg(DegreesOf(signal.travel_rad));
  message->set_green_s(signal.green_s);
  message->set_yellow_s(signal.yellow_s);
  message->set_red_s(signal.red_s);
  message->set_offset_s(signal.offset_s);
}

// A field without effect in the tier is refused.
void Set(const SonarModel& sonar, schema::Sonar* message) {
  message->set_tier(static_cast<schema::SonarTier>(sonar.tier));
  if (sonar.tier == SonarTier::kIdeal) return;
  message->set_blind_m(sonar.blind_m);
  message->set_noise(sonar.noise);
  message->set_max_incidence_deg(DegreesOf(sonar.max_incidence_rad));
  message->set_drop_out(sonar.drop_out);
  if (sonar.tier >= SonarTier::kP3dx) message->set_slot_ms(Milliseconds(sonar.slot));
}

}  // namespace

double DegreesOf(double angle_rad) {
  const double all_digits = Degrees(angle_rad);
  const double few_digits = std::round(all_digits * 1000) / 1000;
  return WrapAngle(Radians(few_digits)) == angle_rad ? few_digits : all_digits;
}

void Set(Vec2 point, schema::Point* message) {
  message->set_x_m(point.x);
  message->set_y_m(point.y);
}

void SetPlace(const Scenario& scenario, schema::Scenario* message) {
  Set(scenario.crossing_world, message->mutable_crossing());
  if (scenario.sonar.tier != SonarTier::kIdeal) Set(scenario.sonar, message->mutable_sonar());
  for (const Wall& wall : scenario.walls) SetEnds(wall, message->add_wall());
  for (const OneLane& lane : scenario.one_lanes) {
    schema::OneLane* written = message->add_one_lane();
    SetEnds(lane, written);
    written->set_width_m(lane.width_m);
  }
  for (const Obstacle& obstacle : scenario.obstacles) Set(obstacle, message->add_obstacle());
  for (const Door& door : scenario.doors) Set(door, message->add_door());
  for (const SignalPlan& signal : scenario.signals) Set(signal, message->add_signal());
}

}  // namespace giveway
