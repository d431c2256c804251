#include "services/fleetctl/soak/fault_clock.h"

#include <gmock/gmock.h>

namespace giveway::fleetctl {
namespace {

using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

faults::Fault FaultAt(double at_s, double for_s) {
  faults::Fault fault;
  fault.at_s = at_s;
  fault.for_s = for_s;
  return fault;
}

TEST(FaultClock, TellsEachEdgeOnceWhenItIsDue) {
  const faults::Schedule schedule{FaultAt(1, 2), FaultAt(2, 0)};
  FaultClock clock(schedule);
  EXPECT_THAT(clock.TakeDue(0.9), IsEmpty());
  EXPECT_THAT(clock.TakeDue(2), ElementsAre(FaultEdge{0, 1, true}, FaultEdge{1, 2, true}));
  EXPECT_THAT(clock.TakeDue(2.5), IsEmpty());
  EXPECT_THAT(clock.TakeDue(10), ElementsAre(FaultEdge{0, 3, false}));
  EXPECT_DOUBLE_EQ(clock.LastEnd_s(), 3);
}

TEST(FaultClock, EndsOneBeforeAnotherBeginsAtTheSameTime) {
  const faults::Schedule schedule{FaultAt(2, 1), FaultAt(1, 1)};
  FaultClock clock(schedule);
  EXPECT_THAT(clock.TakeDue(1), ElementsAre(FaultEdge{1, 1, true}));
  EXPECT_THAT(clock.TakeDue(2), ElementsAre(FaultEdge{1, 2, false}, FaultEdge{0, 2, true}));
}

// One shorter than a turn started and ended at once, and no effect of it could be seen.
TEST(FaultClock, EndsAFaultInALaterCallThanItStarts) {
  const faults::Schedule schedule{FaultAt(1, 0.01), FaultAt(1, 0.5), FaultAt(1.02, 1)};
  FaultClock clock(schedule);
  EXPECT_THAT(clock.TakeDue(1.04), ElementsAre(FaultEdge{0, 1, true}, FaultEdge{1, 1, true}));
  EXPECT_THAT(clock.TakeDue(1.04),
              ElementsAre(FaultEdge{0, 1.01, false}, FaultEdge{2, 1.02, true}));
  EXPECT_THAT(clock.TakeDue(9), ElementsAre(FaultEdge{1, 1.5, false}, FaultEdge{2, 2.02, false}));
}

TEST(FaultClock, KnowsWhatIsUnderWay) {
  const faults::Schedule schedule{FaultAt(1, 5), FaultAt(2, 0), FaultAt(3, 1)};
  FaultClock clock(schedule);
  clock.TakeDue(3);
  EXPECT_THAT(clock.UnderWay(), ElementsAre(0, 2));
  clock.TakeDue(4.5);
  EXPECT_THAT(clock.UnderWay(), ElementsAre(0));
}

TEST(FaultClock, FollowsTheFaultsItIsGiven) {
  const faults::Schedule schedule{FaultAt(1, 5), FaultAt(2, 1)};
  FaultClock clock(schedule, [](const faults::Fault& fault) { return fault.at_s > 1; });
  EXPECT_THAT(clock.TakeDue(2), ElementsAre(FaultEdge{1, 2, true}));
  EXPECT_DOUBLE_EQ(clock.LastEnd_s(), 3);
}

TEST(FaultClock, EndsEarlyWhatIsUnderWayAndBeginsNothingMore) {
  const faults::Schedule schedule{FaultAt(1, 5), FaultAt(9, 1)};
  FaultClock clock(schedule);
  clock.TakeDue(2);
  EXPECT_THAT(clock.EndAll(2.5), ElementsAre(FaultEdge{0, 2.5, false}));
  EXPECT_THAT(clock.TakeDue(100), IsEmpty());
}

Truth TruthAt(double time_s) {
  Truth truth;
  truth.time_s = time_s;
  return truth;
}

TEST(WorldTime, StandsWhileTheWorldIsGone) {
  WorldTime time;
  EXPECT_EQ(time.Now_s(), 0);
  time.Follow(std::vector{TruthAt(4.95), TruthAt(5)}, seconds(10));
  time.Follow({}, seconds(40));
  EXPECT_EQ(time.Now_s(), 5);
  EXPECT_EQ(time.MovedAt(), seconds(10));
  EXPECT_FALSE(time.IsGone(seconds(10) + WorldTime::kGone));
  EXPECT_TRUE(time.IsGone(seconds(11) + WorldTime::kGone));
}

TEST(WorldTime, IsGoneAlsoWhereOneTimeIsSentAgainAndAgain) {
  WorldTime time;
  time.Follow(std::vector{TruthAt(5)}, seconds(10));
  time.Follow(std::vector{TruthAt(5)}, seconds(90));
  EXPECT_TRUE(time.IsGone(seconds(90)));
  EXPECT_EQ(time.ReceivedAt(), seconds(90));
  time.Follow(std::vector{TruthAt(5.05)}, seconds(91));
  EXPECT_FALSE(time.IsGone(seconds(91)));
}

}  // namespace
}  // namespace giveway::fleetctl
