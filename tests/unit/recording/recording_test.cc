// What is recorded reads back to the bit, and what no vehicle could have written is refused.
#include "services/recording/recording.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "recording.pb.h"
#include "services/recording/recording_fields.h"
#include "tests/support/recorded_crossing.h"

namespace giveway {
namespace {

template <typename T>
constexpr bool kIsOptional = false;
template <typename T>
constexpr bool kIsOptional<std::optional<T>> = true;

// Gives every field a value of its own.
class Filler {
 public:
  void operator()(auto&... values) { (Fill(&values), ...); }

 private:
  template <typename T>
  void Fill(T* value) {
    ++count_;
    if constexpr (kIsOptional<T>) {
      Fill(&value->emplace());
    } else if constexpr (std::is_same_v<T, std::string>) {
      *value = std::string("\xff\0", 2) + std::to_string(count_);
    } else if constexpr (requires { value->begin(); }) {
      if constexpr (requires { value->resize(1); }) value->resize(3);
      for (auto& element : *value) Fill(&element);
    } else if constexpr (std::is_same_v<T, Nanoseconds>) {
      *value = Nanoseconds{-1'000'000'000'000 - count_};
    } else if constexpr (std::is_class_v<T>) {
      Visit(*this, *value);
    } else if constexpr (std::is_same_v<T, bool>) {
      *value = true;
    } else if constexpr (sizeof(T) == 1) {
      *value = static_cast<T>(1);
    } else if constexpr (std::is_same_v<T, double>) {
      *value = -1.0 / count_;
    } else if constexpr (std::is_same_v<T, int>) {
      *value = -count_;
    } else {
      *value = static_cast<T>(std::numeric_limits<std::uint32_t>::max() -
                              static_cast<std::uint32_t>(count_));
    }
  }
  int count_ = 0;
};

// Every field's bits, in order.
class Lister {
 public:
  void operator()(const auto&... values) { (List(values), ...); }
  const std::vector<std::uint64_t>& Bits() const { return bits_; }

