#include "sim_world/run/run_checkpoint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "services/types/math/math.h"
#include "sim_world/run/run.h"
#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

constexpr WorldEpoch kNext{8};

// Four vehicles that meet, walls, a cart and a door; with slip, so that randomness is in it too.
Scenario Busy() {
  Scenario scenario;
  for (std::uint32_t id = 1; id <= 4; ++id) {
    VehicleOptions options = VehicleAt(id, {{id * 1.2 - 3, id % 2 * 0.9}, id % 2 == 0 ? 3.0 : 0.1});
    options.profile.wheel_slip = 0.02;
    options.profile.encoder_noise = 0.01;
    options.goal = {.set = true, .at_world = options.start_world.position_world + Vec2{0.5, 0}};
    scenario.vehicles.push_back(options);
  }
  scenario.seed = 3;
  scenario.walls = {{{-4, -1.5}, {4, -1.5}}, {{-4, 2}, {4, 2}}};
  scenario.obstacles = {
      {.start_world = {{3, -1}, 0}, .waypoints_world = {{-3, -1}}, .speed_m_s = 0.3}};
  scenario.doors = {{.from_world = {4, -1}, .to_world = {4, 1}, .closed_s = 1, .open_s = 1}};
  scenario.faults = {{.kind = FaultKind::kKill, .vehicle = VehicleId{4}, .at_s = 2}};
  scenario.duration_s = 1000;
  scenario.expect.parted = true;
  return scenario;
}

// Straights and turns by vehicle and time; vehicle 3 sends nothing in every third tick.
std::vector<MotorCommand> Script(const sim::Run& run, WorldEpoch epoch, int tick) {
  constexpr WheelSpeeds kPhases[] = {{4, 4}, {2, 4.5}, {-3, -3}, {5, 1}, {6, 6.3}};
  std::vector<MotorCommand> commands;
  for (std::uint32_t id = 1; id <= 4; ++id) {
    if (id == 3 && tick % 3 == 0) continue;
    if (id == 4 && tick > 60) continue;
    const WheelSpeeds target = kPhases[(static_cast<std::size_t>(tick) / 17 + id) % 5];
    commands.push_back(Drive(id, run.Now(), target.left_rad_s, target.right_rad_s));
    commands.back().epoch = epoch;
    commands.back().decision.rule = Rule::kGiveWay;
  }
  return commands;
}

FleetCheckpoint Through(const FleetCheckpoint& checkpoint) {
  return std::get<FleetCheckpoint>(FromBytes(ToBytes(checkpoint)));
}

TEST(RunCheckpoint, ARestoredRunGoesOnBitForBit) {
  for (const int taken_at : {1, 37, 90, 150}) {
    const Scenario scenario = Busy();
    sim::Run original(scenario, kEpoch);
    for (const VehicleOptions& options : scenario.vehicles) original.Join(options.id);
    original.Start();
    for (int tick = 0; tick < taken_at; ++tick) original.Advance(Script(original, kEpoch, tick));

    sim::Run restored(scenario, kNext);
    ASSERT_TRUE(restored.Restore(Through({.run = original.Save()}).run, {}));
    EXPECT_EQ(restored.State(), RunState::kWaiting);
    restored.Start();
    for (int tick = taken_at; tick < 400; ++tick) {
      original.Advance(Script(original, kEpoch, tick));
      restored.Advance(Script(restored, kNext, tick));
      ASSERT_EQ(original.Hash(), restored.Hash()) << taken_at << ", tick " << tick;
    }
    original.End("compared");
    restored.End("compared");
    original.Advance({});
    restored.Advance({});
    EXPECT_GE(original.Figures().contacts, 1U);
    EXPECT_EQ(original.Figures().contacts, restored.Figures().contacts);
    EXPECT_EQ(original.Figures().min_separation_m, restored.Figures().min_separation_m);
    EXPECT_EQ(original.Figures().ticks, restored.Figures().ticks);
    EXPECT_EQ(restored.Figures().epoch, kNext);
    ASSERT_EQ(original.Truths().size(), restored.Truths().size());
    for (std::size_t i = 0; i < original.Truths().size(); ++i) {
      EXPECT_EQ(original.Truths()[i].arrived, restored.Truths()[i].arrived);
    }
  }
}

