#include "services/health/health.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include "services/health/health_board.h"
#include "services/health/health_metrics.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr SteadyTime kNow = seconds(100);

// Vehicle 2 of 2, in a started run, with ranges a moment old.
VehicleHealth Driving() {
  VehicleHealth vehicle;
  vehicle.loop = {.stage = HealthStage::kUnderWay, .turned = kNow - milliseconds(50), .turns = 7};
  vehicle.status.vehicle = VehicleId{2};
  vehicle.run_state = RunState::kRunning;
  vehicle.fleet_size = 2;
  vehicle.matched_peers = 1;
  vehicle.placements = 1;
  vehicle.scanned = kNow - milliseconds(50);
  vehicle.ranges_age_limit = milliseconds(150);
  return vehicle;
}

TEST(Health, AVehicleThatDrivesIsLiveAndReady) {
  EXPECT_THAT(NotLive(Driving().loop, kNow), IsEmpty());
  EXPECT_THAT(NotReady(Driving(), kNow), IsEmpty());
}

TEST(Health, ALoopIsLiveUpToTheLimitAndNotBeyond) {
  VehicleHealth vehicle = Driving();
  vehicle.loop.turned = kNow - kLoopSilenceLimit;
  EXPECT_THAT(NotLive(vehicle.loop, kNow), IsEmpty());
  vehicle.loop.turned -= milliseconds(200);
  EXPECT_THAT(NotLive(vehicle.loop, kNow),
              ElementsAre("the control loop has been silent for 1.2 s, the limit is 1 s"));
  EXPECT_THAT(NotReady(vehicle, kNow), ElementsAre(HasSubstr("silent for 1.2 s")));
}

TEST(Health, AStartMayTakeLongerThanATurn) {
  const LoopHealth loop{.stage = HealthStage::kStarting, .turned = kNow - seconds(9), .turns = 1};
  EXPECT_THAT(NotLive(loop, kNow), IsEmpty());
  EXPECT_THAT(NotLive(loop, kNow + seconds(2)), ElementsAre(HasSubstr("the limit is 10 s")));
}

TEST(Health, WhoHasNoPlaceSaysWhatTheWorldSaidLast) {
  VehicleHealth vehicle = Driving();
  vehicle.loop.stage = HealthStage::kStarting;
  EXPECT_THAT(NotReady(vehicle, kNow), ElementsAre(StartsWith("starting")));
  vehicle.waits_for = ShortText("no address of the discovery server a");
  EXPECT_THAT(NotReady(vehicle, kNow),
              ElementsAre("starting: no address of the discovery server a"));
  vehicle.loop.stage = HealthStage::kJoining;
  vehicle.waits_for = {};
  EXPECT_THAT(NotReady(vehicle, kNow), ElementsAre(HasSubstr("no answer from a world yet")));
  vehicle.waits_for = ShortText("the world lets it wait: id 2 is taken");
  EXPECT_THAT(NotReady(vehicle, kNow),
              ElementsAre("not joined: the world lets it wait: id 2 is taken"));
  vehicle.loop.stage = HealthStage::kLeaving;
  EXPECT_THAT(NotReady(vehicle, kNow), ElementsAre(StartsWith("leaving")));
}

TEST(Health, OldRangesAreAReasonAndSoAreNone) {
  VehicleHealth vehicle = Driving();
  vehicle.scanned = kNow - vehicle.ranges_age_limit;
  EXPECT_THAT(NotReady(vehicle, kNow), IsEmpty());
  vehicle.scanned = kNow - milliseconds(400);
  EXPECT_THAT(NotReady(vehicle, kNow),
              ElementsAre(AllOf(HasSubstr("0.40 s old"), HasSubstr("0.15 s"))));
  vehicle.scanned = SteadyTime{0};
  EXPECT_THAT(NotReady(vehicle, kNow), ElementsAre(HasSubstr("no ranges have come")));
}

TEST(Health, PeersAreAwaitedOnlyBeforeTheRunBegins) {
  VehicleHealth vehicle = Driving();
  vehicle.matched_peers = 0;
  EXPECT_THAT(NotReady(vehicle, kNow), IsEmpty());
  vehicle.run_state = RunState::kWaiting;
  EXPECT_THAT(NotReady(vehicle, kNow), ElementsAre("matched with 0 of 1 peers"));
  vehicle.matched_peers = 1;
  EXPECT_THAT(NotReady(vehicle, kNow), IsEmpty());
  vehicle.matched_peers = 0;
  vehicle.fleet_size = 0;
  EXPECT_THAT(NotReady(vehicle, kNow), IsEmpty());
}

