// Boxes, slip and encoder noise, symmetry, and independence of how the work is divided.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "services/types/math/math.h"
#include "services/types/math/random.h"
#include "sim_world/dynamics/drive.h"
#include "sim_world/world.h"
#include "tests/unit/sim_world/cuts.h"
#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

VehicleOptions BoxAt(std::uint32_t id, Pose start) {
  VehicleOptions options = VehicleAt(id, start);
  options.profile.shape = BodyShape::kBox;
  options.profile.box_half_m = {0.25, 0.19};
  options.profile.body_radius_m = Norm(options.profile.box_half_m);
  return options;
}

TEST(WorldBodies, BoxesStopNoseToNoseNotDiscToDisc) {
  World world = WorldOf(ScenarioOf({BoxAt(1, {}), BoxAt(2, {{0.8, 0}, kPi})}));
  DriveAll(&world, 4, 4, 60);
  const double apart_m = world.Bodies()[1].world_from_body.position_world.x -
                         world.Bodies()[0].world_from_body.position_world.x;
  EXPECT_EQ(world.Contacts(), 1U);
  EXPECT_GE(apart_m, 0.5);
  EXPECT_LE(apart_m, 0.5 + kTouch_m);
  EXPECT_EQ(world.Approaches().Closest()->gap_m, 0);
}

// The flanks are 0.38 m wide: as discs of their half diagonal these two would collide.
TEST(WorldBodies, BoxesPassWhereTheirDiscsWouldNot) {
  World world = WorldOf(ScenarioOf({BoxAt(1, {}), BoxAt(2, {{3, 0.5}, kPi})}));
  DriveAll(&world, 4, 4, 150);
  EXPECT_EQ(world.Contacts(), 0U);
  EXPECT_NEAR(world.Approaches().Closest()->gap_m, 0.12, kTouch_m);
}

// Long boxes flank to flank look near by their discs; the two discs further off are nearer.
TEST(WorldBodies, TheFirstRecordIsOfTheNearestShellsNotOfTheNearestDiscs) {
  Scenario scenario = ScenarioOf({BoxAt(1, {}), BoxAt(2, {{0, 1.9}, 0}), VehicleAt(3, {{9, 0}, 0}),
                                  VehicleAt(4, {{9, 1.7}, 0})});
  for (std::size_t i = 0; i < 2; ++i) scenario.vehicles[i].profile.box_half_m = {0.5, 0.1};
  World world = WorldOf(scenario);
  world.Advance(true);
  EXPECT_EQ(world.Approaches().Closest()->vehicle, VehicleId{3});
  EXPECT_NEAR(world.Approaches().Closest()->gap_m, 1.2, 1e-9);
}

TEST(WorldBodies, ABoxTurningInPlaceIsStoppedByAWallAndCountsOnce) {
  Scenario scenario = ScenarioOf({BoxAt(1, {})});
  scenario.walls = {{{0.3, -2}, {0.3, 2}}};
  World world = WorldOf(scenario);
  DriveAll(&world, -2, 2, 100);
  EXPECT_EQ(world.Contacts(), 1U);
  // The corner is 0.314 m from the centre; it stands at the wall.
  const double corner_rad = std::atan2(0.19, 0.25);
  const double heading = world.Bodies()[0].world_from_body.heading_rad;
  EXPECT_NEAR(Norm({0.25, 0.19}) * std::cos(corner_rad - heading), 0.3, kTouch_m);
  EXPECT_EQ(world.Bodies()[0].world_from_body.position_world, (Vec2{}));
}

TEST(WorldBodies, ATouchingPairThatSlidesIsOneContact) {
  Scenario scenario = ScenarioOf({BoxAt(1, {{0, 0}, 0.02})});
  scenario.walls = {{{-1, 0.21}, {20, 0.21}}};
  World world = WorldOf(scenario);
  DriveAll(&world, 3, 3, 100);
  EXPECT_EQ(world.Contacts(), 1U);
  DriveAll(&world, 4, 3, 400);  // off the wall, pressing the rear corner along it
  EXPECT_LE(world.Contacts(), 2U);
}

