// A section in which no two vehicles pass each other: one brain on the bench, heading east from the
// origin at 0.3 m/s through a section that lies between x = 3 and x = 9.
#include "services/vehicle/situation/one_lane.h"

#include <gtest/gtest.h>

#include <vector>

#include "services/types/math/random.h"
#include "services/vehicle/own_path.h"
#include "tests/support/brain_bench.h"
#include "tests/support/onlooker.h"

namespace giveway {
namespace {

using test::BeaconOf;
using test::BrainBench;
using test::ClearScan;
using test::Rolling;

constexpr double kCruise_m_s = 0.3;
constexpr double kSlower_m_s = 0.2;  // comes later in the order
constexpr double kFaster_m_s = 0.4;  // comes first
const OneLane kSection = {.from_world = {3, 0}, .to_world = {9, 0}, .width_m = 1};
// Half of the width, the body and the margin before the end.
constexpr double kOutside_m = 3 - (0.5 + 0.25 + kOneLaneMargin_m);

VehicleOptions Options() {
  VehicleOptions options = test::OptionsWithoutUltrasonics();
  options.emission_radius_m = 50;
  options.one_lanes = {kSection};
  return options;
}

// Comes from the east.
Beacon PeerAt(double x_m, double cruise_m_s, Rule rule = Rule::kCruise) {
  Beacon peer = BeaconOf(2, 1, {.position_world = {x_m, 0}, .heading_rad = kPi}, cruise_m_s);
  peer.rule = rule;
  return peer;
}

Beacon Rolls(Beacon peer) {
  peer.wheels = Rolling(peer.cruise_m_s);
  return peer;
}

// What it says last, with the peers' beacons that `beacons_at` gives for where it is: when it is
// commanded to stop, at x = until_m, or after 6 m.
template <typename BeaconsAt>
Outputs Drive(BeaconsAt beacons_at, const VehicleOptions& options = Options(),
              double until_m = 100) {
  BrainBench bench(options);
  Outputs out;
  double place_m = options.start_world.position_world.x;
  for (int i = 0; i < 400; ++i) {
    RangeScan scan = ClearScan(0);
    scan.wheels = Rolling(kCruise_m_s);
    const std::uint32_t heard = bench.NextTick() - 1;
    std::vector<Beacon> beacons;
    if (heard > 0) beacons = beacons_at(place_m);
    for (Beacon& beacon : beacons) {
      beacon.tick = Tick{heard};
      beacon.seq = heard;
    }
    out = bench.Step(scan, beacons);
    place_m = out.beacon.world_from_body.position_world.x;
    if (out.command.target.left_rad_s <= 0 || place_m >= until_m) break;
  }
  return out;
}

double PlaceOf(const Outputs& out) { return out.beacon.world_from_body.position_world.x; }

double DrivesUpTo(const Beacon& peer, const VehicleOptions& options = Options()) {
  return PlaceOf(Drive([&peer](double) { return std::vector{peer}; }, options));
}

TEST(OneLane, IsNotEnteredWhileAnotherComesTowardsInIt) {
  for (const double cruise_m_s : {kSlower_m_s, kFaster_m_s}) {
    const double place_m = DrivesUpTo(Rolls(PeerAt(8, cruise_m_s)));
    EXPECT_LT(place_m, kOutside_m) << cruise_m_s;
    EXPECT_GT(place_m, kOutside_m - 0.3) << cruise_m_s;
  }
}

// Regression: one that stood in it and gave way to a third was taken to let this one in.
TEST(OneLane, OneThatHaltsInItLetsNoneIn) {
  EXPECT_LT(DrivesUpTo(PeerAt(8, kSlower_m_s, Rule::kGiveWay)), kOutside_m);
  EXPECT_LT(DrivesUpTo(PeerAt(8, kSlower_m_s, Rule::kObstacle)), kOutside_m);
}

// Regression: one that looked for a path past something stood turned round, and was followed.
TEST(OneLane, OneThatStandsTurnedRoundInItIsNotFollowed) {
  Beacon turned = PeerAt(6, kSlower_m_s, Rule::kObstacle);
  turned.world_from_body.heading_rad = 0;
  turned.toward_world = {-90, 0};
  EXPECT_LT(DrivesUpTo(turned), kOutside_m);
  test::Onlooker onlooker;
  onlooker.Knows(kSection);
  Peer peer = test::PeerAt(turned.world_from_body);
  peer.beacon.toward_world = turned.toward_world;
  EXPECT_FALSE(onlooker.RelatePeer(&peer).leads);
}

// Regression: it stood in a queue, gave way to none, and was waited for without end.
TEST(OneLane, OneThatQueuesOutsideLetsTheFirstInWithoutSayingSo) {
  Beacon queues = PeerAt(10, kSlower_m_s, Rule::kKeepClear);
  queues.blocked_by = VehicleId{9};
  EXPECT_GT(DrivesUpTo(queues), 4);
}

TEST(OneLane, OneThatComesFirstAndIsNearIsLetInFirst) {
  EXPECT_LT(DrivesUpTo(Rolls(PeerAt(11, kFaster_m_s))), kOutside_m);
}

// One that is in is waited for: it is enough to be in before the other could be.
TEST(OneLane, OneThatComesFirstAndIsFarIsNotWaitedFor) {
  EXPECT_GT(DrivesUpTo(Rolls(PeerAt(25, kFaster_m_s))), 4);
}

TEST(OneLane, IsLeftByOneThatIsInWhateverTheOrder) {
  VehicleOptions options = Options();
  options.start_world = {.position_world = {4, 0}};
  options.goal.at_world = {20, 0};
  EXPECT_GT(DrivesUpTo(Rolls(PeerAt(12, kFaster_m_s)), options), 8);
}

TEST(OneLane, IsDrivenThroughOneBehindTheOther) {
  Beacon ahead = PeerAt(4.5, kCruise_m_s);
  ahead.world_from_body.heading_rad = 0;
  ahead.toward_world = {20, 0};
  EXPECT_GT(DrivesUpTo(Rolls(ahead)), kOutside_m + 0.3);
}

// Regression: one that stood where a peer wanted to be drove on to clear that, into the section.
TEST(OneLane, IsNotEnteredToClearTheGoalOfOneThatIsIn) {
  Beacon leaves = PeerAt(8, kFaster_m_s);
  leaves.toward_world = {1.8, 0};
  EXPECT_LT(DrivesUpTo(Rolls(leaves)), kOutside_m);
}

// Comes from the south and crosses the path at x_m, more eastwards than against this vehicle.
Beacon CrossesAt(double x_m, double y_m, double cruise_m_s) {
  Beacon peer = BeaconOf(3, 1, {.position_world = {x_m, y_m}, .heading_rad = kPi / 2}, cruise_m_s);
  peer.toward_world = {x_m + 0.5, 10};
  return peer;
}

// Regression: one that was in it stood there for one of its own side that came first in the order;
// that one waited for one outside at the other end, which waited for the first.
TEST(OneLane, IsLeftBeforeAnyOfTheOwnSideIsGivenWayTo) {
  VehicleOptions options = Options();
  options.start_world = {.position_world = {4, 0}};
  options.goal.at_world = {20, 0};
  Beacon crosses = CrossesAt(8, -1.5, kFaster_m_s);
  crosses.wheels = Rolling(0.05);  // it takes its time
  EXPECT_GT(DrivesUpTo(crosses, options), 8);
  const auto before_it = [&] {
    return Drive([&](double) { return std::vector{crosses}; }, options, 6);
  };
  EXPECT_EQ(before_it().beacon.gives_way_to, kNoVehicle);
  options.one_lanes.clear();
  EXPECT_LT(DrivesUpTo(crosses, options), 7.4);
  EXPECT_EQ(before_it().beacon.gives_way_to, VehicleId{3});
}

// Regression: past the point where it could stop before a crossing it drove on into the section
// that starts behind it, where another one had come in meanwhile.
TEST(OneLane, IsNotEnteredBecauseTheCrossingBeforeItIs) {
  const double place_m = PlaceOf(Drive([](double x_m) {
    Beacon crosses = CrossesAt(1.5, -1.2, kSlower_m_s);
    crosses.rule = Rule::kGiveWay;
    crosses.gives_way_to = VehicleId{1};
    const Beacon peer =
        x_m < 1.2 ? PeerAt(10, kSlower_m_s, Rule::kGiveWay) : Rolls(PeerAt(9, kSlower_m_s));
    return std::vector{crosses, peer};
  }));
  EXPECT_LT(place_m, kOutside_m);
  EXPECT_GT(place_m, 1.2);
}

// Each change of direction takes the time of a passage.
TEST(OneLane, IsEnteredBehindOneOfTheOwnDirectionWhileThoseOfTheOtherWait) {
  const auto drives_up_to = [](double ahead_m, std::uint32_t waited_ticks) {
    Beacon ahead = Rolls(PeerAt(ahead_m, kCruise_m_s));
    ahead.vehicle = VehicleId{3};
    ahead.boot_epoch = 103;
    ahead.order.vehicle = VehicleId{3};
    ahead.world_from_body.heading_rad = 0;
    ahead.toward_world = {20, 0};
    Beacon waits = PeerAt(10, kFaster_m_s, Rule::kNotGranted);
    waits.order.waited_ticks = waited_ticks;
    return PlaceOf(Drive([&](double) { return std::vector{ahead, waits}; }));
  };
  EXPECT_GT(drives_up_to(5, 0), 3);
  EXPECT_LT(drives_up_to(5, 40), kOutside_m);   // it has waited longer
  EXPECT_LT(drives_up_to(9.5, 0), kOutside_m);  // the one ahead is out too soon
}

TEST(OneLane, IsKnownToCooperativeVehiclesAlone) {
  OwnCourse course{.path = {{0, 0}, {1, 0}}, .distance_to_goal_m = 10};
  VehicleOptions options = Options();
  EXPECT_EQ(FindLanesAhead({}, course, options).count, 1U);
  options.behaviour = Behaviour::kLectureYield;
  EXPECT_EQ(FindLanesAhead({}, course, options).count, 0U);
}

TEST(LanesAhead, AreThoseThatTheCourseLeadsInto) {
  const VehicleOptions options = Options();
  OwnCourse course{.path = {{0, 0}, {1, 0}}, .distance_to_goal_m = 10};
  const LanesAhead ahead = FindLanesAhead({}, course, options);
  ASSERT_EQ(ahead.count, 1U);
  EXPECT_NEAR(ahead.of[0].own.begin_m, kOutside_m, 1e-9);
  EXPECT_NEAR(ahead.of[0].own.end_m, 12 - kOutside_m, 1e-9);
  EXPECT_TRUE(ahead.of[0].forward);
  course.distance_to_goal_m = kOutside_m - 0.01;  // ends before it
  EXPECT_EQ(FindLanesAhead({}, course, options).count, 0U);
  course = {.path = {{9.9, 0}, {1, 0}}, .distance_to_goal_m = 10};  // has left it
  EXPECT_EQ(FindLanesAhead({}, course, options).count, 0U);
  course.path = {{9.8, 0}, {-1, 0}};
  ASSERT_EQ(FindLanesAhead({}, course, options).count, 1U);
  EXPECT_FALSE(FindLanesAhead({}, course, options).of[0].forward);
  course.arrived = true;
  EXPECT_EQ(FindLanesAhead({}, course, options).count, 0U);
}

// Two standard deviations of the own position.
TEST(LanesAhead, StartEarlierForOneThatKnowsItsPositionLess) {
  const OwnCourse course{.path = {{0, 0}, {1, 0}}, .distance_to_goal_m = 10};
  const OwnPose pose{.covariance = {.xx_m2 = 0.01, .yy_m2 = 0.01}};
  EXPECT_NEAR(FindLanesAhead(pose, course, Options()).of[0].own.begin_m, kOutside_m - 0.2, 1e-9);
}

TEST(LanesAhead, AreTheNearestWhereThereAreMany) {
  VehicleOptions options = Options();
  options.one_lanes.clear();
  for (int i = 7; i >= 1; --i) options.one_lanes.push_back({{10.0 * i, 0}, {10.0 * i + 1, 0}, 1});
  const OwnCourse course{.path = {{0, 0}, {1, 0}}, .distance_to_goal_m = 100};
  const LanesAhead ahead = FindLanesAhead({}, course, options);
  ASSERT_EQ(ahead.count, ahead.of.size());
  for (const LaneAhead& lane : ahead.All()) EXPECT_LT(lane.own.begin_m, 41);
}

TEST(OneLaneAt, IsWhereThePointIsWithinHalfOfTheWidth) {
  const std::vector<OneLane> lanes = {{{20, 0}, {21, 0}, 1}, kSection};
  EXPECT_EQ(FindOneLane({5, 0.49}, lanes), &lanes[1]);
  EXPECT_EQ(FindOneLane({5, 0.51}, lanes), nullptr);
  EXPECT_EQ(FindOneLane({2.6, 0.2}, lanes), &lanes[1]);
  EXPECT_EQ(FindOneLane({2.6, 0.4}, lanes), nullptr);
}

// The quick look at beacons as they are misses none that the careful one finds later.
TEST(OneLane, NoPeerThatMeetsThisVehicleThereIsTakenForIrrelevant) {
  Random dice(1, 0);
  test::Onlooker onlooker;
  onlooker.Knows(kSection);
  int meet = 0;
  for (int i = 0; i < 20'000; ++i) {
    Peer peer = test::PeerAt({{dice.Uniform(-5, 30), dice.Uniform(-8, 8)}, dice.Uniform(-kPi, kPi)},
                             {}, Rolling(dice.Uniform(0, 2)));
    peer.beacon.toward_world = {dice.Uniform(-5, 15), dice.Uniform(-4, 4)};
    if (i % 4 == 0) peer.beacon.toward_world = peer.beacon.world_from_body.position_world;
    const PeerView view = onlooker.RelatePeer(&peer);
    if (!FindOneLaneConflict(view, onlooker.Own())) continue;
    ++meet;
    ASSERT_TRUE(MayMeetInOneLane(peer.beacon, view.speed_m_s * 0.05, onlooker.Own())) << i;
  }
  EXPECT_GT(meet, 1000);
}

// It turns into the section with all of its body inside: nearer to the axis than half of what the
// width exceeds the body by.
TEST(OneLane, AWaypointInItIsPassedNearer) {
  const auto passes = [](double away_m, double width_m) {
    VehicleOptions options = Options();
    options.one_lanes = {{{3, 0}, {9, 0}, width_m}};
    options.route.waypoints_world[0] = {4, 0};
    options.route.count = 1;
    RouteProgress route;
    GoalProgress progress;
    UpdatePath({.world_from_body = {.position_world = {4, away_m}}, .forward_world = {1, 0}},
               options, &route, &progress);
    return route.waypoint == 1;
  };
  EXPECT_TRUE(passes(0.24, 1));
  EXPECT_FALSE(passes(0.26, 1));
  EXPECT_TRUE(passes(0.29, 2));  // as everywhere
  EXPECT_FALSE(passes(0.31, 2));
  EXPECT_TRUE(passes(0.09, 0.5));  // never less than that
}

// Regression: on a detour in a doorway it passed the exit for one it could not reach, another one
// next to a passage the entry, and both drove at the wall for ever.
TEST(OneLane, NoWaypointInItNorFromWithinItIsPassedAtADistance) {
  const auto passes = [](double from_m, double waypoint_m) {
    VehicleOptions options = Options();
    options.route.waypoints_world[0] = {waypoint_m, 0};
    options.route.count = 1;
    RouteProgress route;
    GoalProgress progress;
    progress.detour_tick = Tick{1};
    UpdatePath({.world_from_body = {.position_world = {from_m, 0}}, .forward_world = {1, 0}},
               options, &route, &progress);
    return route.waypoint == 1;
  };
  EXPECT_TRUE(passes(-4, -3));
  EXPECT_FALSE(passes(5, 6));
  EXPECT_FALSE(passes(2, 3));
  EXPECT_FALSE(passes(9, 10));
}

}  // namespace
}  // namespace giveway
