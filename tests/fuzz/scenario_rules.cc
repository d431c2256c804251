#include "tests/fuzz/scenario_rules.h"

#include <algorithm>
#include <clocale>
#include <cwchar>

#include "services/types/check.h"
#include "services/types/math/math.h"

namespace giveway::fuzz {
namespace {

constexpr double kFarthest_m = 10'001;  // and what the seed moves

// False of NaN.
bool Within(double x, double low, double high) { return x >= low && x <= high; }
bool Positive(double x, double high) { return x > 0 && x <= high; }
bool IsPlace(Vec2 p) {
  return Within(p.x, -kFarthest_m, kFarthest_m) && Within(p.y, -kFarthest_m, kFarthest_m);
}

bool IsName(const std::string& name) {
  return !name.empty() && name.size() <= 64 &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") == std::string::npos;
}

// A disc, or a box with the radius of the disc that holds it.
void CheckShape(BodyShape shape, Vec2 box_half_m, double radius_m) {
  if (shape == BodyShape::kDisc) {
    GIVEWAY_CHECK(Within(radius_m, 0.01, 10), radius_m);
    return;
  }
  GIVEWAY_CHECK(Within(box_half_m.x, 0.05, 10) && Within(box_half_m.y, 0.05, 10), box_half_m.x);
  GIVEWAY_CHECK(Within(radius_m - Norm(box_half_m), -1e-9, 1e-9), radius_m);
}

void CheckProfile(const RobotModel& p) {
  CheckShape(p.shape, p.box_half_m, p.body_radius_m);
  GIVEWAY_CHECK(p.body_radius_m >= 0.05, p.body_radius_m);
  GIVEWAY_CHECK(Within(p.wheel_slip, 0, 0.5) && Within(p.encoder_noise, 0, 0.5), p.wheel_slip);
  GIVEWAY_CHECK(Within(p.drive.wheel_radius_m, 0.01, 5), p.drive.wheel_radius_m);
  GIVEWAY_CHECK(Within(p.drive.axle_m, 0.02, 20), p.drive.axle_m);
  GIVEWAY_CHECK(Positive(p.max_speed_m_s, 2.5), p.max_speed_m_s);
  GIVEWAY_CHECK(Positive(p.max_turn_rad_s, 20), p.max_turn_rad_s);
  GIVEWAY_CHECK(Positive(p.acceleration_m_s2, 20), p.acceleration_m_s2);
  GIVEWAY_CHECK(Positive(p.deceleration_m_s2, 20), p.deceleration_m_s2);
}

void CheckVehicle(const VehicleOptions& v, const Scenario& scenario) {
  CheckProfile(v.profile);
  GIVEWAY_CHECK(IsPlace(v.start_world.position_world), Number(v.id));
  GIVEWAY_CHECK(Within(v.start_world.heading_rad, -kPi, kPi), v.start_world.heading_rad);
  GIVEWAY_CHECK(Positive(v.cruise_m_s, v.profile.max_speed_m_s), v.cruise_m_s);
  GIVEWAY_CHECK(v.tick_period == scenario.tick_period);
  const bool fires_in_turn = scenario.sonar.tier >= SonarTier::kP3dx;
  GIVEWAY_CHECK(
      fires_in_turn ? v.sonar_refresh > 8 * scenario.sonar.slot : v.sonar_refresh == Nanoseconds{0},
      v.sonar_refresh.count());
  GIVEWAY_CHECK(3 * v.tick_period <= v.beacon_age_limit, v.beacon_age_limit.count());
  GIVEWAY_CHECK(v.gate_enter_m > 0 && v.gate_enter_m < v.gate_exit_m, v.gate_enter_m);
  GIVEWAY_CHECK(Positive(v.emission_radius_m, 1000), v.emission_radius_m);
  if (v.goal.set) {
    GIVEWAY_CHECK(IsPlace(v.goal.at_world) && Positive(v.goal.radius_m, 100), v.goal.radius_m);
    GIVEWAY_CHECK(Norm(v.goal.at_world - v.start_world.position_world) > v.goal.radius_m);
  }
  const BraitenbergWeights& weights = v.braitenberg;
  GIVEWAY_CHECK(Within(weights.base_rad_s, 0, 100), weights.base_rad_s);
  GIVEWAY_CHECK(weights.near_gate_m > 0 && weights.near_gate_m < weights.far_gate_m);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    GIVEWAY_CHECK(Within(weights.left[i], -100, 100) && Within(weights.right[i], -100, 100), i);
  }
}

// Sorted by id, each once, no two discs overlapping.
void CheckFleet(const std::vector<VehicleOptions>& vehicles) {
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    GIVEWAY_CHECK(vehicles[i].id != kNoVehicle);
    GIVEWAY_CHECK(i == 0 || vehicles[i - 1].id < vehicles[i].id, Number(vehicles[i].id));
    for (std::size_t j = 0; j < i; ++j) {
      if (vehicles[i].profile.shape != BodyShape::kDisc) continue;
      if (vehicles[j].profile.shape != BodyShape::kDisc) continue;
      const double gap_m =
          Norm(vehicles[i].start_world.position_world - vehicles[j].start_world.position_world) -
          vehicles[i].profile.body_radius_m - vehicles[j].profile.body_radius_m;
      GIVEWAY_CHECK(gap_m > 0, gap_m, Number(vehicles[i].id), Number(vehicles[j].id));
    }
  }
}

