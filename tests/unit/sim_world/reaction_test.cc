#include "sim_world/run/reaction.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace giveway::sim {
namespace {

using std::chrono::milliseconds;

MotorCommand ChangedBecauseOf(std::uint32_t cause_tick) {
  MotorCommand command;
  command.decision.cause_tick = Tick{cause_tick};
  command.decision_changed = true;
  return command;
}

TEST(Reaction, IsTheTimeFromTheCauseShownToTheCommandApplied) {
  ReactionMeter meter;
  meter.Published(Tick{10}, milliseconds{1000});
  meter.Published(Tick{11}, milliseconds{1050});
  meter.Applied(ChangedBecauseOf(10), milliseconds{1062});
  const ReactionFigures figures = meter.Figures();
  EXPECT_EQ(figures.count, 1U);
  EXPECT_DOUBLE_EQ(figures.p50_ms.value(), 62);
  EXPECT_DOUBLE_EQ(figures.max_ms.value(), 62);
}

TEST(Reaction, OnlyANewDecisionWithAKnownCauseCounts) {
  ReactionMeter meter;
  meter.Published(Tick{10}, milliseconds{1000});
  MotorCommand same_decision = ChangedBecauseOf(10);
  same_decision.decision_changed = false;
  meter.Applied(same_decision, milliseconds{1010});
  meter.Applied(ChangedBecauseOf(Number(kNoTick)), milliseconds{1010});
  meter.Applied(ChangedBecauseOf(9), milliseconds{1010});   // before the run
  meter.Applied(ChangedBecauseOf(74), milliseconds{1010});  // shares the slot of tick 10
  EXPECT_EQ(meter.Figures().count, 0U);
  EXPECT_FALSE(meter.Figures().p50_ms.has_value());
}

TEST(Reaction, ACauseOlderThanTheMemoryIsLeftOut) {
  ReactionMeter meter;
  for (std::uint32_t tick = 1; tick <= 65; ++tick) meter.Published(Tick{tick}, milliseconds{tick});
  meter.Applied(ChangedBecauseOf(1), milliseconds{100});
  EXPECT_EQ(meter.Figures().count, 0U);
  meter.Applied(ChangedBecauseOf(2), milliseconds{100});
  EXPECT_DOUBLE_EQ(meter.Figures().max_ms.value(), 98);
}

TEST(Reaction, PercentilesAreByNearestRank) {
  ReactionMeter meter;
  meter.Published(Tick{1}, milliseconds{0});
  for (int ms = 200; ms >= 1; --ms) meter.Applied(ChangedBecauseOf(1), milliseconds{ms});
  const ReactionFigures figures = meter.Figures();
  EXPECT_EQ(figures.count, 200U);
  EXPECT_DOUBLE_EQ(figures.p50_ms.value(), 100);
  EXPECT_DOUBLE_EQ(figures.p99_ms.value(), 198);
  EXPECT_DOUBLE_EQ(figures.max_ms.value(), 200);
}

TEST(Reaction, MemoryIsBoundedAndTheLongestIsNeverForgotten) {
  ReactionMeter meter;
  meter.Published(Tick{1}, milliseconds{0});
  meter.Applied(ChangedBecauseOf(1), milliseconds{500});
  for (std::size_t i = 0; i < ReactionMeter::kKeptSamples; ++i) {
    meter.Applied(ChangedBecauseOf(1), milliseconds{20});
  }
  const ReactionFigures figures = meter.Figures();
  EXPECT_EQ(figures.count, ReactionMeter::kKeptSamples + 1);
  EXPECT_DOUBLE_EQ(figures.p99_ms.value(), 20);
  EXPECT_DOUBLE_EQ(figures.max_ms.value(), 500);
}

// Issue 21, number 11: 800 KB were reserved, and allocated page by page while vehicles decided: the
// world's memory grew for hours.
TEST(Reaction, ARunOfManyHoursTakesNoMoreMemoryThanOneOfAMinute) {
  static_assert(sizeof(ReactionMeter) <= 72 * 1024);
  static_assert(std::is_trivially_copyable_v<ReactionMeter>);
}

// The ring drops the oldest, and all others count.
TEST(Reaction, PercentilesAreOfTheNewest) {
  ReactionMeter meter;
  meter.Published(Tick{1}, milliseconds{0});
  for (std::size_t i = 0; i < ReactionMeter::kKeptSamples; ++i) {
    meter.Applied(ChangedBecauseOf(1), milliseconds{10});
  }
  EXPECT_DOUBLE_EQ(meter.Figures().p50_ms.value(), 10);
  for (std::size_t i = 0; i <= ReactionMeter::kKeptSamples / 2; ++i) {
    meter.Applied(ChangedBecauseOf(1), milliseconds{30});
  }
  EXPECT_DOUBLE_EQ(meter.Figures().p50_ms.value(), 30);
}

}  // namespace
}  // namespace giveway::sim
