#include "sim_world/run/run_checkpoint.h"

#include <gtest/gtest.h>

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