void CheckSonar(const Scenario& scenario) {
  const SonarModel& sonar = scenario.sonar;
  GIVEWAY_CHECK(sonar.tier <= SonarTier::kCrosstalk);
  GIVEWAY_CHECK(Within(sonar.blind_m, 0, 1) && Within(sonar.noise, 0, 0.5), sonar.noise);
  GIVEWAY_CHECK(Within(sonar.max_incidence_rad, Radians(1), Radians(90)), sonar.max_incidence_rad);
  GIVEWAY_CHECK(Within(sonar.drop_out, 0, 0.9), sonar.drop_out);
  GIVEWAY_CHECK(Within(Milliseconds(sonar.slot), 30, 200), sonar.slot.count());
}

void CheckLine(Vec2 from_world, Vec2 to_world) {
  GIVEWAY_CHECK(IsPlace(from_world) && IsPlace(to_world));
  GIVEWAY_CHECK(Norm(to_world - from_world) >= 0.001);
}

void CheckObstacle(const Obstacle& o) {
  CheckShape(o.shape, o.box_half_m, o.radius_m);
  GIVEWAY_CHECK(IsPlace(o.start_world.position_world));
  GIVEWAY_CHECK(Within(o.start_world.heading_rad, -kPi, kPi), o.start_world.heading_rad);
  GIVEWAY_CHECK(o.waypoints_world.empty() ? o.speed_m_s == 0 : Positive(o.speed_m_s, 10));
  Vec2 before = o.start_world.position_world;
  for (const Vec2 waypoint : o.waypoints_world) {
    CheckLine(before, waypoint);
    before = waypoint;
  }
  if (o.loop) CheckLine(before, o.start_world.position_world);
}

void CheckDoor(const Door& door) {
  CheckLine(door.from_world, door.to_world);
  GIVEWAY_CHECK(Within(door.closed_s, 0, 86400) && Within(door.open_s, 0, 86400));
  GIVEWAY_CHECK(Positive(door.move_s, 3600) && Within(door.offset_s, 0, 86400));
  GIVEWAY_CHECK(Norm(door.to_world - door.from_world) <= 10 * door.move_s);
}

void CheckSignals(const std::vector<SignalPlan>& signals) {
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const SignalPlan& s = signals[i];
    GIVEWAY_CHECK(s.id != kNoSignal && (i == 0 || signals[i - 1].id < s.id), Number(s.id));
    CheckLine(s.line_from_world, s.line_to_world);
    GIVEWAY_CHECK(Within(s.travel_rad, -kPi, kPi), s.travel_rad);
    GIVEWAY_CHECK(Within(s.green_s, 1, 3600) && Within(s.yellow_s, 1, 60), s.green_s);
    GIVEWAY_CHECK(Within(s.red_s, 1, 3600) && Within(s.offset_s, 0, 86400), s.red_s);
  }
}

void CheckOneLane(const OneLane& lane) {
  CheckLine(lane.from_world, lane.to_world);
  GIVEWAY_CHECK(Within(lane.width_m, 0.1, 100), lane.width_m);
}

void CheckPlace(const Scenario& scenario) {
  CheckSonar(scenario);
  GIVEWAY_CHECK(scenario.one_lanes.size() <= kMaxOneLanes, scenario.one_lanes.size());
  for (const OneLane& lane : scenario.one_lanes) CheckOneLane(lane);
  for (const Wall& wall : scenario.walls) CheckLine(wall.from_world, wall.to_world);
  for (const Obstacle& obstacle : scenario.obstacles) CheckObstacle(obstacle);
  for (const Door& door : scenario.doors) CheckDoor(door);
  CheckSignals(scenario.signals);
}

bool Knows(const Scenario& scenario, VehicleId id) {
  return std::any_of(scenario.vehicles.begin(), scenario.vehicles.end(),
                     [id](const VehicleOptions& vehicle) { return vehicle.id == id; });
}

bool KnowsSignal(const Scenario& scenario, SignalId id) {
  return std::any_of(scenario.signals.begin(), scenario.signals.end(),
                     [id](const SignalPlan& signal) { return signal.id == id; });
}

void CheckIds(const std::vector<VehicleId>& ids, const Scenario& scenario) {
  GIVEWAY_CHECK(std::is_sorted(ids.begin(), ids.end()));
  GIVEWAY_CHECK(std::adjacent_find(ids.begin(), ids.end()) == ids.end());
  const auto fleet = static_cast<std::uint32_t>(scenario.vehicles.size() + scenario.spawns.size());
  for (const VehicleId id : ids) {
    const bool may_join = !scenario.spawns.empty() && Number(id) <= fleet;
    GIVEWAY_CHECK(Knows(scenario, id) || may_join, Number(id));
  }
}

