#include "services/report/picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "services/types/math/math.h"

namespace giveway {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Scenario Crossing() {
  Scenario scenario;
  scenario.name = "crossing";
  for (const std::uint32_t id : {1U, 2U}) {
    VehicleOptions vehicle;
    vehicle.id = VehicleId{id};
    vehicle.start_world = id == 1 ? Pose{{-4, 0}, 0} : Pose{{0, -3}, kPi / 2};
    vehicle.goal = {true, id == 1 ? Vec2{2.5, 0} : Vec2{0, 2.5}, 0.1};
    scenario.vehicles.push_back(vehicle);
  }
  return scenario;
}

Track Straight(VehicleId id, Vec2 from, Vec2 step) {
  Track track{id, {}};
  for (int i = 0; i <= 100; ++i) {
    Truth truth;
    truth.vehicle = id;
    truth.time_s = i * 0.1;
    truth.world_from_body.position_world = from + (i * 0.1) * step;
    track.truths.push_back(truth);
  }
  return track;
}

WorldEvent Event(EventKind kind, double time_s, std::uint32_t vehicle) {
  WorldEvent event;
  event.kind = kind;
  event.time_s = time_s;
  event.vehicle = VehicleId{vehicle};
  return event;
}

TEST(Picture, ARunWithoutTruthsIsDrawn) {
  const std::string svg = DrawRun(Scenario{}, {}, {});
  EXPECT_THAT(svg, HasSubstr("<svg xmlns="));
  EXPECT_THAT(svg, ::testing::EndsWith("</svg>\n"));
  EXPECT_THAT(DrawRun(Crossing(), {{VehicleId{1}, {}}}, {}), HasSubstr("no verdict"));
}

TEST(Picture, TextsAreEscaped) {
  Scenario scenario = Crossing();
  scenario.name = "a<b>&\"c\x01\xff";
  const Headline headline{Verdict::kFailed, "</svg><script>"};
  const std::string svg = DrawRun(scenario, {}, {}, headline);
  EXPECT_THAT(svg, HasSubstr("a&lt;b&gt;&amp;&quot;c \xef\xbf\xbd"));
  EXPECT_THAT(svg, Not(HasSubstr("<script>")));
}

TEST(Picture, NumbersThatAreNotFiniteNeverReachIt) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Scenario scenario = Crossing();
  scenario.vehicles[0].start_world = {{nan, 0}, nan};
  Track track = Straight(VehicleId{1}, {-4, 0}, {0.4, 0});
  track.truths[50].world_from_body.position_world.x = nan;
  track.truths[60].time_s = std::numeric_limits<double>::infinity();
  std::vector<WorldEvent> events;
  for (const EventKind kind : {EventKind::kHalted, EventKind::kResumed, EventKind::kContact,
                               EventKind::kClosest, EventKind::kRemoved, EventKind::kVerdict}) {
    WorldEvent event = Event(kind, nan, 1);
    event.value = nan;
    event.position_world = {nan, nan};
    events.push_back(event);
  }
  const std::string svg = DrawRun(scenario, {track}, events);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("\"inf")));
}

TEST(Picture, ItSaysHowLongAVehicleHalted) {
  const std::vector<WorldEvent> events{Event(EventKind::kHalted, 7, 2),
                                       Event(EventKind::kResumed, 8, 1),
                                       Event(EventKind::kResumed, 10.1, 2)};
  EXPECT_THAT(DrawRun(Crossing(), {}, events), HasSubstr(">2 halted 3.1 s<"));
}

TEST(Picture, AHaltThatNeverEndsLastsToTheEnd) {
  const std::vector<WorldEvent> events{Event(EventKind::kHalted, 7, 2),
                                       Event(EventKind::kEnded, 60, 0)};
  EXPECT_THAT(DrawRun(Crossing(), {}, events), HasSubstr(">2 halted 53.0 s<"));
}

TEST(Picture, ItMarksTheClosestApproachAndContacts) {
  WorldEvent closest = Event(EventKind::kClosest, 9, 1);
  closest.other = VehicleId{2};
  closest.value = 0.618;
  const std::string svg = DrawRun(Crossing(), {}, {closest, Event(EventKind::kContact, 3, 1)});
  EXPECT_THAT(svg, HasSubstr(">closest 0.62 m<"));
  EXPECT_THAT(svg, HasSubstr(">contact at 3.0 s<"));
}

