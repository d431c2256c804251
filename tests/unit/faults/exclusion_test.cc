// Which faults exclude each other on one target.
#include "services/faults/exclusion.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "services/types/math/random.h"
#include "tests/unit/faults/fault_lists.h"

namespace giveway::faults {
namespace {

bool AtOnce(Kind a, Target on_a, Kind b, Target on_b) {
  const bool one_way = Exclude(Of(a, on_a, 10, 5), Of(b, on_b, 12, 5));
  EXPECT_EQ(one_way, Exclude(Of(b, on_b, 12, 5), Of(a, on_a, 10, 5)));
  return !one_way;
}

TEST(Exclusion, TheSameKindIsOnceOnATarget) {
  for (std::size_t i = 0; i < kKinds; ++i) {
    const auto kind = static_cast<Kind>(i);
    EXPECT_FALSE(AtOnce(kind, Vehicle(1), kind, Vehicle(1))) << ToString(kind);
    EXPECT_TRUE(AtOnce(kind, Vehicle(1), kind, Vehicle(2))) << ToString(kind);
  }
  EXPECT_FALSE(AtOnce(Kind::kLoss, Vehicle(1), Kind::kLoss, kAllTarget));
}

TEST(Exclusion, OneProcessIsStoppedStartedAndSetUpByOneFaultAtATime) {
  EXPECT_FALSE(AtOnce(Kind::kPause, Vehicle(1), Kind::kRestart, Vehicle(1)));
  EXPECT_FALSE(AtOnce(Kind::kQosApply, Vehicle(1), Kind::kHang, Vehicle(1)));
  EXPECT_FALSE(AtOnce(Kind::kRestart, kAllTarget, Kind::kPause, kWorldTarget));
  EXPECT_TRUE(AtOnce(Kind::kPause, Vehicle(1), Kind::kRestart, kWorldTarget));
  EXPECT_TRUE(AtOnce(Kind::kChurn, kAllTarget, Kind::kRestart, Vehicle(1)));
  EXPECT_FALSE(AtOnce(Kind::kSharedMemorySmall, kAllTarget, Kind::kSharedMemoryGone, kAllTarget));
}

TEST(Exclusion, EarsAndTheWorldDoSeveralThingsAtOnceUnlessOneHidesTheOther) {
  EXPECT_TRUE(AtOnce(Kind::kLoss, Vehicle(1), Kind::kDelay, Vehicle(1)));
  EXPECT_TRUE(AtOnce(Kind::kLoss, Vehicle(1), Kind::kRestart, Vehicle(1)));
  EXPECT_TRUE(AtOnce(Kind::kSonarOff, Vehicle(1), Kind::kMotorWeak, Vehicle(1)));
  EXPECT_FALSE(AtOnce(Kind::kPartition, Vehicle(1), Kind::kFlapping, Vehicle(1)));
  EXPECT_FALSE(AtOnce(Kind::kSonarOff, Vehicle(1), Kind::kSonarStuck, Vehicle(1)));
  EXPECT_FALSE(AtOnce(Kind::kMotorWeak, Vehicle(1), Kind::kMotorStuck, Vehicle(1)));
}

TEST(Exclusion, AnIntruderGoesByWhatItsTargetSays) {
  for (const Kind silence : {Kind::kRestart, Kind::kPause, Kind::kHang, Kind::kQosMismatch}) {
    EXPECT_FALSE(AtOnce(Kind::kSpoofed, Vehicle(1), silence, Vehicle(1))) << ToString(silence);
    EXPECT_FALSE(AtOnce(Kind::kFlooded, kAllTarget, silence, kAllTarget)) << ToString(silence);
    EXPECT_TRUE(AtOnce(Kind::kFlooded, kAllTarget, silence, Vehicle(1))) << ToString(silence);
    EXPECT_TRUE(AtOnce(Kind::kReplayed, Vehicle(1), silence, kAllTarget)) << ToString(silence);
    EXPECT_TRUE(AtOnce(Kind::kReplayed, Vehicle(2), silence, Vehicle(1))) << ToString(silence);
  }
  EXPECT_TRUE(AtOnce(Kind::kSpoofed, Vehicle(1), Kind::kSlow, Vehicle(1)));
  EXPECT_TRUE(AtOnce(Kind::kMalformed, Vehicle(1), Kind::kFlooded, Vehicle(1)));
}

TEST(Exclusion, AKilledVehicleGetsNothingMoreAndEveryOtherDoes) {
  const Fault kill = Of(Kind::kKill, Vehicle(1), 10, 0);
  for (std::size_t i = 0; i < kKinds; ++i) {
    const auto kind = static_cast<Kind>(i);
    EXPECT_TRUE(Exclude(kill, Of(kind, Vehicle(1), 1000, 5))) << ToString(kind);
    EXPECT_TRUE(Exclude(kill, Of(kind, Vehicle(1), 8, 5))) << ToString(kind);
    if (kind == Kind::kKill) continue;
    EXPECT_FALSE(Exclude(kill, Of(kind, Vehicle(1), 1, 5))) << ToString(kind);
    EXPECT_FALSE(Exclude(kill, Of(kind, kAllTarget, 1000, 5))) << ToString(kind);
  }
}

// It was accepted, and its restart brought the vehicle back.
TEST(Exclusion, NoneIsKilledWhileAllAreAway) {
  const Fault restart = Of(Kind::kRestart, kAllTarget, 30, 4);
  EXPECT_TRUE(Exclude(restart, Of(Kind::kKill, Vehicle(2), 32, 0)));
  EXPECT_TRUE(Exclude(Of(Kind::kKill, Vehicle(2), 32, 0), restart));
  EXPECT_FALSE(Exclude(restart, Of(Kind::kKill, Vehicle(2), 29, 0)));
  EXPECT_FALSE(Exclude(restart, Of(Kind::kKill, Vehicle(2), 35, 0)));
  EXPECT_FALSE(Exclude(Of(Kind::kPause, kAllTarget, 30, 4), Of(Kind::kKill, Vehicle(2), 32, 0)));
}

// It had no effect, and failed the soak by that.
TEST(Exclusion, NothingIsLostByOneThatIsAwayMeanwhile) {
  const Fault restart = Of(Kind::kRestart, Vehicle(1), 30, 5);
  EXPECT_TRUE(Exclude(restart, Of(Kind::kLoss, Vehicle(1), 31, 3)));
  EXPECT_TRUE(Exclude(Of(Kind::kOneWayCut, Vehicle(1), 31, 6), restart));
  EXPECT_FALSE(Exclude(restart, Of(Kind::kLoss, Vehicle(1), 31, 20)));
  EXPECT_FALSE(Exclude(restart, Of(Kind::kLoss, Vehicle(2), 31, 3)));
  EXPECT_FALSE(Exclude(restart, Of(Kind::kLoss, kAllTarget, 31, 3)));
  EXPECT_FALSE(Exclude(Of(Kind::kHang, Vehicle(1), 30, 5), Of(Kind::kLoss, Vehicle(1), 31, 3)));
}

TEST(Exclusion, EndsCountAsWithin) {
  const Fault first = Of(Kind::kPause, Vehicle(1), 10, 5);
  const Fault at_its_end = Of(Kind::kPause, Vehicle(1), 15, 1);
  const Fault after_it = Of(Kind::kPause, Vehicle(1), 15.001, 1);
  EXPECT_TRUE(Exclude(first, at_its_end));
  EXPECT_TRUE(Exclude(at_its_end, first));
  EXPECT_FALSE(Exclude(first, after_it));
  EXPECT_FALSE(Exclude(after_it, first));
}

// Against a comparison of all pairs.
TEST(Exclusion, FindsEveryTwoOfAList) {
  Random dice(3);
  Schedule faults;
  double at_s = 0;
  for (int i = 0; i < 300; ++i) {
    at_s += dice.Uniform(0, 2);
    faults.push_back(Of(static_cast<Kind>(dice.Next() % kKinds),
                        Vehicle(1 + static_cast<std::uint32_t>(dice.Next() % 4)), at_s,
                        dice.Uniform(0, 10)));
  }
  std::set<std::pair<std::size_t, std::size_t>> found;
  ForEachExcluding(faults, [&](std::size_t i, std::size_t j) {
    EXPECT_LT(i, j);
    EXPECT_TRUE(found.emplace(i, j).second);
  });
  std::size_t all = 0;
  for (std::size_t j = 0; j < faults.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      if (!Exclude(faults[i], faults[j])) continue;
      ++all;
      EXPECT_TRUE(found.contains({i, j})) << i << " " << j;
    }
  }
  EXPECT_EQ(found.size(), all);
  EXPECT_GT(all, 50U);
}

}  // namespace
}  // namespace giveway::faults
