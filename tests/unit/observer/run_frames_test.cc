#include "services/observer/capture/run_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "services/link/sample_codec.h"
#include "services/observer/capture/fleet_capture.h"
#include "services/observer/fleet/frame_json.h"

namespace giveway {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Beacon BeaconAt(double x) {
  Beacon beacon;
  beacon.vehicle = VehicleId{7};
  beacon.boot_epoch = 1;
  beacon.seq = 1;
  beacon.world_from_body.position_world = {x, 0};
  return beacon;
}

mcap::McapReader::Source SourceOf(const std::string& bytes) {
  return [rest = std::string_view(bytes)](char* to, std::size_t most) mutable {
    const std::size_t got = rest.copy(to, most);
    rest.remove_prefix(got);
    return got;
  };
}

std::size_t ColumnNamed(std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(kVehicleColumns, name) -
                                  kVehicleColumns.begin());
}

// The same sample at each of these times.
std::string RecordedAt(const std::vector<std::uint64_t>& times_ns, const std::string& topic,
                       const std::string& sample) {
  std::string bytes;
  FleetCapture capture(
      [&bytes](std::string_view more) {
        bytes += more;
        return true;
      },
      {});
  for (const std::uint64_t time_ns : times_ns) {
    capture.Write({.topic = RawTopicNamed(topic),
                   .source_ns = 1,
                   .reception_ns = time_ns,
                   .sequence = 1,
                   .bytes = sample});
  }
  capture.Close();
  return bytes;
}

constexpr std::uint64_t kSecond_ns = 1'000'000'000;

// Twenty a second.
void AddTimes(std::uint64_t from_s, std::uint64_t to_s, std::vector<std::uint64_t>* times_ns) {
  for (std::uint64_t at_ns = from_s * kSecond_ns; at_ns < to_s * kSecond_ns; at_ns += 50'000'000) {
    times_ns->push_back(at_ns);
  }
}

std::string Recorded(const std::string& topic, const std::string& sample, int count) {
  std::vector<std::uint64_t> times_ns;
  for (int n = 0; n < count; ++n) {
    times_ns.push_back(kSecond_ns + static_cast<std::uint64_t>(n) * 50'000'000);
  }
  return RecordedAt(times_ns, topic, sample);
}

TEST(RunFrames, ARecordedBeaconIsDecodedToWhatWasSent) {
  const std::string bytes = link::Encode(BeaconAt(1.5));
  link::Observed observed;
  ASSERT_EQ(link::DecodeInto("fleet/beacon", bytes, &observed), link::Decoded::kYes);
  EXPECT_TRUE(observed.beacons.front().crc_valid);
  EXPECT_DOUBLE_EQ(observed.beacons.front().beacon.world_from_body.position_world.x, 1.5);
}

TEST(RunFrames, DamagedAndForeignSamplesAreNone) {
  const std::string bytes = link::Encode(BeaconAt(1.5));
  link::Observed observed;
  EXPECT_EQ(link::DecodeInto("fleet/beacon", bytes.substr(0, 40), &observed),
            link::Decoded::kUnreadable);
  EXPECT_EQ(link::DecodeInto("fleet/beacon", "", &observed), link::Decoded::kUnreadable);
  EXPECT_EQ(link::DecodeInto("camera/raw", bytes, &observed), link::Decoded::kUnknownTopic);
}

TEST(RunFrames, ARecordingBecomesFramesTenASecond) {
  const std::string file = Recorded("fleet/beacon", link::Encode(BeaconAt(1.5)), 41);
  const RunRead run = ReadRun(SourceOf(file));
  EXPECT_EQ(run.result.fault, "");
  EXPECT_EQ(run.result.messages, 41U);
  EXPECT_GE(run.frames.Size(), 18U);
  EXPECT_LE(run.frames.Size(), 22U);
  EXPECT_THAT(run.frames.RunJson("{}"), HasSubstr("[7,1500,0,"));
}

// The last frame was a second after the last sample: there every vehicle was silent, and its beacon
// older than at any moment of the run.
TEST(RunFrames, TheLastMomentOfARecordingIsThatOfItsLastSample) {
  const std::string file = Recorded("fleet/beacon", link::Encode(BeaconAt(1.5)), 41);
  const auto run = nlohmann::json::parse(ReadRun(SourceOf(file)).frames.RunJson("{}"));
  const auto& last = run["frames"].back();
  EXPECT_EQ(last["at_ms"].get<int>(), 3000);
  const auto& row = last["vehicles"].at(0);
  EXPECT_LT(row.at(ColumnNamed("beacon_age")).get<int>(), 100);
  EXPECT_EQ(row.at(ColumnNamed("hearing")).get<int>(), static_cast<int>(Liveness::kHeard));
}