void CheckPlans(const Scenario& scenario) {
  for (const PlannedFault& fault : scenario.faults) {
    const bool kills = fault.kind == FaultKind::kKill;
    GIVEWAY_CHECK(Knows(scenario, fault.vehicle) == kills, Number(fault.vehicle));
    GIVEWAY_CHECK(KnowsSignal(scenario, fault.signal) == !kills, Number(fault.signal));
    GIVEWAY_CHECK(kills || (fault.at_s && !fault.before_crossing_m));
    GIVEWAY_CHECK(fault.at_s || fault.before_crossing_m);
    GIVEWAY_CHECK(Within(fault.at_s.value_or(0), 0, 86400));
    GIVEWAY_CHECK(Positive(fault.before_crossing_m.value_or(1), 1000));
  }
  const Expectation& expect = scenario.expect;
  CheckIds(expect.halted, scenario);
  CheckIds(expect.arrived, scenario);
  GIVEWAY_CHECK(Within(expect.min_separation_m.value_or(0), 0, 10'000));
  GIVEWAY_CHECK(Positive(expect.time_to_clear_s.value_or(1), 86400));
}

void CheckRule(const ImpairmentRule& rule, const Scenario& scenario) {
  for (const double share :
       {rule.loss, rule.burst_loss, rule.reorder, rule.duplicate, rule.corrupt}) {
    GIVEWAY_CHECK(Within(share, 0, 1), share);
  }
  GIVEWAY_CHECK(Within(rule.burst, 0, 0.9) && Within(rule.burst_length, 1, 10'000), rule.burst);
  GIVEWAY_CHECK(rule.burst <= (1 - rule.burst) * rule.burst_length, rule.burst);
  GIVEWAY_CHECK(Within(rule.delay_s, 0, 10) && Within(rule.jitter_s, 0, rule.delay_s));
  GIVEWAY_CHECK(Positive(rule.reorder_by_s, 10) && Within(rule.rate_bytes_s, 0, 1e9));
  GIVEWAY_CHECK(Within(rule.rate_burst_bytes, 1, 1e9), rule.rate_burst_bytes);
  for (const Blackout& blackout : rule.blackouts) {
    GIVEWAY_CHECK(Within(blackout.from_s, 0, 2'592'000) && Within(blackout.to_s, 0, 2'592'000));
    GIVEWAY_CHECK(blackout.from_s < blackout.to_s, blackout.from_s);
  }
  const double from_s = rule.from_s.value_or(0);
  GIVEWAY_CHECK(Within(from_s, 0, 2'592'000) && Within(rule.to_s.value_or(1), 0, 2'592'000));
  GIVEWAY_CHECK(!rule.to_s || from_s < *rule.to_s, from_s);
  const bool one = rule.from == ImpairedSender::kOneVehicle;
  GIVEWAY_CHECK(one == (rule.from_vehicle != kNoVehicle));
  if (one) CheckIds({rule.from_vehicle}, scenario);
  if (rule.to_vehicle != kNoVehicle) CheckIds({rule.to_vehicle}, scenario);
}

}  // namespace

bool IsUtf8(const std::string& text) {
  static const bool set = std::setlocale(LC_CTYPE, "C.UTF-8") != nullptr;
  GIVEWAY_CHECK(set);
  std::mbstate_t state{};
  const char* from = text.c_str();
  return text.find('\0') == std::string::npos &&
         std::mbsrtowcs(nullptr, &from, 0, &state) != static_cast<std::size_t>(-1);
}

void CheckScenario(const Scenario& scenario) {
  GIVEWAY_CHECK(IsName(scenario.name), scenario.name);
  GIVEWAY_CHECK(IsName(scenario.area), scenario.area);
  GIVEWAY_CHECK(IsUtf8(scenario.description), scenario.description);
  GIVEWAY_CHECK(Within(Milliseconds(scenario.tick_period), 5, 1000), scenario.tick_period.count());
  GIVEWAY_CHECK(Within(scenario.duration_s, 0, 86400), scenario.duration_s);
  GIVEWAY_CHECK(Positive(scenario.start_timeout_s, 600), scenario.start_timeout_s);
  GIVEWAY_CHECK(Within(scenario.remove_after_s, 0, 3600), scenario.remove_after_s);
  GIVEWAY_CHECK(scenario.watchdog_ticks >= 1 && scenario.watchdog_ticks <= 100);
  GIVEWAY_CHECK(IsPlace(scenario.crossing_world));
  const std::size_t fleet = scenario.vehicles.size() + scenario.spawns.size();
  GIVEWAY_CHECK(fleet >= 1 && fleet <= 16384, fleet);
  const std::size_t least = scenario.spawns.empty() ? 0 : 1;
  GIVEWAY_CHECK(scenario.start_with >= least && scenario.start_with <= least * fleet);
  for (const VehicleOptions& vehicle : scenario.vehicles) CheckVehicle(vehicle, scenario);
  for (const VehicleOptions& spawn : scenario.spawns) CheckVehicle(spawn, scenario);
  CheckFleet(scenario.vehicles);
  CheckPlace(scenario);
  CheckPlans(scenario);
  for (const ImpairmentRule& rule : scenario.impairment.rules) CheckRule(rule, scenario);
}

}  // namespace giveway::fuzz
