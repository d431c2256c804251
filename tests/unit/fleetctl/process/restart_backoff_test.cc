#include "services/fleetctl/process/restart_backoff.h"

#include <gtest/gtest.h>

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr SteadyTime kNow = SteadyTime{seconds(100)};

TEST(RestartBackoff, TheFirstEndIsFollowedByARestartAtOnce) {
  RestartBackoff backoff;
  EXPECT_EQ(backoff.StartOf(kTheWorld, kNow), kNow);
  EXPECT_EQ(backoff.StartOf(MemberOf(VehicleId{1}), kNow), kNow) << "each member by itself";
}

TEST(RestartBackoff, WaitsTwiceAsLongEachTimeThatAProcessEndsSoonUpToALimit) {
  RestartBackoff backoff;
  SteadyTime now = backoff.StartOf(kTheWorld, kNow);
  for (const Nanoseconds wait : {milliseconds(100), milliseconds(200), milliseconds(400)}) {
    EXPECT_EQ(backoff.StartOf(kTheWorld, now) - now, wait);
    now += wait;
  }
  for (int i = 0; i < 20; ++i) now = backoff.StartOf(kTheWorld, now);
  EXPECT_EQ(backoff.StartOf(kTheWorld, now) - now, RestartBackoff::kLongest);
}

TEST(RestartBackoff, AProcessThatRanWellStartsAtOnceAgain) {
  RestartBackoff backoff;
  backoff.StartOf(kTheWorld, kNow);
  const SteadyTime restarted = backoff.StartOf(kTheWorld, kNow);
  const SteadyTime later = restarted + RestartBackoff::kRanWell;
  EXPECT_EQ(backoff.StartOf(kTheWorld, later), later);
}

}  // namespace
}  // namespace giveway::fleetctl