// After the clock was set back nothing was shown, and all samples waited in memory for it to come
// back to where it had been.
TEST(RunFrames, ARunGoesOnWhereTheRecordersClockWasSetBack) {
  std::vector<std::uint64_t> times_ns;
  AddTimes(100, 110, &times_ns);
  AddTimes(40, 50, &times_ns);
  const std::string file = RecordedAt(times_ns, "fleet/beacon", link::Encode(BeaconAt(1.5)));
  const RunRead run = ReadRun(SourceOf(file));
  EXPECT_NEAR(static_cast<double>(run.frames.Size()), 200, 5);
  const auto json = nlohmann::json::parse(run.frames.RunJson("{}"));
  EXPECT_NEAR(json["frames"].back()["at_ms"].get<double>(), 119'900, 100);
}

TEST(RunFrames, WhatARecorderThatStoodStillWritesTopicByTopicIsNoStepOfItsClock) {
  std::vector<std::uint64_t> times_ns;
  AddTimes(100, 110, &times_ns);
  AddTimes(104, 111, &times_ns);
  const std::string file = RecordedAt(times_ns, "fleet/beacon", link::Encode(BeaconAt(1.5)));
  const auto json = nlohmann::json::parse(ReadRun(SourceOf(file)).frames.RunJson("{}"));
  EXPECT_EQ(json["frames"].back()["at_ms"].get<int>(), 110'950);
}

// Of more than 512 events in one fold a view keeps the last: each that is there was folded in time.
TEST(RunFrames, ManyMessagesOfOneTimeDoNotWaitForTheNext) {
  std::string bytes;
  FleetCapture capture(
      [&bytes](std::string_view more) {
        bytes += more;
        return true;
      },
      {});
  for (std::uint32_t n = 1; n <= 2000; ++n) {
    WorldEvent event;
    event.epoch = WorldEpoch{1};
    event.seq = n;
    capture.Write({.topic = RawTopicNamed("world/event"),
                   .source_ns = kSecond_ns,
                   .reception_ns = kSecond_ns,
                   .sequence = n,
                   .bytes = link::Encode(event)});
  }
  capture.Close();
  const auto json = nlohmann::json::parse(ReadRun(SourceOf(bytes)).frames.RunJson("{}"));
  EXPECT_EQ(json["events"].size(), 2000U);
}

TEST(RunFrames, OfWhatCannotBeDecodedItSaysHowMuch) {
  const RunRead run = ReadRun(SourceOf(Recorded("fleet/beacon", "nonsense", 3)));
  EXPECT_EQ(run.unreadable, 3U);
  EXPECT_EQ(run.frames.Size(), 0U);
}

TEST(RunFrames, ALongRunKeepsABoundedNumber) {
  RunFrames frames;
  FleetView view;
  ReceivedBeacon received;
  received.crc_valid = received.name_valid = true;
  received.beacon = BeaconAt(0);
  view.Fold({.beacons = {received}}, SteadyTime{1});
  for (int tenth = 1; tenth <= 20'000; ++tenth) {
    frames.Note(view, SteadyTime{std::int64_t{100'000'000} * tenth});
  }
  EXPECT_LE(frames.Size(), RunFrames::kMostFrames + 1);
  EXPECT_GT(frames.Size(), RunFrames::kMostFrames / 4);
}

TEST(RunFrames, EveryEventOfALongRunIsKeptOnce) {
  RunFrames frames;
  FleetView view;
  WorldEvent event;
  event.epoch = WorldEpoch{1};
  for (std::uint32_t n = 1; n <= 2000; ++n) {
    event.seq = n;
    view.Fold({.events = {event}}, SteadyTime{std::int64_t{1'000'000} * n});
    frames.Note(view, SteadyTime{std::int64_t{1'000'000} * n});
  }
  const std::string json = frames.RunJson("{}");
  std::size_t count = 0;
  for (std::size_t at = 0; (at = json.find("\"seq\":", at)) != std::string::npos; ++at) ++count;
  EXPECT_EQ(count, 2000U);
  EXPECT_THAT(json, HasSubstr("[1,{"));
  EXPECT_THAT(json, HasSubstr("[2000,{"));
}

TEST(RunFrames, TimesAtTheEndOfTimeDoNotWrap) {
  const std::string bytes = RecordedAt({1, ~std::uint64_t{0}, ~std::uint64_t{0} / 2},
                                       "fleet/beacon", link::Encode(BeaconAt(1.5)));
  const RunRead run = ReadRun(SourceOf(bytes));
  EXPECT_EQ(run.result.messages, 3U);
  EXPECT_EQ(run.frames.Size(), 1U);
  const std::string json = run.frames.RunJson("{}");
  EXPECT_THAT(json, HasSubstr("\"at_ms\":4611686018427"));
}

TEST(FleetCapture, EveryChannelHasTheIdlAsItsSchema) {
  const std::string file = Recorded("world/truth", link::Encode(Truth{}), 1);
  std::string schema;
  std::string name;
  mcap::McapReader::Read(SourceOf(file),
                         [&](const mcap::Message&, const mcap::Channel&, const mcap::Schema& of) {
                           schema = of.data;
                           name = of.name;
                           return true;
                         });
  EXPECT_EQ(name, "giveway::wire::Truth");
  EXPECT_THAT(schema, HasSubstr("struct Beacon {"));
}

TEST(RunFrames, OfARunWithoutAnEndTheLastIsKept) {
  FleetView view;
  RunFrames frames(std::chrono::seconds(5));
  for (int tenth = 0; tenth < 600; ++tenth) {
    const SteadyTime now = SteadyTime{0} + std::chrono::milliseconds(100 * tenth);
    link::Observed observed;
    observed.beacons.push_back({.beacon = BeaconAt(tenth), .crc_valid = true, .name_valid = true});
    WorldEvent event;
    event.text = "event " + std::to_string(tenth);
    event.epoch = WorldEpoch{1};
    event.seq = static_cast<std::uint32_t>(tenth + 1);
    if (tenth % 100 == 0) observed.events.push_back(event);
    view.Fold(observed, now);
    frames.Note(view, now);
  }
  EXPECT_EQ(frames.Size(), 25U);
  const std::string json = frames.RunJson("{}");
  EXPECT_THAT(json, Not(HasSubstr("[7,548000,0,")));
  EXPECT_THAT(json, HasSubstr("[7,550000,0,"));
  EXPECT_THAT(json, HasSubstr("[7,598000,0,"));
  EXPECT_THAT(json, Not(HasSubstr("event 500")));
}

}  // namespace
}  // namespace giveway
