// Waypoints of a vehicle or of a spawn place in a scenario file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/config/problem_matcher.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway {
namespace {

using ::testing::ElementsAre;

std::string WithRoute(const std::string& route) {
  return Edited("cruise_m_s: 0.4", "cruise_m_s: 0.4 " + route);
}

TEST(RouteInAFile, IsReadInTurn) {
  const Scenario scenario =
      Load(WithRoute("waypoint { x_m: 1 y_m: 2 } waypoint { x_m: 3 y_m: -4 }"));
  const Route& route = scenario.vehicles[0].route;
  ASSERT_EQ(route.count, 2U);
  EXPECT_EQ(route.waypoints_world[0], (Vec2{1, 2}));
  EXPECT_EQ(route.waypoints_world[1], (Vec2{3, -4}));
  EXPECT_FALSE(route.loop);
  EXPECT_EQ(scenario.vehicles[1].route.count, 0U);
}

TEST(RouteInAFile, WhoLoopsIsNotExpectedToArrive) {
  EXPECT_THAT(
      ProblemsOf(WithRoute("waypoint { x_m: 1 y_m: 2 } loop: true")),
      ElementsAre(Is(16, "expect.arrived", "vehicle 1 has no goal, or a route that loops")));
}

TEST(RouteInAFile, IsReadOfASpawnPlaceToo) {
  const std::string spawn = "spawn { start { x_m: 9 y_m: 9 heading_deg: 0 } cruise_m_s: 0.2 ";
  const Scenario scenario =
      Load(kGoodScenario + spawn +
           "waypoint { x_m: 1 y_m: 2 } waypoint { x_m: 3 y_m: -4 } loop: true }");
  ASSERT_EQ(scenario.spawns.size(), 1U);
  const Route& route = scenario.spawns[0].route;
  ASSERT_EQ(route.count, 2U);
  EXPECT_EQ(route.waypoints_world[1], (Vec2{3, -4}));
  EXPECT_TRUE(route.loop);
  EXPECT_THAT(ProblemsOf(kGoodScenario + spawn + "loop: true }"),
              ElementsAre(Is(17, "spawn[0].loop", "without a waypoint")));
}

TEST(RouteInAFile, HasAtMostSixteenWaypoints) {
  std::string route;
  for (std::size_t i = 0; i < kMaxWaypoints; ++i) route += "waypoint { x_m: 1 y_m: 2 } ";
  EXPECT_EQ(Load(WithRoute(route)).vehicles[0].route.count, kMaxWaypoints);
  EXPECT_THAT(ProblemsOf(WithRoute(route + "waypoint { x_m: 1 y_m: 2 }")),
              ElementsAre(Is(6, "vehicle[0].waypoint", "there are 17")));
}

TEST(RouteInAFile, LoopsOnlyOverWaypoints) {
  EXPECT_THAT(ProblemsOf(WithRoute("loop: true")),
              ElementsAre(Is(6, "vehicle[0].loop", "without a waypoint")));
}

TEST(RouteInAFile, HasFinitePoints) {
  EXPECT_THAT(ProblemsOf(WithRoute("waypoint { x_m: nan y_m: 2 }")),
              ElementsAre(Is(6, "vehicle[0].waypoint[0].x_m", "not a finite number")));
}

}  // namespace
}  // namespace giveway
