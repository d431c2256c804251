// Signal heads: what the plan shows when, which head sends when, what a fault does to it, and
// whether two plans show green at the same time.
#include <gtest/gtest.h>

#include "services/types/math/random.h"
#include "services/types/signal_plan.h"
#include "sim_world/run/traffic_lights.h"

namespace giveway::sim {
namespace {

constexpr WorldEpoch kEpoch{3};

SignalPlan Plan(double green_s, double yellow_s, double red_s, double offset_s = 0) {
  return {.id = SignalId{1},
          .line_from_world = {1, 2},
          .line_to_world = {3, 2},
          .travel_rad = 0.5,
          .green_s = green_s,
          .yellow_s = yellow_s,
          .red_s = red_s,
          .offset_s = offset_s};
}

Scenario Of(std::vector<SignalPlan> plans) {
  Scenario scenario;
  scenario.signals = std::move(plans);
  return scenario;
}

TEST(SignalPlan, ShowsGreenThenYellowThenRedAndAgain) {
  const SignalPlan plan = Plan(10, 3, 13);
  const auto at = [&](double s) { return PhaseAt(plan, FromSeconds(s)); };
  EXPECT_EQ(at(0).phase, SignalPhase::kGreen);
  EXPECT_EQ(at(0).to_change, FromSeconds(10));
  EXPECT_EQ(at(9.999).phase, SignalPhase::kGreen);
  EXPECT_EQ(at(10).phase, SignalPhase::kYellow);
  EXPECT_EQ(at(12.5).to_change, FromSeconds(0.5));
  EXPECT_EQ(at(13).phase, SignalPhase::kRed);
  EXPECT_EQ(at(13).to_change, FromSeconds(13));
  EXPECT_EQ(at(26).phase, SignalPhase::kGreen);
  EXPECT_EQ(at(26 * 1000 + 11).phase, SignalPhase::kYellow);
}

TEST(SignalPlan, TheOffsetIsHowFarItIsAtTheStart) {
  EXPECT_EQ(PhaseAt(Plan(10, 3, 13, 11), Nanoseconds{0}).phase, SignalPhase::kYellow);
  EXPECT_EQ(PhaseAt(Plan(10, 3, 13, 26 + 14), Nanoseconds{0}).phase, SignalPhase::kRed);
}

TEST(SignalPlan, HeadsThatTakeTurnsNeverLetGoTogether) {
  EXPECT_FALSE(ShowGreenTogether(Plan(10, 3, 13), Plan(10, 3, 13, 13)));
  EXPECT_TRUE(ShowGreenTogether(Plan(10, 3, 13), Plan(10, 3, 13, 12.999)));
  EXPECT_TRUE(ShowGreenTogether(Plan(10, 3, 13), Plan(10, 3, 13, 13.001)));
  EXPECT_TRUE(ShowGreenTogether(Plan(10, 3, 13), Plan(10, 3, 13)));
}

TEST(SignalPlan, HeadsOfDifferentCyclesMeetSoonerOrLater) {
  EXPECT_TRUE(ShowGreenTogether(Plan(2, 0, 18), Plan(2, 0, 19, 10)));   // no common rhythm
  EXPECT_FALSE(ShowGreenTogether(Plan(4, 1, 15), Plan(5, 1, 34, 10)));  // 20 s and 40 s
  EXPECT_TRUE(ShowGreenTogether(Plan(4, 1, 15), Plan(14.5, 1, 24.5, 10)));
  EXPECT_FALSE(ShowGreenTogether(Plan(0, 0, 20), Plan(10, 0, 0)));  // never open
}

// Against going through the common cycle tenth by tenth.
TEST(SignalPlan, TogetherIsWhatGoingThroughTimeFinds) {
  Random random(9);
  const auto whole = [&](double low, double high) {
    return static_cast<double>(static_cast<int>(random.Uniform(low, high)));
  };
  int together = 0;
  for (int i = 0; i < 300; ++i) {
    const SignalPlan a = Plan(whole(0, 4), whole(0, 2), whole(1, 9), whole(0, 20));
    const SignalPlan b = Plan(whole(0, 4), whole(0, 2), whole(1, 9), whole(0, 20));
    bool met = false;
    for (int tenth = 0; tenth < 10 * 15 * 15; ++tenth) {
      const Nanoseconds at = tenth * Nanoseconds{100'000'000};
      met |= PhaseAt(a, at).phase != SignalPhase::kRed && PhaseAt(b, at).phase != SignalPhase::kRed;
    }
    together += met ? 1 : 0;
    EXPECT_EQ(ShowGreenTogether(a, b), met) << i;
  }
  EXPECT_GT(together, 50);
  EXPECT_LT(together, 250);
}

TEST(SignalHeads, BeforeTheStartEveryHeadIsRed) {
  SignalHeads heads(Of({Plan(10, 3, 13)}));
  heads.Advance(-1, kEpoch, Tick{1});
  ASSERT_EQ(heads.States().size(), 1U);
  EXPECT_EQ(heads.States()[0].phase, SignalPhase::kRed);
  EXPECT_EQ(heads.States()[0].to_change_s, 0);
  EXPECT_EQ(heads.States()[0].epoch, kEpoch);
  heads.Advance(0, kEpoch, Tick{2});
  ASSERT_EQ(heads.States().size(), 1U);  // it changed: it speaks at once
  EXPECT_EQ(heads.States()[0].phase, SignalPhase::kGreen);
  EXPECT_EQ(heads.States()[0].tick, Tick{2});
  EXPECT_DOUBLE_EQ(heads.States()[0].to_change_s, 10);
}

TEST(SignalHeads, SpeakEvery100MillisecondsAndWhenTheyChange) {
  SignalHeads heads(Of({Plan(1.025, 3, 13)}));
  std::vector<std::uint32_t> spoke;
  for (std::uint32_t tick = 0; tick < 26; ++tick) {
    heads.Advance(0.05 * tick, kEpoch, Tick{tick + 1});
    if (!heads.States().empty()) spoke.push_back(tick);
  }
  // Green from 0; yellow from 1.025 s, first seen at tick 21; every second tick otherwise.
  EXPECT_EQ(spoke, (std::vector<std::uint32_t>{0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 21, 23, 25}));
}

TEST(SignalHeads, ADarkHeadGoesOnTalkingAndASilentOneDoesNot) {
  SignalPlan second = Plan(10, 3, 13);
  second.id = SignalId{2};
  SignalHeads heads(Of({Plan(10, 3, 13), second}));
  heads.Advance(0, kEpoch, Tick{1});
  EXPECT_EQ(heads.States().size(), 2U);
  EXPECT_TRUE(heads.Fail(SignalId{1}, FaultKind::kSignalDark));
  EXPECT_TRUE(heads.Fail(SignalId{2}, FaultKind::kSignalSilent));
  EXPECT_FALSE(heads.Fail(SignalId{3}, FaultKind::kSignalDark));
  EXPECT_FALSE(heads.Fail(SignalId{1}, FaultKind::kKill));
  std::size_t said = 0;
  for (std::uint32_t tick = 1; tick <= 20; ++tick) {
    heads.Advance(0.05 * tick, kEpoch, Tick{tick + 1});
    for (const SignalState& state : heads.States()) {
      ++said;
      EXPECT_EQ(state.id, SignalId{1});
      EXPECT_EQ(state.phase, SignalPhase::kDark);
      EXPECT_EQ(state.to_change_s, 0);
    }
  }
  EXPECT_EQ(said, 10U);
}

}  // namespace
}  // namespace giveway::sim
