// What a recording shows of QoS: a brain on the bench that receives beacons, misses them, and gets
// QoS events.
#include "services/fleetctl/tune/tune_reading.h"

#include <gtest/gtest.h>

#include <functional>
#include <sstream>

#include "tests/support/recorded_crossing.h"

namespace giveway::fleetctl {
namespace {

constexpr Nanoseconds kTick{50'000'000};
constexpr std::uint32_t kSteps = 40;

constexpr SteadyTime AtTick(std::uint32_t tick) { return tick * kTick; }

// A vehicle that receives vehicle 2 in every tick except where `silent` is true, and gets the given
// QoS events; it skips the step of a tick where `stands` is true.
std::string Recording(const std::function<bool(std::uint32_t)>& silent,
                      const std::function<std::vector<QosEvent>(std::uint32_t)>& events_at = {},
                      const std::function<bool(std::uint32_t)>& stands = {}) {
  const VehicleOptions options = test::OptionsWithoutUltrasonics();
  Vehicle brain(options, 42);
  std::vector<Record> records{RecordedLife{42, options, "test"}};
  for (std::uint32_t tick = 1; tick <= kSteps; ++tick) {
    if (stands && stands(tick)) continue;
    std::vector<ReceivedBeacon> heard;
    // Sent in the tick before, as beacons are.
    if (tick > 1 && !silent(tick)) {
      heard.push_back(test::Received(test::BeaconOf(2, tick - 1, {{0, 3}, 0}), AtTick(tick)));
    }
    const std::vector<QosEvent> events = events_at ? events_at(tick) : std::vector<QosEvent>{};
    const Inputs inputs{
        .now = AtTick(tick), .scan = test::ClearScan(tick), .beacons = heard, .events = events};
    const Outputs outputs = brain.Step(inputs);
    std::get<RecordedStep>(records.emplace_back(RecordedStep{}))
        .Hold(inputs, outputs, brain.Hash());
  }
  return test::FileOf(records);
}

VehicleReading Read(const std::string& bytes, const AliveWindow& window) {
  std::istringstream stream(bytes);
  return ReadVehicle(&stream, window);
}

const AliveWindow kAll{AtTick(2), AtTick(kSteps)};
bool Never(std::uint32_t) { return false; }

TEST(TuneReading, WhoIsAlwaysHeardIsNoAlarm) {
  const VehicleReading reading = Read(Recording(Never), kAll);
  EXPECT_EQ(reading.trouble, "");
  EXPECT_EQ(reading.vehicle, VehicleId{1});
  EXPECT_EQ(reading.alarms.Total(), 0U);
  EXPECT_EQ(reading.last_step, AtTick(kSteps));
  EXPECT_EQ(reading.longest_pause, kTick);
  EXPECT_FALSE(reading.peers.at(VehicleId{2}).has_value());
  ASSERT_EQ(reading.ages.size(), 2U);  // one tick, each time
  EXPECT_EQ(reading.ages[1], kSteps - 1);
}

TEST(TuneReading, APauseCountsFromTheWindowToTheEnd) {
  const auto stands = [](std::uint32_t tick) { return tick == 5 || tick == 30 || tick == 31; };
  const std::string bytes = Recording(Never, {}, stands);
  EXPECT_EQ(Read(bytes, {AtTick(2), AtTick(20)}).longest_pause, 3 * kTick);
  EXPECT_EQ(Read(bytes, {AtTick(33), AtTick(35)}).longest_pause, kTick);
}

TEST(TuneReading, ASilenceBeyondTheAgeLimitIsOneAlarm) {
  const auto gap = [](std::uint32_t tick) { return tick >= 10 && tick < 18; };
  const VehicleReading reading = Read(Recording(gap), kAll);
  EXPECT_EQ(reading.alarms.beacon_age, 1U);
  EXPECT_EQ(reading.alarms.Total(), 1U);
  EXPECT_FALSE(reading.peers.at(VehicleId{2}).has_value());  // believed again
  EXPECT_EQ(reading.ages.size(), 10U);
}

TEST(TuneReading, AMissThatWasToldIsAnAlarmOfTheDeadline) {
  const auto events_at = [](std::uint32_t tick) {
    return tick == 20 ? std::vector<QosEvent>{{QosEventKind::kDeadlineMissed, VehicleId{2}}}
                      : std::vector<QosEvent>{};
  };
  const VehicleReading reading = Read(Recording(Never, events_at), kAll);
  EXPECT_EQ(reading.alarms.deadline, 1U);
  EXPECT_EQ(reading.reported_deadline, 1U);
  EXPECT_EQ(reading.alarms.Total(), 1U);
}

TEST(TuneReading, WhatIsOutsideTheWindowIsNoFalseAlarm) {
  const auto gap = [](std::uint32_t tick) { return tick >= 10 && tick < 18; };
  EXPECT_EQ(Read(Recording(gap), {AtTick(19), AtTick(kSteps)}).alarms.Total(), 0U);
}

TEST(TuneReading, ADeadPeerIsSilencedForGood) {
  const auto dies = [](std::uint32_t tick) { return tick > 30; };
  const VehicleReading reading = Read(Recording(dies), {AtTick(2), AtTick(30)});
  EXPECT_EQ(reading.alarms.Total(), 0U);
  const auto& silenced = reading.peers.at(VehicleId{2});
  ASSERT_TRUE(silenced);
  EXPECT_EQ(silenced->cause, AlarmCause::kBeaconAge);
  EXPECT_EQ(silenced->at, AtTick(35));  // the beacon of tick 30 is 250 ms old
}

TEST(TuneReading, NonsenseIsTrouble) { EXPECT_NE(Read("no recording", kAll).trouble, ""); }

VehicleReading Watcher(std::uint32_t id, std::optional<Silenced> of_victim) {
  VehicleReading reading;
  reading.vehicle = VehicleId{id};
  reading.peers[VehicleId{9}] = of_victim;
  return reading;
}

TEST(TuneReading, DetectionRunsFromTheKillAndFromTheLastBeacon) {
  VehicleReading target;
  target.vehicle = VehicleId{9};
  target.last_step = AtTick(20);
  const Killing kill{VehicleId{9}, AtTick(20) + std::chrono::milliseconds(30)};
  TrialEvidence evidence;
  FoldReadings({target, Watcher(1, Silenced{AtTick(24), AlarmCause::kDeadline}),
                Watcher(2, std::nullopt),                                  // never noticed
                Watcher(3, Silenced{AtTick(19), AlarmCause::kDeadline})},  // by a false alarm
               {kill}, kTick, &evidence);
  ASSERT_EQ(evidence.detections.size(), 1U);
  EXPECT_DOUBLE_EQ(evidence.detections[0].from_kill_ms, 170);
  EXPECT_DOUBLE_EQ(evidence.detections[0].from_last_beacon_ms, 200);
  EXPECT_EQ(evidence.undetected, 1U);
}

TEST(TuneReading, TheDeadNoticeNobody) {
  VehicleReading first = Watcher(1, std::nullopt);
  VehicleReading second;
  second.vehicle = VehicleId{9};
  TrialEvidence evidence;
  FoldReadings({first, second}, {{VehicleId{1}, AtTick(10)}, {VehicleId{9}, AtTick(20)}}, kTick,
               &evidence);
  EXPECT_EQ(evidence.undetected, 0U);
  EXPECT_TRUE(evidence.detections.empty());
}

}  // namespace
}  // namespace giveway::fleetctl
