// Several participants that speak as the world: which are remembered, and how long each may be
// silent.
#include <gmock/gmock.h>

#include <chrono>
#include <limits>
#include <map>

#include "services/link/inbox/silence_limit.h"
#include "services/link/inbox/tick_period.h"
#include "services/link/inbox/world_binding.h"
#include "services/link/inbox/world_candidates.h"

namespace giveway::link {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr SteadyTime kBound = seconds(100);

// Participant p speaks by the writer 100 + p, discovered p-th; but those in `found_` as it says.
class Candidates : public ::testing::Test {
 protected:
  std::vector<std::uint64_t> Keep(std::uint64_t participant, const std::string& reason = "") {
    WorldCandidate candidate{.participant = participant, .writer = 100 + participant};
    candidate.entry.reason = reason;
    std::vector<std::uint64_t> gone;
    for (const WorldCandidate& one : candidates_.Keep(candidate, Found())) {
      gone.push_back(one.participant);
    }
    return gone;
  }
  std::uint64_t Best() const {
    const WorldCandidate* const best = candidates_.Best(Found());
    return best == nullptr ? 0 : best->participant;
  }
  WorldCandidates::Found Found() const {
    return [this](std::uint64_t writer) {
      const auto known = found_.find(writer - 100);
      return known == found_.end() ? writer - 100 : known->second;
    };
  }
  WorldCandidates candidates_;
  std::map<std::uint64_t, std::uint64_t> found_;
};

TEST_F(Candidates, TheOneFoundLastIsFollowedOfThoseThatAreThere) {
  EXPECT_EQ(Best(), 0U);
  Keep(2);
  Keep(1);
  EXPECT_EQ(Best(), 2U);
  found_[2] = 0;
  EXPECT_EQ(Best(), 1U);
  candidates_.Remove(1);
  EXPECT_EQ(Best(), 0U) << "the other has left";
}

TEST_F(Candidates, OfOneParticipantTheNewestEntryIsKept) {
  Keep(1, "old");
  EXPECT_THAT(Keep(1, "new"), ::testing::ElementsAre(1U));
  ASSERT_EQ(candidates_.All().size(), 1U);
  EXPECT_EQ(candidates_.All().front().entry.reason, "new");
}

// The first to come was dropped: a restarted world, by four intruders.
TEST_F(Candidates, StrangersFoundBeforeItDoNotPushOutAWorldThatWasStartedAgain) {
  Keep(9);
  for (std::uint64_t stranger = 1; stranger <= 8; ++stranger) Keep(stranger);
  EXPECT_EQ(candidates_.All().size(), WorldCandidates::kMost);
  EXPECT_EQ(Best(), 9U);
}

TEST_F(Candidates, ThoseThatLeftGoFirstThenTheOneFoundFirst) {
  for (std::uint64_t one = 1; one <= 4; ++one) Keep(one);
  found_[3] = 0;
  EXPECT_THAT(Keep(5), ::testing::ElementsAre(3U));
  EXPECT_THAT(Keep(6), ::testing::ElementsAre(1U));
  found_[7] = 0;
  EXPECT_THAT(Keep(7), ::testing::ElementsAre(7U)) << "it is gone itself";
}

TEST(SilenceLimit, IsAFewTicksWhereTicksAreSlow) {
  EXPECT_EQ(SilenceLimit(seconds(1), milliseconds(50)), seconds(1));
  EXPECT_EQ(SilenceLimit(seconds(1), milliseconds(500)), milliseconds(2500));
  EXPECT_EQ(SilenceLimit(seconds(1), Nanoseconds{0}), seconds(1));
}

TEST(WorldBinding, OfASlowWorldAFewTicksMayGoByInSilence) {
  WorldBinding world(milliseconds(500));
  world.Bind(1, 11, kBound);
  world.ExpectScans(kBound);
  EXPECT_FALSE(world.MayBeFollowed(kBound + milliseconds(2500), false));
  EXPECT_TRUE(world.MayBeFollowed(kBound + milliseconds(2501), false));
}

Truth TruthOf(std::uint32_t tick, double time_s, std::uint32_t epoch = 1) {
  Truth truth;
  truth.epoch = WorldEpoch{epoch};
  truth.tick = Tick{tick};
  truth.time_s = time_s;
  return truth;
}

TEST(TickPeriod, IsTheTimeFromOneTickToTheNext) {
  TickPeriod period;
  EXPECT_EQ(period.Get(), Nanoseconds{0});
  period.Hear(TruthOf(10, 1.0));
  period.Hear(TruthOf(10, 1.0));
  EXPECT_EQ(period.Get(), Nanoseconds{0});
  period.Hear(TruthOf(14, 2.0));
  EXPECT_EQ(period.Get(), milliseconds(250));
  period.Hear(TruthOf(5, 9.0, 2));
  EXPECT_EQ(period.Get(), milliseconds(250)) << "another world: nothing to compare";
}

TEST(TickPeriod, NeverExceedsThatOfAScenario) {
  TickPeriod period;
  period.Hear(TruthOf(1, 0));
  period.Hear(TruthOf(2, 1e300));
  EXPECT_EQ(period.Get(), TickPeriod::kMost);
  period.Hear(TruthOf(3, std::numeric_limits<double>::quiet_NaN()));
  period.Hear(TruthOf(4, 1));
  EXPECT_EQ(period.Get(), TickPeriod::kMost);
}

}  // namespace
}  // namespace giveway::link