 private:
  template <typename T>
  void List(const T& value) {
    if constexpr (kIsOptional<T>) {
      bits_.push_back(value.has_value());
      if (value) List(*value);
    } else if constexpr (requires { value.begin(); }) {
      bits_.push_back(value.size());
      for (const auto& element : value) List(element);
    } else if constexpr (std::is_same_v<T, Nanoseconds>) {
      bits_.push_back(static_cast<std::uint64_t>(value.count()));
    } else if constexpr (std::is_class_v<T>) {
      Visit(*this, value);
    } else if constexpr (std::is_same_v<T, double>) {
      bits_.push_back(std::bit_cast<std::uint64_t>(value));
    } else {
      bits_.push_back(static_cast<std::uint64_t>(value));
    }
  }
  std::vector<std::uint64_t> bits_;
};

template <typename T>
std::vector<std::uint64_t> BitsOf(const T& value) {
  Lister lister;
  lister(value);
  return lister.Bits();
}

template <typename T>
T Filled() {
  T value;
  Filler filler;
  filler(value);
  return value;
}

template <typename T>
void ExpectToSurvive(const T& value) {
  const std::optional<Record> back = RecordFrom(ToBytes(value));
  ASSERT_TRUE(back.has_value());
  ASSERT_TRUE(std::holds_alternative<T>(*back));
  EXPECT_EQ(BitsOf(std::get<T>(*back)), BitsOf(value));
}

TEST(Recording, EveryFieldSurvives) {
  ExpectToSurvive(Filled<RecordedStep>());
  ExpectToSurvive(Filled<RecordedLife>());
  ExpectToSurvive(Filled<RecordedReseat>());
  ExpectToSurvive(Filled<RecordedEnd>());
  ExpectToSurvive(Filled<RecordedContinuation>());
}

TEST(Recording, NothingAtAllSurvivesToo) {
  ExpectToSurvive(RecordedStep{});
  ExpectToSurvive(RecordedLife{});
}

TEST(Recording, AnOptionThatAnOlderOneDoesNotHaveIsWhatItWas) {
  schema::recording::Record message;
  ASSERT_TRUE(message.ParseFromString(ToBytes(Filled<RecordedLife>())));
  message.mutable_life()->mutable_options()->clear_silent_body_stays_ns();
  const std::optional<Record> back = RecordFrom(message.SerializeAsString());
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(std::get<RecordedLife>(*back).options.silent_body_stays, std::chrono::seconds(6));
}

TEST(Recording, EveryKindOfQosEventSurvives) {
  RecordedStep step;
  for (int i = 0; Name(static_cast<QosEventKind>(i)) != "unknown"; ++i) {
    step.events.push_back({.kind = static_cast<QosEventKind>(i)});
  }
  ExpectToSurvive(step);
}

TEST(Recording, EveryBitOfANumberSurvives) {
  RecordedStep step;
  step.scan.emplace().wheels = {-0.0, std::numeric_limits<double>::denorm_min()};
  step.scan->readings[0].range_m = std::bit_cast<double>(0x7ff8dead0000beefULL);
  step.scan->readings[1].range_m = -std::numeric_limits<double>::infinity();
  ExpectToSurvive(step);
}

TEST(Recording, AHeldStepGivesTheSameInputs) {
  const RadarScan radar{.vehicle = VehicleId{1}, .tick = Tick{9}, .count = 2};
  const std::vector<SignalState> signals(2);
  const std::vector<ReceivedBeacon> beacons(3);
  const Inputs inputs{.now = Nanoseconds{5},
                      .beacons = beacons,
                      .radar = &radar,
                      .signals = signals,
                      .pose_fix = PoseFix{.sigma_heading_rad = 3},
                      .leaving = true};
  RecordedStep step;
  step.Hold(inputs, {}, 7);
  const Inputs same = step.AsInputs();
  EXPECT_EQ(same.now, inputs.now);
  EXPECT_EQ(same.beacons.size(), 3U);
  EXPECT_NE(same.beacons.data(), beacons.data());
  ASSERT_NE(same.radar, nullptr);
  EXPECT_EQ(same.radar->count, 2U);
  EXPECT_EQ(same.lidar, nullptr);
  EXPECT_EQ(same.signals.size(), 2U);
  EXPECT_EQ(same.pose_fix->sigma_heading_rad, 3);
  EXPECT_TRUE(same.leaving);
  step.Hold({}, {}, 8);  // the slot is used again
  EXPECT_EQ(step.AsInputs().radar, nullptr);
  EXPECT_TRUE(step.AsInputs().beacons.empty());
  EXPECT_FALSE(step.AsInputs().pose_fix.has_value());
}

// Each value in place of a good one.
std::optional<Record> Spoilt(auto&& spoil) {
  RecordedStep step = Filled<RecordedStep>();
  spoil(&step);
  return RecordFrom(ToBytes(step));
}

TEST(Recording, WhatNoVehicleWritesIsRefused) {
  EXPECT_TRUE(Spoilt([](RecordedStep*) {}));
  EXPECT_FALSE(
      Spoilt([](RecordedStep* step) { step->outputs.beacon.rule = static_cast<Rule>(99); }));
  EXPECT_FALSE(
      Spoilt([](RecordedStep* step) { step->scan->readings[3].kind = static_cast<Echo>(3); }));
  EXPECT_FALSE(Spoilt([](RecordedStep* step) { step->now = Nanoseconds::max(); }));
  EXPECT_FALSE(Spoilt([](RecordedStep* step) { step->beacons[0].received = Nanoseconds::min(); }));
  EXPECT_FALSE(RecordFrom(""));
  EXPECT_FALSE(RecordFrom("no protobuf"));
  EXPECT_FALSE(RecordFrom(std::string("\x12\x02\x12\x00", 4)));  // a scan without its readings
}

TEST(Recording, EveryRuleAndModeHasItsNameInTheSchema) {
  Outputs one;
  one.command.decision.rule = Rule::kCruise;
  Outputs other = one;
  for (int i = 1; Name(static_cast<Rule>(i)) != "unknown"; ++i) {
    other.command.decision.rule = static_cast<Rule>(i);
    const auto difference = FirstDifference(one, other);
    ASSERT_TRUE(difference.has_value()) << i;
    EXPECT_EQ(difference->recorded, Name(one.command.decision.rule));
    EXPECT_EQ(difference->replayed, Name(other.command.decision.rule));
    one = other;
  }
  for (int i = 0; Name(static_cast<Mode>(i)) != "unknown"; ++i) {
    other.command.decision.mode = static_cast<Mode>(i);
    if (const auto difference = FirstDifference(one, other)) {
      EXPECT_EQ(difference->replayed, Name(other.command.decision.mode));
    }
  }
}

TEST(RecordingDifference, NamesTheFirstFieldWhoseBitsDiffer) {
  Outputs one;
  Outputs other;
  EXPECT_FALSE(FirstDifference(one, other));
  other.command.matched_peers = 5;  // the loop's
  EXPECT_FALSE(FirstDifference(one, other));
  const auto expect = [&](const char* field, const char* was, const char* is) {
    const auto difference = FirstDifference(one, other);
    ASSERT_TRUE(difference.has_value()) << field;
    EXPECT_EQ(difference->field, field);
    EXPECT_EQ(difference->recorded, was);
    EXPECT_EQ(difference->replayed, is);
  };
  other.decision_changed = true;
  expect("decision_changed", "false", "true");
  other.beacon.order.speed_bucket = 8;
  expect("beacon.order.speed_bucket", "0", "8");
  other.beacon.blocked_by = VehicleId{3};
  expect("beacon.blocked_by", "0", "3");
  other.beacon.gives_way_to = VehicleId{4};
  expect("beacon.gives_way_to", "0", "4");
  other.beacon.covariance.hh_rad2 = 0.5;
  expect("beacon.covariance.hh_rad2", "0", "0.5");
  other.command.decision.sensor = 4;
  expect("command.decision.sensor", "-1", "4");
  other.command.target.right_rad_s = -0.0;
  expect("command.target.right_rad_s", "0", "-0");
  other.command.target.left_rad_s = 0.1 + 0.2;
  expect("command.target.left_rad_s", "0", "0.30000000000000004");
}

TEST(RecordingOptions, OnlyAVehicleThatCouldDriveIsUsable) {
  const VehicleOptions good = test::DefaultOptions();
  EXPECT_EQ(WhyUnusable(good), "");
  const auto refused = [&](auto&& spoil) {
    VehicleOptions options = good;
    spoil(&options);
    return !WhyUnusable(options).empty();
  };
  EXPECT_TRUE(refused([](VehicleOptions* o) { o->id = kNoVehicle; }));
  EXPECT_TRUE(refused([](VehicleOptions* o) { o->tick_period = Nanoseconds{0}; }));
  EXPECT_TRUE(refused([](VehicleOptions* o) { o->tick_period = Nanoseconds{-50'000'000}; }));
  EXPECT_TRUE(refused([](VehicleOptions* o) { o->route.count = kMaxWaypoints + 1; }));
  EXPECT_TRUE(refused([](VehicleOptions* o) { o->profile.drive.wheel_radius_m = 0; }));
  EXPECT_TRUE(refused([](VehicleOptions* o) { o->profile.deceleration_m_s2 = -1; }));
  EXPECT_TRUE(refused([](VehicleOptions* o) { o->cruise_m_s = 1e5; }));
  EXPECT_TRUE(refused([](VehicleOptions* o) {
    o->profile.sonar[7].bearing_rad = std::numeric_limits<double>::quiet_NaN();
  }));
  EXPECT_TRUE(refused([](VehicleOptions* o) { o->one_lanes = {{{0, 0}, {0, 0}, 1}}; }));
  EXPECT_TRUE(refused([](VehicleOptions* o) { o->one_lanes = {{{0, 0}, {1, 0}, -1}}; }));
  EXPECT_TRUE(refused([](VehicleOptions* o) {
    o->one_lanes.assign(kMaxOneLanes + 1, {{0, 0}, {1, 0}, 1});
  }));
  EXPECT_TRUE(refused([](VehicleOptions* o) {
    o->route.waypoints_world[15].y = std::numeric_limits<double>::infinity();
  }));
}

}  // namespace
}  // namespace giveway
