// Two vehicles whose paths cross at any angle, at any speeds, early or late for each other: no
// contact, and both arrive. Each case is drawn from its number and replays from it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "services/types/math/random.h"
#include "tests/support/crossing.h"

namespace giveway {
namespace {

// Vehicle 1 drives east through the origin; vehicle 2 crosses at 10 to 180 degrees, up to 3 s
// apart.
Scenario AnyCrossing(std::uint32_t number, Behaviour behaviour) {
  Random random(number);
  const double cruise_1 = random.Uniform(0.1, 0.9);
  const double cruise_2 = random.Uniform(0.1, 0.9);
  const double side = random.Uniform(0, 1) < 0.5 ? -1 : 1;
  const double heading = side * Radians(random.Uniform(10, 180));
  const double time_s = random.Uniform(8, 12);
  const double late_s = random.Uniform(-3, 3);
  const double way_1 = (time_s - cruise_1 / 0.6) * cruise_1;
  const double way_2 = (time_s + late_s - cruise_2 / 0.6) * cruise_2;
  const Vec2 from_2 = -way_2 * Vec2{Cos(heading), Sin(heading)};
  Scenario scenario = test::ScenarioOf(
      {test::VehicleAt(1, behaviour, cruise_1, {-way_1, 0}, 0, way_1 + 6),
       test::VehicleAt(2, behaviour, cruise_2, from_2, Degrees(heading), way_2 + 6)});
  scenario.duration_s = 150;
  return scenario;
}

// Starts or goals within 1 m of each other do not fit two vehicles.
bool IsSolvable(const Scenario& scenario) {
  const VehicleOptions& one = scenario.vehicles[0];
  const VehicleOptions& two = scenario.vehicles[1];
  const Vec2 starts = one.start_world.position_world - two.start_world.position_world;
  return Norm(starts) >= 1 && Norm(one.goal.at_world - two.goal.at_world) >= 1;
}

// The cases to run: the first few, and those that once failed. GIVEWAY_CASES=4000 in the
// environment looks further than a unit test has time for.
std::vector<std::uint32_t> Cases() {
  // 45 90 98 740: an obstacle that still drives was taken for one that stands.
  // 1441: the lecture's gate of 1 m is too short for two vehicles at 0.8 m/s.
  // 3051 3096: the second in the order halted in front of the first, for ever.
  std::vector<std::uint32_t> cases = {45, 90, 98, 740, 1441, 3051, 3096};
  const char* wanted = std::getenv("GIVEWAY_CASES");
  const unsigned long count = wanted != nullptr ? std::strtoul(wanted, nullptr, 10) : 40;
  for (std::uint32_t number = 1; number <= count; ++number) cases.push_back(number);
  return cases;
}

class AnyTwo : public testing::TestWithParam<Behaviour> {};

TEST_P(AnyTwo, NeverTouchAndBothArrive) {
  for (const std::uint32_t number : Cases()) {
    const Scenario scenario = AnyCrossing(number, GetParam());
    if (!IsSolvable(scenario)) continue;
    const auto outcome = test::Finish(scenario);
    EXPECT_EQ(outcome.figures.contacts, 0U) << "case " << number;
    EXPECT_EQ(outcome.arrived.size(), 2U) << "case " << number;
  }
}

TEST_P(AnyTwo, NeverTouchWhicheverDies) {
  for (const std::uint32_t number : Cases()) {
    Scenario scenario = AnyCrossing(number, GetParam());
    if (!IsSolvable(scenario)) continue;
    Random random(number, 99);
    const VehicleId victim{1 + static_cast<std::uint32_t>(random.Next() % 2)};
    scenario.faults = {{FaultKind::kKill, victim, random.Uniform(1, 15), std::nullopt}};
    const auto outcome = test::Finish(scenario);
    EXPECT_EQ(outcome.figures.contacts, 0U) << "case " << number;
    EXPECT_FALSE(outcome.arrived.empty()) << "case " << number;
  }
}

INSTANTIATE_TEST_SUITE_P(Both, AnyTwo,
                         testing::Values(Behaviour::kCooperative, Behaviour::kLectureYield),
                         [](const auto& test) { return std::string(Name(test.param)); });

}  // namespace
}  // namespace giveway
