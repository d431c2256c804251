// A replay is bit for bit, and any difference is found at its step.
#include "services/fleetctl/replay/replayer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <sstream>

#include "services/fleetctl/output/decision_trace.h"
#include "services/snapshot/brain_state.h"
#include "tests/support/recorded_crossing.h"

namespace giveway::fleetctl {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kSteps = 60;

ReplayedFile ReplayOf(const std::vector<Record>& records) {
  std::istringstream stream(test::FileOf(records));
  return Replay(&stream);
}

class ReplayTest : public testing::Test {
 protected:
  RecordedStep& Step(std::uint32_t number) { return std::get<RecordedStep>(records_[number]); }
  std::vector<Record> records_ = test::RecordedCrossing(kSteps);
};

TEST_F(ReplayTest, ComesOutTheSame) {
  const ReplayedFile outcome = ReplayOf(records_);
  EXPECT_EQ(outcome.vehicle, VehicleId{1});
  EXPECT_EQ(outcome.steps, kSteps);
  EXPECT_TRUE(outcome.complete);
  EXPECT_FALSE(outcome.difference.has_value());
  EXPECT_EQ(outcome.finding, "");
}

TEST_F(ReplayTest, OneFlippedBitOfAReadingIsFound) {
  double& range_m = Step(20).scan->readings[3].range_m;
  range_m = std::bit_cast<double>(std::bit_cast<std::uint64_t>(range_m) ^ 1U);
  const ReplayedFile outcome = ReplayOf(records_);
  ASSERT_TRUE(outcome.difference.has_value());
  EXPECT_EQ(outcome.difference->step, 20U);
  EXPECT_EQ(outcome.difference->tick, Tick{20});
  EXPECT_EQ(outcome.steps, 19U);
}

TEST_F(ReplayTest, ADifferenceIsToldWithItsFieldAndBothValues) {
  Step(20).scan->wheels.left_rad_s += 1e-12;
  const ReplayedFile outcome = ReplayOf(records_);
  ASSERT_TRUE(outcome.difference.has_value());
  EXPECT_EQ(outcome.difference->field.field, "command.target.left_rad_s");
  const Outputs& recorded = Step(20).outputs;
  EXPECT_EQ(std::stod(outcome.difference->field.recorded), recorded.command.target.left_rad_s);
  EXPECT_NE(std::stod(outcome.difference->field.replayed), recorded.command.target.left_rad_s);
}

TEST_F(ReplayTest, AMissingBeaconIsFound) {
  Step(30).beacons.clear();
  EXPECT_TRUE(ReplayOf(records_).difference.has_value());
}

TEST_F(ReplayTest, AnotherHashIsFoundThoughTheOutputsAgree) {
  Step(7).hash ^= 1;
  const ReplayedFile outcome = ReplayOf(records_);
  ASSERT_TRUE(outcome.difference.has_value());
  EXPECT_EQ(outcome.difference->step, 7U);
  EXPECT_EQ(outcome.difference->field.field, "hash");
}

TEST_F(ReplayTest, OtherOptionsAreAnotherVehicle) {
  std::get<RecordedLife>(records_[0]).options.cruise_m_s = 0.5;
  EXPECT_TRUE(ReplayOf(records_).difference.has_value());
}

TEST_F(ReplayTest, GoesOnFromWhatTheVehicleTookOver) {
  RecordedLife life{
      42, test::DefaultOptions(), "test",
      Handover{.epoch = test::kEpoch, .tick = Tick{9}, .world_from_body = {{1, 2}, 0.5}}};
  Vehicle brain(life.options, life.boot_epoch);
  ASSERT_TRUE(brain.TakeOver(*life.handover));
  const Inputs inputs{.now = Nanoseconds{500'000'000}, .scan = test::ClearScan(10)};
  const Outputs said = brain.Step(inputs);
  RecordedStep step;
  step.Hold(inputs, said, brain.Hash());
  const ReplayedFile same = ReplayOf({life, step, RecordedEnd{1, 0}});
  EXPECT_EQ(same.steps, 1U);
  EXPECT_FALSE(same.difference.has_value());
  life.handover->covariance.xx_m2 = -1;
  EXPECT_THAT(ReplayOf({life, step, RecordedEnd{1, 0}}).finding, HasSubstr("takes over"));
  life.handover.reset();
  EXPECT_TRUE(ReplayOf({life, step, RecordedEnd{1, 0}}).difference.has_value());
}

TEST_F(ReplayTest, AnotherPlaceIsTakenFromTheStepOnAtWhichItWasGiven) {
  const VehicleOptions faster = [] {
    VehicleOptions options = test::DefaultOptions();
    options.cruise_m_s = 0.6;
    return options;
  }();
  records_.insert(records_.begin() + 11, RecordedReseat{faster});
  const ReplayedFile outcome = ReplayOf(records_);
  ASSERT_TRUE(outcome.difference.has_value());
  EXPECT_EQ(outcome.difference->step, 11U);
  EXPECT_EQ(outcome.difference->field.field, "beacon.cruise_m_s");
}

TEST_F(ReplayTest, ACutRecordingIsTheSameAsFarAsItGoes) {
  records_.pop_back();
  const ReplayedFile outcome = ReplayOf(records_);
  EXPECT_EQ(outcome.steps, kSteps);
  EXPECT_FALSE(outcome.complete);
  EXPECT_EQ(outcome.finding, "");
}

TEST_F(ReplayTest, ARecordingThatComparesNothingProvesNothing) {
  EXPECT_THAT(ReplayOf({records_[0]}).finding, HasSubstr("no step"));
  records_.erase(records_.begin() + kSteps);
  EXPECT_THAT(ReplayOf(records_).finding, HasSubstr("says it holds 60 steps"));
}

TEST_F(ReplayTest, WhoWatchesSeesEveryStep) {
  std::istringstream stream(test::FileOf(records_));
  std::uint32_t seen = 0;
  std::string trace;
  Replay(&stream, [&](const RecordedStep& step, const Vehicle& brain, const Outputs& said) {
    ++seen;
    EXPECT_EQ(step.hash, brain.Hash());
    AppendLine({.tick = brain.State().world.tick, .vehicle = said.command.vehicle}, said, &trace);
  });
  EXPECT_EQ(seen, kSteps);
  EXPECT_THAT(trace, HasSubstr("\n60\t0.00\t1\t"));
}

// The same recording as two parts of a ring.
class RingReplayTest : public ReplayTest {
 protected:
  static constexpr std::uint32_t kFirst = 25;
  RingReplayTest() {
    Vehicle brain(test::DefaultOptions(), 42);
    for (std::uint32_t number = 1; number <= kFirst; ++number) {
      brain.Step(Step(number).AsInputs());
    }
    first_.assign(records_.begin(), records_.begin() + kFirst + 1);
    first_.emplace_back(RecordedEnd{.steps = kFirst, .continues = true});
    second_ = {RecordedContinuation{42, VehicleId{1}, 2, kFirst},
               RecordedImage{test::DefaultOptions(), "test", BytesOf(brain.State()), brain.Hash()}};
    second_.insert(second_.end(), records_.begin() + kFirst + 1, records_.end() - 1);
    second_.emplace_back(RecordedEnd{.steps = kSteps - kFirst});
  }
  RecordedImage& Image() { return std::get<RecordedImage>(second_[1]); }
  std::vector<Record> first_;
  std::vector<Record> second_;
};

TEST_F(RingReplayTest, ComesOutTheSameFromItsImageOn) {
  const ReplayedFile outcome = ReplayOf(second_);
  EXPECT_EQ(outcome.finding, "");
  EXPECT_FALSE(outcome.difference.has_value());
  EXPECT_EQ(outcome.steps, kSteps - kFirst);
  EXPECT_TRUE(outcome.complete);
  EXPECT_EQ(outcome.part, 2U);
}

TEST_F(RingReplayTest, TheBrainThatWasLedUpToAnImageMustBeItsBrain) {
  Replayer replayer;
  const auto replay = [&replayer](const std::vector<Record>& part) {
    std::istringstream stream(test::FileOf(part));
    return replayer.Replay(&stream);
  };
  EXPECT_EQ(replay(first_).steps, kFirst);
  EXPECT_EQ(replay(second_).steps, kSteps - kFirst);
  EXPECT_EQ(replay(first_).steps, kFirst);
  Vehicle other(test::DefaultOptions(), 42);
  Image().state = BytesOf(other.State());
  EXPECT_EQ(replay(second_).difference->field.field, "state");
}

TEST_F(RingReplayTest, AFlippedBitBehindTheImageIsFound) {
  std::get<RecordedStep>(second_[4]).scan->readings[3].range_m += 1e-9;
  EXPECT_TRUE(ReplayOf(second_).difference.has_value());
}

TEST_F(RingReplayTest, AnImageThatIsNoBrainOrAnotherIsRefused) {
  const std::string state = Image().state;
  Image().hash ^= 1;
  EXPECT_THAT(ReplayOf(second_).finding, HasSubstr("differs from the recorded hash"));
  Image().state = "no brain";
  EXPECT_THAT(ReplayOf(second_).finding, HasSubstr("cannot restore"));
  Image().state = state;
  Image().options.id = VehicleId{7};
  EXPECT_THAT(ReplayOf(second_).finding, HasSubstr("another vehicle's"));
}

// Its process died right after starting another file.
TEST_F(RingReplayTest, AnImageWithoutAStepProvesSomethingBehindTheFileBeforeAlone) {
  second_.resize(2);
  EXPECT_THAT(ReplayOf(second_).finding, HasSubstr("no step"));
  Replayer replayer;
  std::istringstream first(test::FileOf(first_));
  std::istringstream second(test::FileOf(second_));
  replayer.Replay(&first);
  EXPECT_EQ(replayer.Replay(&second).finding, "");
}

TEST_F(RingReplayTest, AnImageStandsAtTheBeginningOfAPartAlone) {
  first_.insert(first_.begin() + 5, Image());
  EXPECT_THAT(ReplayOf(first_).finding, HasSubstr("amid a part"));
  std::swap(second_[1], second_[2]);
  EXPECT_THAT(ReplayOf(second_).finding, HasSubstr("name the parts before it"));
}

// The same recording as two parts.
class SplitReplayTest : public ReplayTest {
 protected:
  static constexpr std::uint32_t kFirst = 25;
  void SetUp() override {
    const auto middle = records_.begin() + 1 + kFirst;
    first_.assign(records_.begin(), middle);
    first_.push_back(RecordedEnd{.steps = kFirst, .continues = true});
    const auto& life = std::get<RecordedLife>(records_[0]);
    second_.push_back(RecordedContinuation{life.boot_epoch, life.options.id, 2, kFirst});
    second_.insert(second_.end(), middle, records_.end());
    second_.back() = RecordedEnd{.steps = kSteps - kFirst};
  }
  static ReplayedFile Next(const std::vector<Record>& part, Replayer* replayer) {
    std::istringstream stream(test::FileOf(part));
    return replayer->Replay(&stream);
  }
  std::vector<Record> first_;
  std::vector<Record> second_;
};

TEST_F(SplitReplayTest, PartsComeOutTheSameOneAfterTheOther) {
  Replayer replayer;
  EXPECT_EQ(Next(first_, &replayer).finding, "");
  const ReplayedFile second = Next(second_, &replayer);
  EXPECT_EQ(second.finding, "");
  EXPECT_EQ(second.part, 2U);
  EXPECT_EQ(second.steps, kSteps - kFirst);
  EXPECT_FALSE(second.difference.has_value());
  EXPECT_TRUE(second.complete);
}

TEST_F(SplitReplayTest, APartWithoutTheOneBeforeSaysWhatIsMissing) {
  Replayer replayer;
  EXPECT_THAT(Next(second_, &replayer).finding, HasSubstr("part 2"));
  EXPECT_EQ(Next(first_, &replayer).finding, "");
  EXPECT_EQ(Next(second_, &replayer).finding, "");
  EXPECT_THAT(Next(second_, &replayer).finding, HasSubstr("part 2"));
}

TEST_F(SplitReplayTest, APartOfAnotherLifeIsNoContinuation) {
  std::get<RecordedContinuation>(second_[0]).boot_epoch ^= 1;
  Replayer replayer;
  Next(first_, &replayer);
  EXPECT_THAT(Next(second_, &replayer).finding, HasSubstr("part 2"));
}

TEST_F(ReplayTest, AFullDiskIsNamed) {
  records_.back() = RecordedEnd{kSteps, 17, "No space left\x1b on device"};
  ReplayedFile outcome = ReplayOf(records_);
  EXPECT_EQ(outcome.failure, "No space left? on device");
  EXPECT_EQ(outcome.lost, 17U);
  EXPECT_THAT(ToText({outcome}), HasSubstr("could not be written: No space left? on device"));
  EXPECT_THAT(ToJson({outcome}), HasSubstr("\"failure\":\"No space left? on device\""));
}

TEST(ReplayVerdict, UnreadableOutweighsDifferentOutweighsIdentical) {
  ReplayedFile same;
  ReplayedFile other;
  other.difference.emplace();
  ReplayedFile bad;
  bad.finding = "is empty";
  EXPECT_EQ(OverallVerdict({same}), Verdict::kPassed);
  EXPECT_EQ(OverallVerdict({same, other}), Verdict::kFailed);
  EXPECT_EQ(OverallVerdict({same, other, bad}), Verdict::kNotRun);
  EXPECT_EQ(OverallVerdict({}), Verdict::kNotRun);
  EXPECT_THAT(ToJson({same, other, bad}), HasSubstr("\"finding\":\"is empty\""));
  EXPECT_THAT(ToText({bad}), HasSubstr("unreadable: 0 steps of 1 recording\n"));
}

}  // namespace
}  // namespace giveway::fleetctl