// Four meet in the middle: none is favoured.
TEST(WorldBodies, ASymmetricSituationStaysSymmetric) {
  Scenario scenario = ScenarioOf({});
  for (std::uint32_t i = 0; i < 4; ++i) {
    const double heading = WrapAngle(i * kPi / 2);
    scenario.vehicles.push_back(
        VehicleAt(i + 1, {{-1.5 * Cos(heading), -1.5 * Sin(heading)}, heading}));
  }
  World world = WorldOf(scenario);
  DriveAll(&world, 4, 4, 120);
  for (const Body& body : world.Bodies()) {
    EXPECT_NEAR(Norm(body.world_from_body.position_world), 0.25 * std::sqrt(2), 3 * kTouch_m);
  }
  EXPECT_GE(world.Contacts(), 2U);  // what the first to touch keep apart may stay just out of touch
}

TEST(WorldBodies, WithoutSlipAndNoiseGroundWheelsAndEncodersAgree) {
  World world = WorldOf(ScenarioOf({VehicleAt(1, {})}));
  DriveAll(&world, 4, 3, 30);
  const Body& body = world.Bodies()[0];
  EXPECT_EQ(body.encoders, body.wheels);
  EXPECT_EQ(body.ground, body.wheels);
}

TEST(WorldBodies, SlipMovesTheBodyAndNoiseTheEncodersOnly) {
  Scenario slip = ScenarioOf({VehicleAt(1, {})});
  Scenario noise = slip;
  slip.vehicles[0].profile.wheel_slip = 0.1;
  noise.vehicles[0].profile.encoder_noise = 0.1;
  World plain = WorldOf(ScenarioOf({VehicleAt(1, {})}));
  World slipping = WorldOf(slip);
  World noisy = WorldOf(noise);
  for (World* world : {&plain, &slipping, &noisy}) DriveAll(world, 4, 4, 60);
  EXPECT_EQ(noisy.Bodies()[0].world_from_body, plain.Bodies()[0].world_from_body);
  EXPECT_NE(noisy.Bodies()[0].encoders, plain.Bodies()[0].encoders);
  EXPECT_NE(slipping.Bodies()[0].world_from_body, plain.Bodies()[0].world_from_body);
  EXPECT_EQ(slipping.Bodies()[0].encoders, plain.Bodies()[0].encoders);
}

TEST(WorldBodies, SlipAndNoiseHaveTheStatedDeviations) {
  RobotModel profile = PioneerP3dx();
  profile.wheel_slip = 0.05;
  profile.encoder_noise = 0.02;
  double slip = 0;
  double noise = 0;
  constexpr int kDraws = 20'000;
  for (int i = 0; i < kDraws; ++i) {
    const Rolled rolled = Roll(profile, {2, 2}, Random(3, static_cast<std::uint64_t>(i)));
    slip += std::pow(rolled.ground.left_rad_s / 2 - 1, 2);
    noise += std::pow(rolled.encoders.right_rad_s / 2 - 1, 2);
  }
  EXPECT_NEAR(std::sqrt(slip / kDraws), 0.05, 0.001);
  EXPECT_NEAR(std::sqrt(noise / kDraws), 0.02, 0.0005);
}

TEST(WorldBodies, SlipDoesNotDependOnWaitingForTheStart) {
  Scenario scenario = ScenarioOf({VehicleAt(1, {})});
  scenario.vehicles[0].profile.wheel_slip = 0.1;
  World prompt = WorldOf(scenario);
  World late = WorldOf(scenario);
  for (int i = 0; i < 17; ++i) late.Advance(false);
  DriveAll(&prompt, 4, 4, 50);
  DriveAll(&late, 4, 4, 50);
  // The very first tick of the prompt world has no tick to answer yet.
  World also_late = WorldOf(scenario);
  for (int i = 0; i < 5; ++i) also_late.Advance(false);
  DriveAll(&also_late, 4, 4, 50);
  EXPECT_EQ(late.Bodies()[0].world_from_body, also_late.Bodies()[0].world_from_body);
}

