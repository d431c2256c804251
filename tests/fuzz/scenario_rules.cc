#include "tests/fuzz/scenario_rules.h"

#include <algorithm>
#include <clocale>
#include <cwchar>

#include "services/types/check.h"
#include "services/types/math.h"

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

void CheckProfile(const VehicleProfile& p) {
  GIVEWAY_CHECK(Within(p.body_radius_m, 0.05, 10), p.body_radius_m);
  GIVEWAY_CHECK(Within(p.drive.wheel_radius_m, 0.01, 5), p.drive.wheel_radius_m);
  GIVEWAY_CHECK(Within(p.drive.axle_m, 0.02, 20), p.drive.axle_m);
  GIVEWAY_CHECK(Positive(p.max_speed_m_s, 2.5), p.max_speed_m_s);
  GIVEWAY_CHECK(Positive(p.max_turn_rad_s, 20), p.max_turn_rad_s);
  GIVEWAY_CHECK(Positive(p.acceleration_m_s2, 20), p.acceleration_m_s2);
  GIVEWAY_CHECK(Positive(p.deceleration_m_s2, 20), p.deceleration_m_s2);
}

void CheckVehicle(const VehicleOptions& v, const Scenario& scenario) {
  CheckProfile(v.profile);
  GIVEWAY_CHECK(v.id != kNobody);
  GIVEWAY_CHECK(IsPlace(v.start_world.position_world), Number(v.id));
  GIVEWAY_CHECK(Within(v.start_world.heading_rad, -kPi, kPi), v.start_world.heading_rad);
  GIVEWAY_CHECK(Positive(v.cruise_m_s, v.profile.max_speed_m_s), v.cruise_m_s);
  GIVEWAY_CHECK(v.tick_period == scenario.tick_period);
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

// Sorted by id, each once, no two bodies overlapping.
void CheckFleet(const std::vector<VehicleOptions>& vehicles) {
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    GIVEWAY_CHECK(i == 0 || vehicles[i - 1].id < vehicles[i].id, Number(vehicles[i].id));
    for (std::size_t j = 0; j < i; ++j) {
      const double gap_m =
          Norm(vehicles[i].start_world.position_world - vehicles[j].start_world.position_world) -
          vehicles[i].profile.body_radius_m - vehicles[j].profile.body_radius_m;
      GIVEWAY_CHECK(gap_m > 0, gap_m, Number(vehicles[i].id), Number(vehicles[j].id));
    }
  }
}

bool Knows(const Scenario& scenario, VehicleId id) {
  return std::any_of(scenario.vehicles.begin(), scenario.vehicles.end(),
                     [id](const VehicleOptions& vehicle) { return vehicle.id == id; });
}

void CheckIds(const std::vector<VehicleId>& ids, const Scenario& scenario) {
  GIVEWAY_CHECK(std::is_sorted(ids.begin(), ids.end()));
  GIVEWAY_CHECK(std::adjacent_find(ids.begin(), ids.end()) == ids.end());
  for (const VehicleId id : ids) GIVEWAY_CHECK(Knows(scenario, id), Number(id));
}

void CheckPlans(const Scenario& scenario) {
  for (const PlannedFault& fault : scenario.faults) {
    GIVEWAY_CHECK(Knows(scenario, fault.vehicle), Number(fault.vehicle));
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
  GIVEWAY_CHECK(Positive(scenario.duration_s, 86400), scenario.duration_s);
  GIVEWAY_CHECK(Positive(scenario.start_timeout_s, 600), scenario.start_timeout_s);
  GIVEWAY_CHECK(Within(scenario.remove_after_s, 0, 3600), scenario.remove_after_s);
  GIVEWAY_CHECK(scenario.watchdog_ticks >= 1 && scenario.watchdog_ticks <= 100);
  GIVEWAY_CHECK(IsPlace(scenario.crossing_world));
  GIVEWAY_CHECK(!scenario.vehicles.empty() && scenario.vehicles.size() <= 1024);
  for (const VehicleOptions& vehicle : scenario.vehicles) CheckVehicle(vehicle, scenario);
  CheckFleet(scenario.vehicles);
  for (const Wall& wall : scenario.walls) {
    GIVEWAY_CHECK(IsPlace(wall.from_world) && IsPlace(wall.to_world));
    GIVEWAY_CHECK(!(wall.from_world == wall.to_world));
  }
  CheckPlans(scenario);
}

}  // namespace giveway::fuzz