TEST(RunCheckpoint, ARestoredRunWaitsAndItsBodiesBrake) {
  const Scenario scenario = Busy();
  sim::Run original(scenario, kEpoch);
  for (const VehicleOptions& options : scenario.vehicles) original.Join(options.id);
  original.Start();
  for (int tick = 0; tick < 30; ++tick) original.Advance(Script(original, kEpoch, tick));
  sim::Run restored(scenario, kNext);
  ASSERT_TRUE(restored.Restore(original.Save(), {}));
  for (int tick = 0; tick < 60; ++tick) restored.Advance({});
  EXPECT_DOUBLE_EQ(restored.TimeSeconds(), original.TimeSeconds());
  for (const Truth& truth : restored.Truths()) EXPECT_EQ(truth.forward_m_s, 0);
  EXPECT_EQ(restored.State(), RunState::kWaiting);
}

// Regression: it waited for the one that had left, and ended later as if that one had died.
TEST(RunCheckpoint, AClosedRunThatIsRestoredEndsWhereAVehicleLeavesIt) {
  const Scenario scenario = Busy();
  sim::Run original(scenario, kEpoch);
  for (const VehicleOptions& options : scenario.vehicles) original.Join(options.id);
  original.Leave(kOne);
  original.Join(kOne);
  original.Advance({});
  EXPECT_EQ(original.State(), RunState::kWaiting);  // it had not started: others may take its place
  original.Start();
  for (int tick = 0; tick < 30; ++tick) original.Advance(Script(original, kEpoch, tick));
  sim::Run restored(scenario, kNext);
  ASSERT_TRUE(restored.Restore(original.Save(), {}));
  restored.Advance({});
  restored.Leave(kOne);
  restored.Advance({});
  EXPECT_EQ(restored.State(), RunState::kEnded);
  EXPECT_EQ(restored.EndReason(), "vehicle_left");
  EXPECT_FALSE(restored.Figures().passed);
}

// Regression: it counted in the verdict, and there was no event of it.
TEST(RunCheckpoint, AContactWhileARestoredRunBrakesIsAnEvent) {
  const Scenario scenario = ScenarioOf({VehicleAt(1, {{0, 0}, 0}), VehicleAt(2, {{2, 0}, kPi})});
  sim::Run original(scenario, kEpoch);
  for (const VehicleOptions& options : scenario.vehicles) original.Join(options.id);
  original.Start();
  const auto gap_m = [&] {
    return original.BodyOf(kTwo)->world_from_body.position_world.x -
           original.BodyOf(kOne)->world_from_body.position_world.x - 0.5;
  };
  while (gap_m() > 0.1) {
    original.Advance({{Drive(1, original.Now(), 6, 6), Drive(2, original.Now(), 6, 6)}});
  }
  ASSERT_EQ(original.Contacts(), 0U);
  sim::Run restored(scenario, kEpoch);
  ASSERT_TRUE(restored.Restore(original.Save(), {}));
  std::vector<WorldEvent> contacts;
  for (int tick = 0; tick < 20; ++tick) {
    restored.Advance({});
    std::ranges::copy_if(restored.Events(), std::back_inserter(contacts),
                         [](const WorldEvent& event) { return event.kind == EventKind::kContact; });
  }
  EXPECT_EQ(restored.Contacts(), 1U);
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts.front().vehicle, kOne);
  EXPECT_EQ(contacts.front().other, kTwo);
}

// Regression: a world that restarted itself in its epoch counted its events from 1 again, and an
// observer that had joined it again dropped as many as it had had before.
TEST(RunCheckpoint, EventsAreNumberedOnThroughAnEpochAndFromOneInTheNext) {
  const Scenario scenario = Busy();
  sim::Run original(scenario, kEpoch);
  for (const VehicleOptions& options : scenario.vehicles) original.Join(options.id);
  original.Start();
  for (int tick = 0; tick < 90; ++tick) original.Advance(Script(original, kEpoch, tick));
  const RunCheckpoint taken = Through({.run = original.Save()}).run;
  ASSERT_GT(taken.event_seq, 1U);
  for (const WorldEpoch epoch : {kEpoch, kNext}) {
    sim::Run restored(scenario, epoch);
    ASSERT_TRUE(restored.Restore(taken, {}));
    restored.End("compared");
    restored.Advance({});
    ASSERT_FALSE(restored.Events().empty());
    EXPECT_EQ(restored.Events().front().seq, epoch == kEpoch ? taken.event_seq + 1 : 1);
  }
}