// What each transducer says, with the age of what it says.
void ExpectSameReadings(const World& a, const World& b, const char* what) {
  for (std::size_t i = 0; i < a.Bodies().size(); ++i) {
    for (std::size_t sensor = 0; sensor < kSensorCount; ++sensor) {
      const RangeReading& of_a = a.Bodies()[i].sonar.readings[sensor];
      const RangeReading& of_b = b.Bodies()[i].sonar.readings[sensor];
      ASSERT_EQ(of_a.kind, of_b.kind) << what << ", sensor " << sensor;
      if (of_a.kind == Echo::kNoData) continue;
      ASSERT_EQ(of_a.range_m, of_b.range_m) << what << ", sensor " << sensor;
      ASSERT_EQ(of_a.fired_before_s, of_b.fired_before_s) << what;
      ASSERT_EQ(TicksBetween(of_a.tick, a.Now()), TicksBetween(of_b.tick, b.Now())) << what;
    }
  }
}

// Regression: noise, drop-outs and the firing order were numbered by all ticks of the world, and
// two runs of one seed, in lockstep too, differed by how long vehicles took to join.
TEST(WorldBodies, UltrasonicsDoNotDependOnWaitingForTheStart) {
  Scenario scenario = ScenarioOf({VehicleAt(1, {}), VehicleAt(2, {{3, 0.2}, kPi})});
  scenario.walls = {{{-1, 1}, {4, 1}}};
  scenario.seed = 7;
  for (const SonarTier tier : {SonarTier::kTypical, SonarTier::kP3dx, SonarTier::kCrosstalk}) {
    scenario.sonar.tier = tier;
    World prompt = WorldOf(scenario);
    World late = WorldOf(scenario);
    World later = WorldOf(scenario);
    for (int i = 0; i < 6; ++i) late.Advance(false);
    for (int i = 0; i < 17; ++i) later.Advance(false);
    if (tier == SonarTier::kTypical) ExpectSameReadings(late, later, "the last of the wait");
    for (int tick = 0; tick < 60; ++tick) {
      for (World* world : {&prompt, &late, &later}) world->Advance(true);
      ExpectSameReadings(prompt, late, "after 6 ticks");
      ExpectSameReadings(prompt, later, "after 17 ticks");
    }
  }
}

TEST(WorldBodies, UltrasonicsContinueInARestoredWorldHoweverLongThatWaits) {
  Scenario scenario = ScenarioOf({VehicleAt(1, {}), VehicleAt(2, {{3, 0.2}, kPi})});
  scenario.sonar.tier = SonarTier::kTypical;
  World first = WorldOf(scenario);
  for (int tick = 0; tick < 30; ++tick) first.Advance(true);
  World second(scenario, kEpoch);
  ASSERT_TRUE(second.Restore(first.Save()));
  for (int tick = 0; tick < 9; ++tick) second.Advance(false);
  for (int tick = 0; tick < 30; ++tick) {
    first.Advance(true);
    second.Advance(true);
    ExpectSameReadings(first, second, "restored");
  }
}

TEST(WorldBodies, MotionNeverExceedsTheCapsHoweverMuchWheelsSlip) {
  Scenario scenario = ScenarioOf({VehicleAt(1, {})});
  scenario.vehicles[0].profile.wheel_slip = 0.5;
  World world = WorldOf(scenario);
  constexpr WheelSpeeds kFull[] = {{20, 20}, {-20, 20}, {-20, -20}, {25, 12}};
  double fastest_m = 0;
  for (int i = 0; i < 2000; ++i) {
    const Pose before = world.Bodies()[0].world_from_body;
    const WheelSpeeds target = kFull[i / 200 % 4];
    world.Take(Drive(1, world.Now(), target.left_rad_s, target.right_rad_s));
    world.Advance(true);
    const Pose after = world.Bodies()[0].world_from_body;
    const double driven_m = Norm(after.position_world - before.position_world);
    fastest_m = std::max(fastest_m, driven_m);
    ASSERT_LE(driven_m, 1.0 * kDt_s + 1e-12);
    ASSERT_LE(std::abs(WrapAngle(after.heading_rad - before.heading_rad)), 1.74 * kDt_s + 1e-12);
  }
  EXPECT_NEAR(fastest_m, 1.0 * kDt_s, 1e-9);  // the caps were reached
}

// Mostly forward, again every second, by id and tick alone.
WheelSpeeds Whim(std::uint32_t id, int tick) {
  Random random(id, static_cast<std::uint64_t>(tick / 20));
  const double left = random.Uniform(-3, 8);
  return {left, left + random.Uniform(-2, 2)};
}

