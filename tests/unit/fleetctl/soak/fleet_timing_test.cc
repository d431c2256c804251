#include "services/fleetctl/soak/fleet_timing.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;

// A vehicle's own count of one figure.
class Life {
 public:
  Life& Add(DriveFigure figure, std::uint32_t value) {
    FigureSummary& kept = status_.timing.figures[static_cast<std::size_t>(figure)];
    kept.newest[kept.count++ % FigureSummary::kNewest] = value;
    kept.max = std::max(kept.max, value);
    return *this;
  }
  Life& Spend(double reaction_m, double free_m) {
    status_.timing.narrowest = ReactionMargin{Tick{++tick_}, reaction_m, free_m};
    ++status_.timing.budget_spent;
    return *this;
  }
  const VehicleStatus& Status(std::uint32_t vehicle = 1) {
    status_.vehicle = VehicleId{vehicle};
    return status_;
  }

 private:
  VehicleStatus status_;
  std::uint32_t tick_ = 0;
};

SoakHistogram Named(const FleetTiming& timing, const std::string& name) {
  const auto all = timing.Histograms();
  const auto found = std::ranges::find(all, name, &SoakHistogram::name);
  return found == all.end() ? SoakHistogram{} : *found;
}

TEST(FleetTiming, AddsUpEveryValueOfEveryVehicleOnce) {
  FleetTiming timing(milliseconds(200));
  Life one;
  Life two;
  one.Add(DriveFigure::kTurn, 300).Add(DriveFigure::kTurn, 500);
  timing.Fold(one.Status(1), 1);
  timing.Fold(one.Status(1), 2);  // nothing new
  two.Add(DriveFigure::kTurn, 900);
  timing.Fold(two.Status(2), 2);
  for (std::uint32_t i = 0; i < FigureSummary::kNewest; ++i) one.Add(DriveFigure::kTurn, 700);
  timing.Fold(one.Status(1), 3);
  const Histogram turn = Named(timing, "turn").histogram;
  EXPECT_EQ(turn.Count(), 3U + FigureSummary::kNewest);
  EXPECT_EQ(turn.Min(), 300'000);  // nanoseconds
  EXPECT_EQ(turn.Max(), 900'000);
  EXPECT_EQ(timing.Missed(), 0U);
}

TEST(FleetTiming, KeepsTheQuantilesOfEachBlockOfTime) {
  FleetTiming timing(milliseconds(200), 10);
  Life one;
  one.Add(DriveFigure::kTurn, 300);
  timing.Fold(one.Status(), 9);
  timing.Fold(one.Add(DriveFigure::kTurn, 500).Spend(0.2, 0.22).Status(), 35);
  timing.Fold(one.Add(DriveFigure::kTurn, 500).Status(), 36);
  const std::vector<BlockSummary> blocks = Named(timing, "turn").blocks;
  ASSERT_EQ(blocks.size(), 4U);
  EXPECT_EQ(blocks[0].count, 1U);
  EXPECT_NEAR(static_cast<double>(blocks[0].mean), 3e5, 0.001 * 3e5);
  EXPECT_EQ(blocks[0].p50, 300'000);
  EXPECT_EQ(blocks[0].p99, 300'000);
  EXPECT_EQ(blocks[1], BlockSummary{});
  EXPECT_EQ(blocks[3].count, 2U);
  EXPECT_EQ(timing.BudgetSpentByBlock(), (std::vector<std::uint64_t>{0, 0, 0, 1}));
}

TEST(FleetTiming, WithoutALengthKeepsNoBlocks) {
  FleetTiming timing(milliseconds(200));
  Life one;
  timing.Fold(one.Add(DriveFigure::kTurn, 300).Spend(0.2, 0.22).Status(), 9);
  EXPECT_TRUE(Named(timing, "turn").blocks.empty());
  EXPECT_TRUE(timing.BudgetSpentByBlock().empty());
}

TEST(FleetTiming, CountsWhatNoReportToldOf) {
  FleetTiming timing(milliseconds(200));
  Life one;
  for (std::uint32_t i = 0; i < FigureSummary::kNewest + 5; ++i) one.Add(DriveFigure::kTurn, i);
  timing.Fold(one.Status(), 1);
  EXPECT_EQ(timing.Missed(), 5U);
  EXPECT_EQ(Named(timing, "turn").histogram.Count(), FigureSummary::kNewest);
  EXPECT_EQ(Named(timing, "turn").histogram.Min(), 5000);
}

// At ticks below 12.5 ms more values come between two reports than one report holds.
TEST(FleetTiming, AStaleDecisionCountsThoughItIsNotAmongTheNewest) {
  FleetTiming timing(milliseconds(200));
  Life one;
  one.Add(DriveFigure::kBeaconAge, 300'000);
  for (std::uint32_t i = 0; i <= FigureSummary::kNewest; ++i) one.Add(DriveFigure::kBeaconAge, 50);
  timing.Fold(one.Status(3), 1);
  EXPECT_EQ(timing.Stale().at(VehicleId{3}).oldest, milliseconds(300));
  EXPECT_EQ(Named(timing, "beacon_age").histogram.Max(), 300'000'000);
  EXPECT_EQ(timing.Missed(), 1U);
  for (std::uint32_t i = 0; i <= FigureSummary::kNewest; ++i) one.Add(DriveFigure::kBeaconAge, 50);
  timing.Fold(one.Status(3), 2);
  EXPECT_EQ(timing.Stale().at(VehicleId{3}).count, 1U) << "the largest of both reports";
  EXPECT_EQ(timing.Missed(), 2U);
}

TEST(FleetTiming, BeginsAnewWithAnotherLife) {
  FleetTiming timing(milliseconds(200));
  Life before;
  before.Add(DriveFigure::kTurn, 1).Add(DriveFigure::kTurn, 2).Spend(0.2, 0.22);
  timing.Fold(before.Status(), 1);
  Life after;
  after.Add(DriveFigure::kTurn, 3).Spend(0.3, 0.31);
  timing.Fold(after.Status(), 2);
  EXPECT_EQ(Named(timing, "turn").histogram.Count(), 3U);
  EXPECT_EQ(timing.BudgetSpent(), 2U);
}

TEST(FleetTiming, KeepsTheNarrowestMarginOfAll) {
  FleetTiming timing(milliseconds(200));
  Life one;
  Life two;
  timing.Fold(one.Spend(0.5, 1.0).Status(1), 4);
  timing.Fold(two.Spend(0.1, 0.11).Status(2), 5);
  timing.Fold(one.Spend(0.6, 1.0).Status(1), 6);
  ASSERT_TRUE(timing.Narrowest());
  EXPECT_EQ(timing.Narrowest()->vehicle, VehicleId{2});
  EXPECT_EQ(timing.Narrowest()->time_s, 5);
  EXPECT_NEAR(timing.Narrowest()->share_left, 1 - 0.1 / 0.11, 1e-9);
}

TEST(FleetTiming, NamesWhoDecidesByBeaconsThatAreTooOld) {
  FleetTiming timing(milliseconds(200));
  Life one;
  one.Add(DriveFigure::kBeaconAge, 200'000);
  timing.Fold(one.Status(3), 7);
  EXPECT_TRUE(timing.Stale().empty());
  one.Add(DriveFigure::kBeaconAge, 200'001).Add(DriveFigure::kBeaconAge, 900'000);
  timing.Fold(one.Status(3), 8);
  const StaleDecisions stale = timing.Stale().at(VehicleId{3});
  EXPECT_EQ(stale.count, 2U);
  EXPECT_EQ(stale.first_s, 8);
  EXPECT_EQ(stale.oldest, milliseconds(900));
  EXPECT_FALSE(WithinBudgets(Named(timing, "beacon_age")));
}

TEST(FleetTiming, BudgetsTheShareOfTheFreeDistance) {
  FleetTiming timing(milliseconds(200));
  Life one;
  timing.Fold(one.Add(DriveFigure::kReactionShare, 790'000).Status(), 1);
  EXPECT_TRUE(WithinBudgets(Named(timing, "reaction_share")));
  EXPECT_EQ(Named(timing, "reaction_share").unit, HistogramUnit::kPartsPerMillion);
  timing.Fold(one.Add(DriveFigure::kReactionShare, 810'000).Status(), 2);
  EXPECT_FALSE(WithinBudgets(Named(timing, "reaction_share")));
}

}  // namespace
}  // namespace giveway::fleetctl
