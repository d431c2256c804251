// A brain restored from its bytes is the same brain; malformed bytes give none.
#include "services/snapshot/brain_state.h"

#include <gtest/gtest.h>

#include "services/types/math/random.h"
#include "tests/support/brain_bench.h"

namespace giveway::test {
namespace {

constexpr std::uint32_t kPeers = 5;

// The inputs of a brain in one tick, by a seed: peers that come, go, lie and cross, echoes, lights,
// further sensors, QoS events.
class Fate {
 public:
  explicit Fate(std::uint64_t seed) : random_(seed) {}

  void Lead(Vehicle* brain, std::uint32_t tick) {
    RangeScan scan = ClearScan(tick);
    scan.wheels = {random_.Uniform(0, 3), random_.Uniform(0, 3)};
    counted_ = CountOn(counted_, scan.wheels, 0.05);
    scan.counted = counted_;
    if (Chance(0.4))
      SetEcho(&scan, static_cast<int>(random_.Uniform(0, 7.9)), random_.Uniform(0.1, 4));
    heard_.clear();
    for (std::uint32_t peer = 2; peer < 2 + kPeers; ++peer) {
      if (Chance(0.3)) continue;
      const Pose at{{random_.Uniform(-3, 3), random_.Uniform(-3, 3)}, random_.Uniform(-3, 3)};
      Beacon beacon = BeaconOf(peer, tick + (Chance(0.2) ? 1 : 0), at, random_.Uniform(0.1, 0.6));
      beacon.wheels = {random_.Uniform(0, 3), random_.Uniform(0, 3)};
      if (Chance(0.05)) beacon.mode = Mode::kLeaving;
      heard_.push_back(Received(beacon, tick * milliseconds_));
    }
    events_.clear();
    if (Chance(0.1))
      events_.push_back({.kind = QosEventKind::kDeadlineMissed, .vehicle = VehicleId{3}});
    Inputs inputs{.now = tick * milliseconds_, .beacons = heard_, .events = events_};
    if (!Chance(0.1)) inputs.scan = scan;
    const SignalState light{.id = SignalId{1},
                            .epoch = kEpoch,
                            .tick = Tick{tick},
                            .line_from_world = {4, -1},
                            .line_to_world = {4, 1},
                            .phase = Chance(0.5) ? SignalPhase::kRed : SignalPhase::kYellow,
                            .to_change_s = 1};
    if (Chance(0.5)) inputs.signals = std::span(&light, 1);
    RadarScan radar{.vehicle = VehicleId{1}, .epoch = kEpoch, .tick = Tick{tick}, .count = 1};
    radar.detections[0] = {
        .range_m = random_.Uniform(0.5, 5), .bearing_rad = 0.1, .range_rate_m_s = -0.2};
    if (Chance(0.3)) inputs.radar = &radar;
    outputs_ = brain->Step(inputs);
  }
  const Outputs& LastOutputs() const { return outputs_; }

 private:
  bool Chance(double share) { return random_.Uniform(0, 1) < share; }