// Regression: a vehicle whose process was stopped on purpose, and whose body was removed meanwhile,
// was not waited for after a restart of the world, and a closed run ended without it.
TEST(RunCheckpoint, ARemovedVehicleThatIsWaitedForIsStillWaitedForInARestoredRun) {
  const auto alone_at = [](std::uint32_t id, Vec2 at_world) {
    VehicleOptions options = VehicleAt(id, {at_world, 0});
    options.goal = {.set = true, .at_world = at_world};
    return options;
  };
  Scenario scenario = ScenarioOf({VehicleAt(1, {{0, 0}, 0}), alone_at(2, {0, 5})});
  scenario.vehicles[0].goal = {.set = true, .at_world = {0.5, 0}};
  scenario.duration_s = 1000;
  scenario.remove_after_s = 1;
  const faults::Schedule stopped = {
      {.rule = "rule",
       .at_s = 1,
       .for_s = 60,
       .kind = faults::Kind::kRestart,
       .target = {.what = faults::Target::What::kVehicle, .vehicle = kTwo}}};
  sim::Run original(scenario, kEpoch, OnThisThread, {stopped, 1});
  for (const VehicleOptions& options : scenario.vehicles) original.Join(options.id);
  original.Start();
  while (original.BodyOf(kTwo) != nullptr) original.Advance({{Drive(1, original.Now(), 0, 0)}});
  ASSERT_EQ(original.State(), RunState::kRunning);

  sim::Run restored(scenario, kNext, OnThisThread, {stopped, 1});
  ASSERT_TRUE(restored.Restore(Through({.run = original.Save()}).run, {}));
  EXPECT_TRUE(restored.EveryoneJoined());
  EXPECT_EQ(restored.BodyOf(kTwo), nullptr);
  restored.Start();
  EXPECT_EQ(restored.Hash(), original.Hash());
  for (int tick = 0; tick < 100; ++tick) {
    MotorCommand command = Drive(1, restored.Now(), 4, 4);
    const Vec2 at_world = restored.BodyOf(kOne)->world_from_body.position_world;
    if (at_world.x > 0.4) command.target = {};
    command.epoch = kNext;
    restored.Advance({{command}});
  }
  EXPECT_EQ(restored.State(), RunState::kRunning) << restored.EndReason();
  restored.Join(scenario.vehicles[1]);
  EXPECT_NE(restored.BodyOf(kTwo), nullptr);
}

TEST(RunCheckpoint, DoesNotFitAnotherScenario) {
  sim::Run original(Busy(), kEpoch);
  Scenario other = Busy();
  other.faults.clear();
  EXPECT_FALSE(sim::Run(other, kNext).Restore(original.Save(), {}));
  other = Busy();
  other.obstacles.clear();
  EXPECT_FALSE(sim::Run(other, kNext).Restore(original.Save(), {}));
}

std::string SomeBytes() {
  sim::Run run(Busy(), kEpoch);
  run.Join(VehicleId{1});
  run.Advance({});
  return ToBytes({.scenario = 42,
                  .run = run.Save(),
                  .slots = {{.vehicle = VehicleId{1}, .taken = true, .session = {1, 2, 3, 4}}}});
}

TEST(RunCheckpoint, KeepsWhatItWasGiven) {
  const auto read = std::get<FleetCheckpoint>(FromBytes(SomeBytes()));
  EXPECT_EQ(read.scenario, 42U);
  EXPECT_EQ(read.run.epoch, kEpoch);
  ASSERT_EQ(read.slots.size(), 1U);
  EXPECT_EQ(read.slots[0].session, (SessionId{1, 2, 3, 4}));
  EXPECT_EQ(ToBytes(read), SomeBytes());
}

TEST(RunCheckpoint, AnyByteChangedCutOffOrAddedIsNoticed) {
  const std::string bytes = SomeBytes();
  const auto is_refused = [](const std::string& spoilt) {
    return std::holds_alternative<std::string>(FromBytes(spoilt));
  };
  ASSERT_FALSE(is_refused(bytes));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string spoilt = bytes;
    spoilt[i] = static_cast<char>(spoilt[i] ^ 0x10);
    EXPECT_TRUE(is_refused(spoilt)) << i;
    EXPECT_TRUE(is_refused(bytes.substr(0, i))) << i;
  }
  EXPECT_TRUE(is_refused(bytes + '\0'));
  EXPECT_TRUE(is_refused(""));
}

}  // namespace
}  // namespace giveway::sim
