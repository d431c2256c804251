// The same soak in virtual time.
#include "services/fleetctl/soak/verb/soak_virtual.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>

#include "services/config/scenario_file.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/soak/soak_json.h"
#include "services/fleetctl/soak/soak_phases.h"
#include "services/fleetctl/soak/soak_verdict.h"

namespace giveway::fleetctl {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::SizeIs;

faults::Fault Planned(faults::Kind kind, double at_s, double for_s, std::uint32_t vehicle) {
  faults::Fault fault;
  fault.rule = "planned";
  fault.nth = vehicle;
  fault.kind = kind;
  fault.at_s = at_s;
  fault.for_s = for_s;
  fault.target.what = faults::Target::What::kVehicle;
  fault.target.vehicle = VehicleId{vehicle};
  return fault;
}

class SoakVirtualTest : public testing::Test {
 protected:
  SoakVirtualTest()
      : scenario_(WithPlacesFilled(LoadScenario("patrol", {0, std::nullopt, std::nullopt}), 6)) {}

  SoakResult Soak() const {
    const SoakSeen seen = RunSoakVirtually(scenario_, schedule_, PhasesOf(90, 6));
    SoakResult result;
    EvaluateSoak({seen, schedule_, {}, false}, &result);
    return result;
  }

  const Interrupts interrupts_{Silence::kComputes};  // none yet, whatever other tests had
  Scenario scenario_;
  faults::Schedule schedule_;
};

// Invariants that the run is not held to are only counted, and are not among the broken ones.
TEST_F(SoakVirtualTest, NeverFailsWithoutSayingWhy) {
  scenario_ = WithPlacesFilled(LoadScenario("warehouse_loop", {0, std::nullopt, std::nullopt}), 20);
  for (std::uint32_t vehicle = 1; vehicle <= 20; ++vehicle) {
    schedule_.push_back(Planned(faults::Kind::kEncoderWrong, 25, 8, vehicle));
    schedule_.back().parameters.factor = 1.02;  // 6 cm: less than may be, but than claims allow for
  }
  const SoakSeen seen = RunSoakVirtually(scenario_, schedule_, PhasesOf(90, 20));
  EXPECT_EQ(seen.broken_counted, seen.broken.size());
}

TEST_F(SoakVirtualTest, CarriesOutItsListAndJudgesIt) {
  schedule_ = {Planned(faults::Kind::kPause, 20, 0.8, 2), Planned(faults::Kind::kLoss, 25, 10, 1),
               Planned(faults::Kind::kRestart, 30, 2, 4),
               Planned(faults::Kind::kSonarOff, 40, 5, 5)};
  const SoakResult result = Soak();
  EXPECT_EQ(result.verdict, SoakVerdict::kPassed) << ToJson(result);
  EXPECT_NEAR(result.ran_s, 90, 0.1);
  for (const SoakFault& fault : result.faults) {
    EXPECT_TRUE(fault.observed) << fault.kind;
    EXPECT_TRUE(fault.recovered_after_s) << fault.kind;
    EXPECT_FALSE(fault.promised_s) << "no middleware reports it";
  }
  std::vector<std::string> names;
  for (const SoakHistogram& histogram : result.histograms) names.push_back(histogram.name);
  EXPECT_THAT(names, Contains("healing"));
  EXPECT_THAT(names, Contains("beacon_age"));
}

// Everything that was injected into processes and radio counted as seen.
TEST_F(SoakVirtualTest, AFaultThatMeetsNoBeaconIsNotSeenAndFailsNothing) {
  schedule_ = {Planned(faults::Kind::kOneWayCut, 25, 10, 3), Planned(faults::Kind::kLoss, 30, 2, 4),
               Planned(faults::Kind::kRestart, 29, 8, 4)};
  schedule_[0].parameters.from = VehicleId{3};  // which does not hear itself
  const SoakResult result = Soak();
  ASSERT_EQ(result.faults.size(), 3U);
  EXPECT_FALSE(result.faults[0].observed);
  EXPECT_FALSE(result.faults[1].observed);
  EXPECT_TRUE(result.faults[2].observed);
  EXPECT_EQ(result.verdict, SoakVerdict::kPassed) << ToJson(result);
}

TEST_F(SoakVirtualTest, ItsBlocksOfTimeHoldAllThereWas) {
  schedule_ = {Planned(faults::Kind::kSonarOff, 25, 20, 3)};
  const SoakResult result = Soak();
  EXPECT_EQ(result.block_s, 4.5);
  const auto& near = result.near_misses_by_block;
  EXPECT_EQ(std::accumulate(near.begin(), near.end(), std::uint64_t{0}),
            result.near_misses_counted);
  EXPECT_GT(result.near_misses_counted, 0U);
  const auto& spent = result.budget_spent_by_block;
  EXPECT_EQ(std::accumulate(spent.begin(), spent.end(), std::uint64_t{0}), result.budget_spent);
  const auto age = std::ranges::find(result.histograms, "beacon_age", &SoakHistogram::name);
  ASSERT_NE(age, result.histograms.end());
  ASSERT_EQ(age->blocks.size(), kSoakBlocks);
  std::uint64_t values = 0;
  for (const BlockSummary& block : age->blocks) values += block.count;
  EXPECT_EQ(values, age->histogram.Count());
}

TEST_F(SoakVirtualTest, IsTheSameEachTime) {
  schedule_ = {Planned(faults::Kind::kLoss, 25, 10, 3)};
  EXPECT_EQ(ToJson(Soak()), ToJson(Soak()));
}

TEST_F(SoakVirtualTest, WhoWasKilledIsNotExpectedBack) {
  schedule_ = {Planned(faults::Kind::kKill, 20, 0, 2)};
  const SoakResult result = Soak();
  EXPECT_THAT(result.violations, IsEmpty()) << ToJson(result);
}

TEST_F(SoakVirtualTest, AVehicleThatNeverDrivesAgainFailsIt) {
  schedule_ = {Planned(faults::Kind::kSonarOff, 20, 69, 2)};
  // Blind beyond the end of the run: it is never healed.
  schedule_[0].for_s = 500;
  schedule_.push_back(Planned(faults::Kind::kPause, 21, 0.2, 3));
  const SoakResult result = Soak();
  EXPECT_EQ(result.verdict, SoakVerdict::kFailed);
  ASSERT_THAT(result.violations, SizeIs(1));
  EXPECT_EQ(result.violations[0].invariant, "healing") << "the last fault is not over";
}

TEST_F(SoakVirtualTest, PlacesAreFilledInTheOrderInWhichTheyStand) {
  EXPECT_EQ(scenario_.vehicles.size(), 6U);
  EXPECT_TRUE(scenario_.spawns.empty());
  EXPECT_EQ(scenario_.vehicles.front().id, VehicleId{1});
}

}  // namespace
}  // namespace giveway::fleetctl