  static constexpr Nanoseconds milliseconds_ = std::chrono::milliseconds(50);
  Random random_;
  WheelAngles counted_;
  std::vector<ReceivedBeacon> heard_;
  std::vector<QosEvent> events_;
  Outputs outputs_;
};

class BrainStateOfSeed : public testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, BrainStateOfSeed, testing::Range(0U, 60U));

// With every other seed, a brain that remembers echoes.
VehicleOptions OptionsOfSeed(std::uint32_t seed) {
  VehicleOptions options = DefaultOptions();
  if (seed % 2 == 1) options.sonar_noise = 0.01;
  return options;
}

TEST_P(BrainStateOfSeed, IsTheSameBrainAfterwards) {
  const VehicleOptions options = OptionsOfSeed(GetParam());
  Fate fate(GetParam());
  Vehicle brain(options, 42);
  std::uint32_t tick = 0;
  while (tick < 3 * GetParam()) fate.Lead(&brain, ++tick);
  const std::string bytes = BytesOf(brain.State());
  EXPECT_EQ(brain.State().sensed.grid.IsActive(), options.sonar_noise > 0);
  const auto state = StateFrom(bytes, options);
  ASSERT_NE(state, nullptr);
  ASSERT_EQ(BytesOf(*state), bytes);
  Vehicle other(options, 99);
  other.Restore(*state);
  ASSERT_EQ(other.Hash(), brain.Hash());
  Fate same = fate;
  for (const std::uint32_t end = tick + 60; tick < end;) {
    fate.Lead(&brain, ++tick);
    same.Lead(&other, tick);
    ASSERT_EQ(other.Hash(), brain.Hash());
    ASSERT_EQ(BytesOf(other.State()), BytesOf(brain.State()));
    ASSERT_EQ(same.LastOutputs().command.target, fate.LastOutputs().command.target);
    ASSERT_EQ(same.LastOutputs().command.decision, fate.LastOutputs().command.decision);
  }
}

TEST(BrainState, KeepsWhatItHeardInAFewBytes) {
  BrainBench bench(OptionsOfSeed(1));
  bench.Step(ClearScan(0));
  const std::size_t before = BytesOf(bench.Brain().State()).size();
  RangeScan scan = ClearScan(0);
  SetEcho(&scan, 3, 0.5);
  for (int i = 0; i < 3; ++i) bench.Step(scan);
  const std::string bytes = BytesOf(bench.Brain().State());
  EXPECT_GT(bytes.size(), before);
  EXPECT_LT(bytes.size(), before + 100);
  const auto state = StateFrom(bytes, OptionsOfSeed(1));
  ASSERT_NE(state, nullptr);
  int held = 0;
  state->sensed.grid.Held([&](Vec2) { ++held; });
  EXPECT_GT(held, 0);
}

// A brain restored from altered bytes must still run.
TEST_P(BrainStateOfSeed, BelievesNothing) {
  const VehicleOptions options = OptionsOfSeed(GetParam());
  Fate fate(7);
  Vehicle brain(options, 42);
  for (std::uint32_t tick = 1; tick <= 40; ++tick) fate.Lead(&brain, tick);
  const std::string whole = BytesOf(brain.State());
  Random random(GetParam());
  const auto drawn = [&random](std::size_t below) { return random.Next() % below; };
  std::size_t taken = 0;
  for (int i = 0; i < 300; ++i) {
    std::string bytes = whole;
    for (std::uint64_t flips = drawn(3) + 1; flips > 0; --flips) {
      bytes[drawn(bytes.size())] = static_cast<char>(random.Next());
    }
    if (drawn(10) == 0) bytes.resize(drawn(bytes.size()));
    const auto state = StateFrom(bytes, options);
    if (state == nullptr) continue;
    ++taken;
    Vehicle other(options, 99);
    other.Restore(*state);
    Fate on = fate;
    for (std::uint32_t tick = 41; tick <= 45; ++tick) on.Lead(&other, tick);
  }
  EXPECT_GT(taken, 0U) << "nothing was tried";
  EXPECT_LT(taken, 300U) << "nothing was refused";
}

TEST(BrainState, OfAnotherFormatIsRefused) {
  const Vehicle brain(DefaultOptions(), 42);
  std::string bytes = BytesOf(brain.State());
  ASSERT_NE(StateFrom(bytes, DefaultOptions()), nullptr);
  EXPECT_EQ(StateFrom(bytes + '\0', DefaultOptions()), nullptr);
  EXPECT_EQ(StateFrom("", DefaultOptions()), nullptr);
  ++bytes[0];
  EXPECT_EQ(StateFrom(bytes, DefaultOptions()), nullptr);
}

// The bytes of the previous layout end where the pose state starts.
TEST(BrainState, AnImageOfBeforeThePoseWasKeptIsTheSameBrainWithItsPoseBegunAnew) {
  Fate fate(5);
  Vehicle brain(DefaultOptions(), 42);
  for (std::uint32_t tick = 1; tick <= 40; ++tick) fate.Lead(&brain, tick);
  auto then = std::make_unique<VehicleState>(brain.State());
  then->sensed.doubt = {};
  std::string bytes = BytesOf(*then);
  constexpr std::size_t kPoseBytes =
      (2 + 6 + 3) * 8 + kPastPoses * (4 + 3 * 8) + (3 + 2) * 8 + 3 * 4 + 4 + 2 * 8 + 4 + 2 * 4 + 1;
  bytes.resize(bytes.size() - kPoseBytes);
  bytes[0] = 1;
  const auto state = StateFrom(bytes, DefaultOptions());
  ASSERT_NE(state, nullptr);
  Vehicle other(DefaultOptions(), 99);
  other.Restore(*state);
  EXPECT_EQ(other.Hash(), brain.Hash());
  EXPECT_TRUE(AreBytesOf(bytes, brain.State()));
  EXPECT_TRUE(AreBytesOf(BytesOf(brain.State()), brain.State()));
  fate.Lead(&brain, 41);
  EXPECT_FALSE(AreBytesOf(bytes, brain.State()));
}

// Indices that a brain looks something up by.
TEST(BrainState, AWaypointThatTheRouteDoesNotHaveIsRefused) {
  Vehicle brain(DefaultOptions(), 42);
  auto state = std::make_unique<VehicleState>(brain.State());
  state->route.waypoint = 3;
  EXPECT_EQ(StateFrom(BytesOf(*state), DefaultOptions()), nullptr);
  state->route.waypoint = 0;
  state->last.decision.sensor = kSensorCount;
  EXPECT_EQ(StateFrom(BytesOf(*state), DefaultOptions()), nullptr);
  state->last.decision.sensor = -1;
  state->progress.nearest_m = std::numeric_limits<double>::infinity();
  EXPECT_EQ(StateFrom(BytesOf(*state), DefaultOptions()), nullptr);
  state->progress.nearest_m = 5;
  EXPECT_NE(StateFrom(BytesOf(*state), DefaultOptions()), nullptr);
}

// Ranges that no ultrasonic sensor can report, and cells with more confidence than a grid gives.
TEST(BrainState, WhatNoScanCanHaveBroughtIsRefused) {
  const VehicleOptions options = OptionsOfSeed(1);
  BrainBench bench(options);
  RangeScan scan = ClearScan(0);
  SetEcho(&scan, 3, 0.625);
  for (int i = 0; i < 3; ++i) bench.Step(scan);
  const std::string sound = BytesOf(bench.Brain().State());
  ASSERT_NE(StateFrom(sound, options), nullptr);
  const auto replaced = [&sound](double from, double to) {
    std::string bytes = sound;
    const std::string of(reinterpret_cast<const char*>(&from), sizeof from);
    const std::size_t at = bytes.find(of);
    EXPECT_NE(at, std::string::npos);
    return bytes.replace(at, sizeof to, reinterpret_cast<const char*>(&to), sizeof to);
  };
  EXPECT_NE(StateFrom(replaced(0.625, 0.75), options), nullptr);
  for (const double range_m : {-0.1, 7.0, -1e10}) {
    EXPECT_EQ(StateFrom(replaced(0.625, range_m), options), nullptr) << range_m;
  }
  std::string surer = sound;
  ASSERT_EQ(surer.back(), static_cast<char>(ObstacleGrid::kSurest)) << "the last cell";
  surer.back() = static_cast<char>(ObstacleGrid::kSurestNear);
  EXPECT_NE(StateFrom(surer, options), nullptr);
  surer.back() = static_cast<char>(ObstacleGrid::kSurestNear + 1);
  EXPECT_EQ(StateFrom(surer, options), nullptr);
}

TEST(BrainState, KeepsAHeadingThatFixesDoubt) {
  Vehicle brain(DefaultOptions(), 42);
  auto state = std::make_unique<VehicleState>(brain.State());
  const std::size_t before = BytesOf(*state).size();
  state->motion.pose.disagreement = {{0.1, 0}, 0.5, 1};
  const std::string bytes = BytesOf(*state);
  EXPECT_GT(bytes.size(), before);
  const auto same = StateFrom(bytes, DefaultOptions());
  ASSERT_NE(same, nullptr);
  EXPECT_EQ(same->motion.pose.disagreement.off_rad, 0.5);
  EXPECT_TRUE(AreBytesOf(bytes, *state));
}

TEST(BrainState, KeepsWhichSensesSeemedWrong) {
  Vehicle brain(DefaultOptions(), 42);
  auto state = std::make_unique<VehicleState>(brain.State());
  const std::size_t before = BytesOf(*state).size();
  state->sensed.doubt = {ScanNews::kLeaps, 7};
  state->motion.pose.wrong_share = 0.25;
  const std::string bytes = BytesOf(*state);
  EXPECT_GT(bytes.size(), before);
  const auto same = StateFrom(bytes, DefaultOptions());
  ASSERT_NE(same, nullptr);
  EXPECT_EQ(same->sensed.doubt.ticks, 7U);
  EXPECT_EQ(same->sensed.doubt.shown_by, ScanNews::kLeaps);
  EXPECT_EQ(same->motion.pose.wrong_share, 0.25);
  EXPECT_TRUE(AreBytesOf(bytes, *state));
}

// Format 6 had the tick of a doubt behind it.
TEST(BrainState, OfAnImageThatSaysSinceWhenUltrasonicsWereDoubtedAllElseIsKept) {
  Vehicle brain(DefaultOptions(), 42);
  auto then = std::make_unique<VehicleState>(brain.State());
  then->motion.pose.wrong_share = 0.25;
  then->sensed.doubt = {ScanNews::kLeaps, 7};
  std::string bytes = BytesOf(*then);
  ASSERT_EQ(bytes[0], 7);
  bytes[0] = 6;
  EXPECT_EQ(StateFrom(bytes, DefaultOptions()), nullptr);
  bytes.append("\x05\0\0\0", 4);
  const auto state = StateFrom(bytes, DefaultOptions());
  ASSERT_NE(state, nullptr);
  EXPECT_EQ(BytesOf(*state), BytesOf(*then));
}

// Of a brain that doubted nothing then, as most: a recording of it replays.
TEST(BrainState, AnImageOfFormatSixWithoutADoubtIsTheSameBrain) {
  Vehicle brain(DefaultOptions(), 42);
  auto then = std::make_unique<VehicleState>(brain.State());
  then->motion.pose.wrong_share = 0.25;
  std::string bytes = BytesOf(*then);
  bytes[0] = 6;
  bytes.append(4, '\0');
  EXPECT_TRUE(AreBytesOf(bytes, *then));
}

// Its doubts stand where later formats have the own: by what and for how many ticks, a peer.
TEST(BrainState, OfAnImageThatDoubtedUltrasonicsByPeerAllElseIsKept) {
  Fate fate(5);
  Vehicle brain(DefaultOptions(), 42);
  for (std::uint32_t tick = 1; tick <= 40; ++tick) fate.Lead(&brain, tick);
  auto then = std::make_unique<VehicleState>(brain.State());
  const std::size_t peers = then->heard.peers.Peers().size();
  ASSERT_GT(peers, 0U);
  then->sensed.doubt = {};
  then->motion.pose.wrong_share = 0.25;
  std::string bytes = BytesOf(*then);
  constexpr std::size_t kDoubtBytes = sizeof(ScanNews) + 4;
  bytes.resize(bytes.size() - kDoubtBytes);
  const std::string leaps_for_7_ticks = {static_cast<char>(ScanNews::kLeaps), 7, 0, 0, 0};
  for (std::size_t peer = 0; peer < peers; ++peer) bytes += leaps_for_7_ticks;
  bytes[0] = 5;
  const auto state = StateFrom(bytes, DefaultOptions());
  ASSERT_NE(state, nullptr);
  EXPECT_EQ(BytesOf(*state), BytesOf(*then));
  EXPECT_EQ(StateFrom(bytes + leaps_for_7_ticks, DefaultOptions()), nullptr);
}

}  // namespace
}  // namespace giveway::test