// The world reports when a vehicle fell silent, not where.
TEST(Picture, ADeathIsMarkedOnceWhereTheVehicleWasSeenLast) {
  const std::vector<WorldEvent> events{Event(EventKind::kSilent, 6.2, 2),
                                       Event(EventKind::kRemoved, 11.2, 2)};
  EXPECT_THAT(DrawRun(Crossing(), {}, events), Not(HasSubstr("fell silent")));
  const auto centre_of_death = [&](double y_m) {
    const std::string svg = DrawRun(Crossing(), {Straight(VehicleId{2}, {0, y_m}, {0, 0})}, events);
    EXPECT_THAT(svg, HasSubstr(">2 fell silent at 6.2 s<"));
    EXPECT_THAT(svg, Not(HasSubstr("removed at")));
    double x = 0;
    double y = 0;
    const std::size_t disc = svg.rfind("<circle", svg.find("fill=\"#777\""));
    EXPECT_EQ(std::sscanf(svg.c_str() + disc, "<circle cx=\"%lf\" cy=\"%lf\"", &x, &y), 2);
    return y;
  };
  EXPECT_GT(centre_of_death(-1), centre_of_death(1));
}

TEST(Picture, TheVerdictIsTheBadge) {
  const std::string passed = DrawRun(Crossing(), {}, {}, Headline{Verdict::kPassed, "all_held"});
  EXPECT_THAT(passed, HasSubstr(">passed<"));
  EXPECT_THAT(passed, Not(HasSubstr("all held"))) << "the description is of more use";
  const std::string failed = DrawRun(Crossing(), {}, {}, Headline{Verdict::kFailed, "contacts_1"});
  EXPECT_THAT(failed, HasSubstr(">failed<"));
  EXPECT_THAT(failed, HasSubstr(">contacts 1<"));
  const std::string none = DrawRun(Crossing(), {}, {}, Headline{Verdict::kNotRun, "could_not"});
  EXPECT_THAT(none, HasSubstr(">not run<"));
  EXPECT_THAT(none, HasSubstr(">could not<"));
}

TEST(Picture, TheVerdictIsTheReportsThoughTheWorldsEventSaysAnother) {
  WorldEvent passed = Event(EventKind::kVerdict, 9, 0);
  passed.value = 1;
  passed.text = "expectations_met";
  const Headline headline{Verdict::kFailed, "process_died"};
  const std::string svg = DrawRun(Crossing(), {}, {passed}, headline);
  EXPECT_THAT(svg, HasSubstr(">failed<"));
  EXPECT_THAT(svg, HasSubstr(">process died<"));
  EXPECT_THAT(svg, Not(HasSubstr("passed")));
  EXPECT_THAT(DrawRun(Crossing(), {}, {passed}), HasSubstr("no verdict"));
}

TEST(Picture, NorthIsUp) {
  const std::string svg = DrawRun(Crossing(), {Straight(VehicleId{2}, {0, -3}, {0, 0.3})}, {});
  const std::size_t path = svg.find("<path d=\"M");
  ASSERT_NE(path, std::string::npos);
  double x0 = 0;
  double y0 = 0;
  double x1 = 0;
  double y1 = 0;
  ASSERT_EQ(std::sscanf(svg.c_str() + path, "<path d=\"M%lf %lfL%lf %lf", &x0, &y0, &x1, &y1), 4);
  EXPECT_EQ(x0, x1);
  EXPECT_LT(y1, y0);
}

TEST(Picture, ABoxIsDrawnAsABoxThatPointsItsWay) {
  Scenario scenario = Crossing();
  RobotModel& profile = scenario.vehicles[0].profile;
  profile.shape = BodyShape::kBox;
  profile.box_half_m = {0.8, 0.2};
  profile.body_radius_m = Norm(profile.box_half_m);
  const auto size = [&](double heading_rad) {
    scenario.vehicles[0].start_world.heading_rad = heading_rad;
    const std::string svg = DrawRun(scenario, {}, {});
    const std::size_t path = svg.find("<path d=\"M");
    double x[3];
    double y[3];
    EXPECT_EQ(std::sscanf(svg.c_str() + path, "<path d=\"M%lf %lfL%lf %lfL%lf %lf", &x[0], &y[0],
                          &x[1], &y[1], &x[2], &y[2]),
              6);
    return Vec2{std::abs(x[0] - x[2]), std::abs(y[0] - y[2])};
  };
  const Vec2 lying = size(0);
  EXPECT_NEAR(lying.x, 4 * lying.y, 1);
  const Vec2 standing = size(kPi / 2);
  EXPECT_NEAR(standing.y, 4 * standing.x, 1);
}

