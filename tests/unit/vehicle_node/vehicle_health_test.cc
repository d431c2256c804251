// What a vehicle reports of itself from its start to its first place, and under which limits.
#include "services/vehicle_node/vehicle_health.h"

#include <gmock/gmock.h>

namespace giveway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class StartingVehicle : public ::testing::Test {
 protected:
  const LoopHealth& Loop() const { return health_.Reported().loop; }
  Reasons WhyNotReady() const { return NotReady(health_.Reported(), Loop().turned); }

  VehicleHealthReporter health_{ServiceFlags{}};
};

// Regression: it joined already while it waited for its servers, and so made its participant under
// the limits of a loop that turns.
TEST_F(StartingVehicle, MakesItsParticipantUnderTheLimitsOfAStart) {
  for (const char* waits_for : {"looks up its discovery servers", ""}) {
    health_.OnStarting(waits_for);
    EXPECT_FALSE(IsWatched(Loop().stage));
    EXPECT_THAT(NotLive(Loop(), Loop().turned + kStartLimit), IsEmpty());
  }
  health_.OnJoining("");
  EXPECT_TRUE(IsWatched(Loop().stage));
  EXPECT_FALSE(NotLive(Loop(), Loop().turned + kStartLimit).empty());
}

TEST_F(StartingVehicle, SaysWhatItWaitsForUntilThatIsThere) {
  health_.OnStarting("looks up its discovery servers");
  EXPECT_THAT(WhyNotReady(), ElementsAre("starting: looks up its discovery servers"));
  health_.OnStarting("");
  EXPECT_THAT(WhyNotReady(), ElementsAre("starting: it has no participant yet"));
  health_.OnJoining("");
  EXPECT_THAT(WhyNotReady(), ElementsAre(StartsWith("not joined: no answer from a world yet")));
}

TEST_F(StartingVehicle, IsNotWatchedWhileItLeaves) {
  health_.OnPlaced(VehicleId{1}, std::chrono::milliseconds(150));
  EXPECT_TRUE(IsWatched(Loop().stage));
  health_.OnLeaving();
  EXPECT_FALSE(IsWatched(Loop().stage));
}

}  // namespace
}  // namespace giveway::test
