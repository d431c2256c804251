// What a vehicle in lockstep holds until the tick that it belongs to.
#include "services/vehicle_node/world_time.h"

#include <gmock/gmock.h>

#include <memory>

namespace giveway {
namespace {

constexpr Nanoseconds kTick = std::chrono::milliseconds(50);

template <typename Scan>
Scan At(std::uint32_t tick) {
  Scan scan;
  scan.tick = Tick{tick};
  return scan;
}

SignalState Light(std::uint32_t id, std::uint32_t tick) {
  SignalState state = At<SignalState>(tick);
  state.id = SignalId{id};
  return state;
}

// All of one tick but the scan. What inputs point to goes with it, as in a link.
struct Sensed {
  explicit Sensed(std::uint32_t tick)
      : radar(At<RadarScan>(tick)), lidar(At<LidarScan>(tick)), camera(At<CameraScan>(tick)) {
    inputs.radar = &radar;
    inputs.lidar = &lidar;
    inputs.camera = &camera;
    inputs.pose_fix = At<PoseFix>(tick);
  }
  RadarScan radar;
  LidarScan lidar;
  CameraScan camera;
  Inputs inputs;
};

void KeepWithoutScan(WorldTime* time, std::uint32_t tick, std::vector<SignalState> signals) {
  const auto sensed = std::make_unique<Sensed>(tick);
  sensed->inputs.signals = signals;
  EXPECT_FALSE(time->Keep(&sensed->inputs, kTick));
}

Inputs KeepScan(WorldTime* time, Inputs inputs, std::uint32_t tick) {
  inputs.scan = At<RangeScan>(tick);
  EXPECT_TRUE(time->Keep(&inputs, kTick));
  return inputs;
}

TEST(WorldTime, HoldsTheNewestOfWhatIsSensedUntilAScanComes) {
  WorldTime time;
  KeepWithoutScan(&time, 1, {});
  KeepWithoutScan(&time, 2, {});
  const Inputs inputs = KeepScan(&time, {}, 2);
  ASSERT_NE(inputs.radar, nullptr);
  ASSERT_NE(inputs.lidar, nullptr);
  ASSERT_NE(inputs.camera, nullptr);
  ASSERT_TRUE(inputs.pose_fix.has_value());
  EXPECT_EQ(inputs.radar->tick, Tick{2});
  EXPECT_EQ(inputs.lidar->tick, Tick{2});
  EXPECT_EQ(inputs.camera->tick, Tick{2});
  EXPECT_EQ(inputs.pose_fix->tick, Tick{2});
}

TEST(WorldTime, GivesWhatItHeldOnce) {
  WorldTime time;
  KeepWithoutScan(&time, 1, {Light(1, 1)});
  KeepScan(&time, {}, 1);
  const Inputs inputs = KeepScan(&time, {}, 2);
  EXPECT_EQ(inputs.radar, nullptr);
  EXPECT_EQ(inputs.lidar, nullptr);
  EXPECT_EQ(inputs.camera, nullptr);
  EXPECT_FALSE(inputs.pose_fix.has_value());
  EXPECT_TRUE(inputs.signals.empty());
}

TEST(WorldTime, PrefersWhatComesWithTheScan) {
  WorldTime time;
  KeepWithoutScan(&time, 1, {});
  const Sensed newer(2);
  const Inputs inputs = KeepScan(&time, newer.inputs, 2);
  EXPECT_EQ(inputs.radar, &newer.radar);
  EXPECT_EQ(inputs.lidar, &newer.lidar);
  EXPECT_EQ(inputs.camera, &newer.camera);
  EXPECT_EQ(inputs.pose_fix->tick, Tick{2});
}

TEST(WorldTime, HoldsTheNewestStateOfEachSignal) {
  WorldTime time;
  KeepWithoutScan(&time, 1, {Light(1, 1), Light(2, 1)});
  KeepWithoutScan(&time, 2, {Light(2, 2)});
  const std::vector<SignalState> newest = {Light(1, 3), Light(3, 3)};
  Inputs with_signals;
  with_signals.signals = newest;
  const Inputs inputs = KeepScan(&time, with_signals, 3);
  std::vector<std::pair<std::uint32_t, Tick>> states;
  for (const SignalState& state : inputs.signals) states.emplace_back(Number(state.id), state.tick);
  EXPECT_THAT(states, ::testing::UnorderedElementsAre(
                          std::pair(1U, Tick{3}), std::pair(2U, Tick{2}), std::pair(3U, Tick{3})));
}

}  // namespace
}  // namespace giveway