// The world reports where the closest approach was; the track gives the heading there.
TEST(Picture, ABoxAtItsClosestPointsAsItDroveThere) {
  Scenario scenario = Crossing();
  scenario.vehicles[0].profile.shape = BodyShape::kBox;
  scenario.vehicles[0].profile.box_half_m = {0.8, 0.2};
  WorldEvent closest = Event(EventKind::kClosest, 5, 1);
  closest.other = VehicleId{2};
  closest.value = 1;
  Track track = Straight(VehicleId{1}, {-4, 0}, {0.4, 0});
  const std::string ahead = DrawRun(scenario, {track}, {closest});
  for (Truth& truth : track.truths) truth.world_from_body.heading_rad = 1;
  EXPECT_NE(ahead, DrawRun(scenario, {track}, {closest}));
}

TEST(Picture, ThePlaceIsDrawnAndExplained) {
  const std::string bare = DrawRun(Crossing(), {}, {});
  for (const char* words : {">obstacle<", ">moving obstacle", ">door<", ">stop line", ">spawn"}) {
    EXPECT_THAT(bare, Not(HasSubstr(words)));
  }
  Scenario scenario = Crossing();
  Obstacle cart;
  cart.waypoints_world = {{1, 1}, {2, 1}};
  cart.speed_m_s = 0.5;
  scenario.obstacles = {Obstacle{}, cart};
  scenario.doors = {Door{{3, 0}, {3, 1}}};
  SignalPlan signal;
  signal.id = SignalId{4};
  signal.line_to_world = {1, 0};
  scenario.signals = {signal};
  scenario.spawns = {scenario.vehicles[0]};
  const std::string svg = DrawRun(scenario, {}, {});
  for (const char* words :
       {">obstacle<", ">moving obstacle", ">door<", ">stop line", ">spawn", ">0.5 m/s<", ">s4<"}) {
    EXPECT_THAT(svg, HasSubstr(words));
  }
}

TEST(Picture, WhoJoinedIsDrawnAsTheSpawnPlaceItCameFrom) {
  Scenario scenario = Crossing();
  for (const double x : {-8.0, 8.0}) {
    VehicleOptions spawn;
    spawn.start_world.position_world = {x, 0};
    spawn.cruise_m_s = x < 0 ? 0.11 : 0.22;
    scenario.spawns.push_back(spawn);
  }
  const std::string svg = DrawRun(scenario, {Straight(VehicleId{3}, {7.9, 0}, {-0.3, 0})}, {});
  EXPECT_THAT(svg, HasSubstr(">vehicle 3, 0.22 m/s"));
  EXPECT_THAT(svg, Not(HasSubstr("0.11 m/s")));
}

TEST(Picture, WhatIsNotFiniteInThePlaceIsLeftOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Scenario scenario = Crossing();
  Obstacle cart;
  cart.start_world = {{nan, 0}, nan};
  cart.waypoints_world = {{nan, nan}};
  cart.speed_m_s = 1;
  scenario.obstacles = {cart};
  scenario.obstacles.push_back(cart);
  scenario.obstacles.back().shape = BodyShape::kBox;
  scenario.doors = {Door{{nan, 0}, {3, 1}}};
  scenario.signals = {SignalPlan{.line_from_world = {nan, nan}, .travel_rad = nan}};
  EXPECT_THAT(DrawRun(scenario, {}, {}), Not(HasSubstr("nan")));
}

TEST(Picture, AThousandVehiclesAndAFarCornerStayReadable) {
  Scenario scenario = Crossing();
  for (std::uint32_t id = 3; id <= 1000; ++id) {
    scenario.vehicles.push_back(scenario.vehicles[0]);
    scenario.vehicles.back().id = VehicleId{id};
  }
  scenario.vehicles.back().start_world.position_world = {10000, -10000};
  const std::string svg = DrawRun(scenario, {}, {});
  EXPECT_THAT(svg, HasSubstr("and 988 more vehicles"));
  EXPECT_LT(svg.size(), 1'000'000U);
}

}  // namespace
}  // namespace giveway