TEST(Health, AWorldIsReadyAsSoonAsItTurnsAndUntilItsRunEnds) {
  WorldHealth world;
  world.loop = {.stage = HealthStage::kStarting, .turned = kNow, .turns = 1};
  EXPECT_THAT(NotReady(world, kNow), ElementsAre(StartsWith("starting")));
  world.loop.stage = HealthStage::kUnderWay;
  EXPECT_THAT(NotReady(world, kNow), IsEmpty());
  world.run_state = RunState::kEnded;
  EXPECT_THAT(NotReady(world, kNow), ElementsAre("the run has ended"));
}

TEST(Health, AWorldThatNoDiscoveryServerAnswersIsNotReadyAndSaysSo) {
  WorldHealth world;
  world.waits_for = ShortText("no discovery server answers");
  for (const HealthStage stage : {HealthStage::kStarting, HealthStage::kUnderWay}) {
    world.loop = {.stage = stage, .turned = kNow, .turns = 1};
    EXPECT_THAT(NotReady(world, kNow), ElementsAre("no discovery server answers"));
  }
}

TEST(Health, AReasonIsALineAndAJsonString) {
  EXPECT_EQ(AsText("ready", {}), "ready\n");
  EXPECT_EQ(AsText("ready", {"a", "b"}), "not ready: a\nnot ready: b\n");
  EXPECT_EQ(AsJson("live", {}), "{\"live\":true,\"reasons\":[]}\n");
  EXPECT_EQ(AsJson("ready", {"say \"a\"", "b"}),
            "{\"ready\":false,\"reasons\":[\"say \\\"a\\\"\",\"b\"]}\n");
}

TEST(Health, AShortTextCutsOffWhatDoesNotFit) {
  EXPECT_EQ(ShortText("").View(), "");
  EXPECT_EQ(ShortText("because").View(), "because");
  EXPECT_EQ(ShortText(std::string(1000, 'x')).View(), std::string(191, 'x'));
}

TEST(Health, MetricsHaveNamesUnitsAndHelp) {
  VehicleHealth vehicle = Driving();
  vehicle.status.decision.mode = Mode::kCooperative;
  vehicle.status.forward_m_s = 0.25;
  vehicle.status.step_p99_us = 250;
  vehicle.status.loop_max_ms = 1.5;
  vehicle.status.beacons.lost = 3;
  vehicle.status.timing.figures[static_cast<std::size_t>(DriveFigure::kReactionDistance)] = {
      .count = 4, .sum = 100'000, .p50 = 20'000, .p99 = 40'000, .max = 50'000};
  vehicle.status.timing.narrowest = ReactionMargin{Tick{9}, 0.25, 0.5};
  vehicle.status.timing.budget_spent = 2;
  vehicle.status.beacons.rejected_crc = 4;
  vehicle.status.refused.implausible = 5;
  vehicle.status.decision.rule = Rule::kLost;
  vehicle.pose_sigma_m = 0.5;
  vehicle.fixes_used = 9;
  vehicle.fixes_refused = 2;
  const std::string text = MetricsText(
      vehicle, {.started_s = 1000, .cpu_s = 0.5, .resident_bytes = 4096, .heap_bytes = 2048}, kNow);
  EXPECT_THAT(text,
              StartsWith("# HELP giveway_vehicle_info Always 1; the labels say what runs.\n"
                         "# TYPE giveway_vehicle_info gauge\n"
                         "giveway_vehicle_info{vehicle=\"2\",version=\"" GIVEWAY_VERSION "\"} 1\n"
                         "# HELP giveway_vehicle_ready 1 if /readyz says so.\n"
                         "# TYPE giveway_vehicle_ready gauge\n"
                         "giveway_vehicle_ready 1\n"
                         "# HELP giveway_vehicle_loop_turns_total Iterations of the control loop.\n"
                         "# TYPE giveway_vehicle_loop_turns_total counter\n"
                         "giveway_vehicle_loop_turns_total 7\n"));
  for (const char* line : {"\ngiveway_vehicle_mode{mode=\"cooperative\"} 1\n",
                           "_mode{mode=\"halt\"} 0\n",
                           "\ngiveway_vehicle_speed_meters_per_second 0.25\n",
                           "\ngiveway_vehicle_step_p99_seconds 0.00025\n",
                           "\ngiveway_vehicle_loop_max_seconds 0.0015\n",
                           "\ngiveway_vehicle_beacons_lost_total 3\n",
                           "\ngiveway_vehicle_beacons_rejected_total{reason=\"crc\"} 4\n",
                           "\ngiveway_vehicle_samples_refused_total{reason=\"implausible\"} 5\n",
                           "\ngiveway_vehicle_lost 1\n",
                           "\ngiveway_vehicle_pose_sigma_meters 0.5\n",
                           "\ngiveway_vehicle_pose_fixes_used_total 9\n",
                           "\ngiveway_vehicle_pose_fixes_refused_total 2\n",
                           "\n# TYPE giveway_vehicle_reaction_meters summary\n",
                           "\ngiveway_vehicle_reaction_meters_count 4\n",
                           "\ngiveway_vehicle_reaction_meters_sum 0.1\n",
                           "\ngiveway_vehicle_reaction_meters{quantile=\"0.5\"} 0.02\n",
                           "\ngiveway_vehicle_reaction_meters{quantile=\"0.99\"} 0.04\n",
                           "\ngiveway_vehicle_reaction_meters{quantile=\"1\"} 0.05\n",
                           "\ngiveway_vehicle_narrowest_margin_ratio 0.5\n",
                           "\ngiveway_vehicle_budget_spent_total 2\n",
                           "\nprocess_start_time_seconds 1000\n",
                           "\nprocess_cpu_seconds_total 0.5\n",
                           "\nprocess_resident_memory_bytes 4096\n",
                           "\nprocess_heap_bytes 2048\n"}) {
    EXPECT_THAT(text, HasSubstr(line));
  }
}