// A crowd of every kind of thing, driven at random.
std::uint64_t Crowd(ParallelFor parallel, std::uint32_t* contacts) {
  Scenario scenario = ScenarioOf({});
  Random random(77);
  for (std::uint32_t id = 1; id <= 150; ++id) {
    const Pose start = {{0.9 * (id % 13), 0.9 * (id / 13)}, random.Uniform(-kPi, kPi)};
    scenario.vehicles.push_back(id % 3 == 0 ? BoxAt(id, start) : VehicleAt(id, start));
    scenario.vehicles.back().profile.wheel_slip = 0.05;
  }
  scenario.walls = {{{-1, -1}, {13, -1}}, {{-1, 12}, {13, 12.5}}};
  scenario.obstacles = {{.radius_m = 0.2,
                         .start_world = {{-0.6, 5}, 0},
                         .waypoints_world = {{13, 5}},
                         .speed_m_s = 0.6}};
  scenario.doors = {
      {.from_world = {6.5, 12}, .to_world = {6.5, 3}, .closed_s = 0.2, .offset_s = 5}};
  scenario.sonar.tier = SonarTier::kTypical;
  World world(scenario, kEpoch, std::move(parallel));
  for (const VehicleOptions& options : scenario.vehicles) world.Join(options.id);
  StateHash hash;
  for (int tick = 0; tick < 80; ++tick) {
    for (std::uint32_t id = 1; id <= 150; ++id) {
      const WheelSpeeds target = Whim(id, tick);
      world.Take(Drive(id, world.Now(), target.left_rad_s, target.right_rad_s));
    }
    world.Advance(true);
    world.AddTo(&hash);
    for (const Body& body : world.Bodies()) {
      hash.Add(body.encoders.left_rad_s);
      for (const RangeReading& reading : body.sonar.readings) hash.Add(reading.range_m);
    }
  }
  *contacts = world.Contacts();
  return hash.Value();
}

TEST(WorldBodies, NothingDependsOnHowTheWorkIsCut) {
  std::uint32_t contacts = 0;
  const std::uint64_t whole = Crowd(OnThisThread, &contacts);
  EXPECT_GT(contacts, 50U);
  for (const std::size_t pieces : {1U, 3U, 7U}) {
    std::uint32_t cut_contacts = 0;
    EXPECT_EQ(Crowd(InPiecesFromTheBack(pieces), &cut_contacts), whole) << pieces;
    EXPECT_EQ(cut_contacts, contacts);
  }
}

// Shells never overlap by more than the tolerance of a contact, whatever happens.
TEST(WorldBodies, NobodyEverOverlapsAnything) {
  Scenario scenario = ScenarioOf({});
  Random random(78);
  for (std::uint32_t id = 1; id <= 60; ++id) {
    const Pose start = {{0.8 * (id % 8), 0.8 * (id / 8)}, random.Uniform(-kPi, kPi)};
    scenario.vehicles.push_back(id % 2 == 0 ? BoxAt(id, start) : VehicleAt(id, start));
  }
  scenario.obstacles = {{.radius_m = 0.2,
                         .start_world = {{-1, 2}, 0},
                         .waypoints_world = {{7, 2}},
                         .speed_m_s = 0.8}};
  World world = WorldOf(scenario);
  for (int tick = 0; tick < 300; ++tick) {
    for (std::uint32_t id = 1; id <= 60; ++id) {
      const WheelSpeeds target = Whim(id, tick);
      world.Take(Drive(id, world.Now(), target.left_rad_s, target.right_rad_s));
    }
    world.Advance(true);
    const Motion cart = world.Obstacles()[0].Plan(false, kDt_s);
    for (const Body& a : world.Bodies()) {
      const Motion at_a = StandingAt(a.profile, a.world_from_body);
      ASSERT_GT(GapAt(at_a, cart, 0), -kTouch_m) << tick;
      for (const Body& b : world.Bodies()) {
        if (&a == &b) break;
        ASSERT_GT(GapAt(at_a, StandingAt(b.profile, b.world_from_body), 0), -kTouch_m) << tick;
      }
    }
  }
  EXPECT_GT(world.Contacts(), 50U);
}

}  // namespace
}  // namespace giveway::sim
