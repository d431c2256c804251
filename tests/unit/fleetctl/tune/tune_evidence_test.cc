// Trials become figures, and files become trials again.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/tune/tune_store.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

TrialEvidence Trial(std::uint32_t alarms, double detection_ms) {
  TrialEvidence trial;
  trial.candidate = "d190_l250_be_h4";
  trial.trial = 2;
  trial.seed = 4'000'000'000;
  trial.vehicles = 4;
  trial.alive_s = 9;
  trial.alarms = {alarms, 1, 2};
  trial.reported_deadline = 5;
  trial.age_mean_ms = 55.5;
  trial.age_p99_ms = 150;
  trial.heard_bytes_s = 36000.25;
  trial.cpu_share = 0.01;
  trial.longest_pause_ms = 75;
  trial.detections = {{detection_ms - 20, detection_ms, AlarmCause::kLiveliness}};
  return trial;
}

TEST(TuneEvidence, RatesArePerVehicleHour) {
  const auto figures = FiguresOf({Trial(7, 200), Trial(7, 210)});
  ASSERT_TRUE(figures);
  EXPECT_DOUBLE_EQ(figures->vehicle_hours, 2 * 4 * 9 / 3600.0);
  EXPECT_DOUBLE_EQ(figures->alarms_per_hour, 20 / (2 * 4 * 9 / 3600.0));
  EXPECT_DOUBLE_EQ(figures->detection_ms, 205);
  EXPECT_DOUBLE_EQ(figures->detection_error_ms, 5);
  EXPECT_DOUBLE_EQ(figures->detection_from_kill_ms, 185);
  EXPECT_EQ(figures->detection_max_ms, 210);
  EXPECT_EQ(figures->detected_by.liveliness, 2U);
  EXPECT_DOUBLE_EQ(*figures->heard_bytes_s, 36000.25);
}

TEST(TuneEvidence, ATrialWithTroubleCountsForNothing) {
  TrialEvidence bad = Trial(1000, 900);
  bad.trouble = "the world ended";
  EXPECT_FALSE(FiguresOf({bad}));
  const auto figures = FiguresOf({Trial(7, 200), bad});
  EXPECT_EQ(figures->trials, 1U);
  EXPECT_EQ(figures->alarms.Total(), 10U);
  EXPECT_EQ(figures->detections, 1U);
}

TEST(TuneEvidence, AlarmsThatComeTogetherWidenTheInterval) {
  // 4 and 16 alarms where 10 were expected each time: (36 + 36) / 10 over one degree of freedom.
  const std::vector<TrialEvidence> scattered = {Trial(1, 200), Trial(13, 200)};
  EXPECT_DOUBLE_EQ(Dispersion({scattered}), 7.2);
  // Another candidate's even trials count too, one trial alone and one with trouble do not.
  TrialEvidence bad = Trial(1000, 900);
  bad.trouble = "the world ended";
  const std::vector<TrialEvidence> even = {Trial(7, 200), Trial(7, 200), bad};
  EXPECT_DOUBLE_EQ(Dispersion({scattered, even, {Trial(99, 200)}}), 3.6);
  EXPECT_EQ(Dispersion({even}), 1);
  EXPECT_EQ(Dispersion({}), 1);

  const auto alone = FiguresOf(scattered);
  const auto together = FiguresOf(scattered, 4);
  EXPECT_EQ(together->alarms_per_hour, alone->alarms_per_hour);
  EXPECT_NEAR(
      (together->alarms_high - together->alarms_low) / (alone->alarms_high - alone->alarms_low), 2,
      0.2);
}

TEST(TuneEvidence, PeersThatLoseTheSameVictimMakeTheMeanNoSurer) {
  const auto with_three_peers = [](double detection_ms) {
    TrialEvidence trial = Trial(7, detection_ms);
    trial.detections.resize(3, trial.detections.front());
    return trial;
  };
  const auto figures = FiguresOf({with_three_peers(200), with_three_peers(210)});
  EXPECT_EQ(figures->detections, 6U);
  EXPECT_DOUBLE_EQ(figures->detection_error_ms, 5);
}

// Exact intervals of the Poisson distribution, from chi-squared tables.
TEST(TuneEvidence, TheIntervalOfACountIsThatOfThePoissonDistribution) {
  EXPECT_EQ(PoissonInterval(0, kZ99).low, 0);
  EXPECT_NEAR(PoissonInterval(0, kZ99).high, 5.298, 0.002);
  EXPECT_NEAR(PoissonInterval(10, kZ99).low, 3.717, 0.002);
  EXPECT_NEAR(PoissonInterval(10, kZ99).high, 21.398, 0.002);
  EXPECT_NEAR(PoissonInterval(100, kZ99).low, 76.12, 0.01);
  EXPECT_NEAR(PoissonInterval(100, kZ99).high, 128.76, 0.01);
}

TEST(TuneEvidence, WhatIsWrittenIsReadBack) {
  const TrialEvidence trial = Trial(7, 200.125);
  const auto read = EvidenceFrom(ToJson(trial));
  ASSERT_TRUE(read);
  EXPECT_EQ(ToJson(*read), ToJson(trial));
  EXPECT_EQ(read->seed, 4'000'000'000U);
  EXPECT_EQ(read->detections.at(0).cause, AlarmCause::kLiveliness);
}

TEST(TuneEvidence, WhatIsMissingStaysMissing) {
  TrialEvidence trial = Trial(7, 200);
  trial.heard_bytes_s.reset();
  trial.detections.clear();
  trial.trouble = "a \"quoted\" word";
  EXPECT_EQ(ToJson(*EvidenceFrom(ToJson(trial))), ToJson(trial));
}

TEST(TuneEvidence, HalfAFileIsNoEvidence) {
  const std::string json = ToJson(Trial(7, 200));
  for (std::size_t size = 0; size < json.size(); size += 7) {
    EXPECT_FALSE(EvidenceFrom(json.substr(0, size))) << size;
  }
  EXPECT_FALSE(EvidenceFrom("[1]"));
}

class TuneStoreTest : public testing::Test {
 protected:
  TuneStoreTest() {
    std::string name = testing::TempDir() + "tune_store_XXXXXX";
    scratch_ = mkdtemp(name.data());
    folder_ = scratch_ / "tuned";
  }
  ~TuneStoreTest() override { fs::remove_all(scratch_); }
  fs::path scratch_;
  fs::path folder_;  // not there yet
};

TEST_F(TuneStoreTest, GoesOnWhereItStopped) {
  TuneStore(folder_, "{1}").Keep(Trial(7, 200));
  const TuneStore again(folder_, "{1}");
  ASSERT_EQ(again.Found().size(), 1U);
  EXPECT_EQ(ToJson(again.Found()[0]), ToJson(Trial(7, 200)));
}

TEST_F(TuneStoreTest, AFileThatIsSpoiltIsMeasuredAnew) {
  TuneStore(folder_, "{1}").Keep(Trial(7, 200));
  std::ofstream(folder_ / "trials" / "d190_l250_be_h4-2.json") << "{\"candidate\":";
  EXPECT_TRUE(TuneStore(folder_, "{1}").Found().empty());
}

TEST_F(TuneStoreTest, AnotherSearchDoesNotGoOnThere) {
  TuneStore(folder_, "{1}").Keep(Trial(7, 200));
  EXPECT_THROW(TuneStore(folder_, "{2}"), OutputError);
}

}  // namespace
}  // namespace giveway::fleetctl