// A value that does not exist is left out, not reported as 0.
TEST(Health, ThereIsNoEchoAndNoAgeBeforeTheFirst) {
  VehicleHealth vehicle = Driving();
  vehicle.scanned = SteadyTime{0};
  const std::string none = MetricsText(vehicle, {}, kNow);
  EXPECT_EQ(none.find("nearest_echo"), std::string::npos);
  EXPECT_EQ(none.find("ranges_age"), std::string::npos);
  EXPECT_EQ(none.find("process_heap_bytes"), std::string::npos);
  EXPECT_THAT(none, HasSubstr("\ngiveway_vehicle_ready 0\n"));
  vehicle.scanned = kNow - milliseconds(125);
  vehicle.status.nearest_echo_m = 1.5;
  const std::string some = MetricsText(vehicle, {}, kNow);
  EXPECT_THAT(some, HasSubstr("\ngiveway_vehicle_nearest_echo_meters 1.5\n"));
  EXPECT_THAT(some, HasSubstr("\ngiveway_vehicle_ranges_age_seconds 0.125\n"));
}

// Scrapers refuse a text in which a counter's name is wrong, or a family occurs twice.
TEST(Health, EveryCounterEndsInTotalAndEveryFamilyComesOnce) {
  const std::string all = MetricsText(Driving(), {}, kNow) + MetricsText(WorldHealth{}, {}, kNow);
  std::vector<std::string> names;
  std::size_t at = 0;
  while ((at = all.find("# TYPE ", at)) != std::string::npos) {
    at += 7;
    const std::string line = all.substr(at, all.find('\n', at) - at);
    const std::string name = line.substr(0, line.find(' '));
    if (!name.starts_with("process_")) names.push_back(name);
    EXPECT_EQ(line.ends_with(" counter"), name.ends_with("_total")) << line;
  }
  EXPECT_GT(names.size(), 30U);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

struct Many {
  std::array<std::uint64_t, 100> numbers{};
};

// A torn read of the board shows two numbers of different writes.
TEST(HealthBoard, WhatIsReadIsOneWriteAndNeverOlderThanTheLastRead) {
  HealthBoard<Many> board;
  std::atomic<bool> over{false};
  std::thread writer([&] {
    Many many;
    for (std::uint64_t i = 1; !over; ++i) {
      many.numbers.fill(i);
      board.Publish(many);
    }
  });
  std::uint64_t last = 0;
  std::uint64_t torn = 0;
  std::uint64_t back = 0;
  while (last < 20000) {
    const Many seen = board.Read();
    for (const std::uint64_t number : seen.numbers) torn += number == seen.numbers[0] ? 0 : 1;
    back += seen.numbers[0] < last ? 1 : 0;
    last = seen.numbers[0];
  }
  over = true;
  writer.join();
  EXPECT_EQ(torn, 0U);
  EXPECT_EQ(back, 0U);
}

}  // namespace
}  // namespace giveway
