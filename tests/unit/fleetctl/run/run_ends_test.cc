#include "services/fleetctl/run/run_ends.h"

#include <gtest/gtest.h>

#include <csignal>

namespace giveway::fleetctl {
namespace {

constexpr MemberId kVehicle = MemberOf(VehicleId{2});
constexpr ProcessEnd kLeft{false, 0};
constexpr ProcessEnd kFailed{false, 1};
constexpr ProcessEnd kKilled{true, SIGKILL};
constexpr bool kOpen = true;
constexpr bool kClosed = false;
constexpr bool kOthersRun = true;

TEST(RunEnds, OfAClosedFleetOnlyThePlannedAreNotTheEndOfTheRun) {
  EXPECT_TRUE(MayEndEarly({kVehicle, kKilled, true}, kClosed, kOthersRun));
  EXPECT_FALSE(MayEndEarly({kVehicle, kKilled, false}, kClosed, kOthersRun));
  EXPECT_FALSE(MayEndEarly({kVehicle, kLeft, false}, kClosed, kOthersRun));
  EXPECT_FALSE(MayEndEarly({kTheWorld, kLeft, false}, kClosed, kOthersRun));
}

TEST(RunEnds, WhatDiesComesBackAndWhatIsDoneOrCannotStartDoesNot) {
  constexpr ProcessEnd kWatchdog{false, 70};
  EXPECT_TRUE(IsToComeBack({kVehicle, kKilled, false}, 0));
  EXPECT_TRUE(IsToComeBack({kVehicle, kWatchdog, false}, 0));
  EXPECT_TRUE(IsToComeBack({kVehicle, kFailed, false}, 0));
  EXPECT_TRUE(IsToComeBack({kTheWorld, kKilled, false}, kMostRestarts - 1));
  EXPECT_FALSE(IsToComeBack({kTheWorld, kKilled, false}, kMostRestarts));
  EXPECT_FALSE(IsToComeBack({kVehicle, kKilled, true}, 0)) << "as planned";
  EXPECT_FALSE(IsToComeBack({kVehicle, kLeft, false}, 0));
  EXPECT_FALSE(IsToComeBack({kVehicle, {false, 2}, false}, 0)) << "it cannot start";
  EXPECT_FALSE(IsToComeBack({kTheWorld, kFailed, false}, 0)) << "that is its verdict";
}

TEST(RunEnds, AnOpenFleetGoesOnUntilItsLastVehicleOrTheWorldIsGone) {
  EXPECT_TRUE(MayEndEarly({kVehicle, kKilled, false}, kOpen, kOthersRun));
  EXPECT_FALSE(MayEndEarly({kVehicle, kKilled, false}, kOpen, !kOthersRun));
  EXPECT_TRUE(MayEndEarly({kVehicle, kKilled, true}, kOpen, !kOthersRun));
  EXPECT_FALSE(MayEndEarly({kTheWorld, kFailed, false}, kOpen, kOthersRun));
}

TEST(RunEnds, AVehicleOfAClosedFleetEndsWellWithCodeZeroOrAsPlanned) {
  EXPECT_TRUE(IsGoodEnd({kVehicle, kLeft, false}, kClosed));
  EXPECT_TRUE(IsGoodEnd({kVehicle, kKilled, true}, kClosed));
  EXPECT_FALSE(IsGoodEnd({kVehicle, kFailed, false}, kClosed));
  EXPECT_FALSE(IsGoodEnd({kVehicle, kKilled, false}, kClosed));
}

TEST(RunEnds, OfAnOpenFleetOnlyTheWorldCanEndBadly) {
  EXPECT_TRUE(IsGoodEnd({kVehicle, kFailed, false}, kOpen));
  EXPECT_TRUE(IsGoodEnd({kVehicle, kKilled, false}, kOpen));
  EXPECT_FALSE(IsGoodEnd({kTheWorld, kKilled, false}, kOpen));
}

// A crash, or a hang, at the end of a soak was no end that counted.
TEST(RunEnds, OneThatIsAskedToStopLeavesWithCodeZero) {
  constexpr ProcessEnd kTookTooLong{false, 128 + SIGTERM};
  EXPECT_TRUE(HasLeft({kVehicle, kLeft, false}));
  EXPECT_TRUE(HasLeft({kVehicle, kKilled, true})) << "as planned";
  EXPECT_FALSE(HasLeft({kVehicle, kFailed, false}));
  EXPECT_FALSE(HasLeft({kVehicle, kTookTooLong, false}));
  EXPECT_FALSE(HasLeft({kVehicle, {true, SIGSEGV}, false}));
  EXPECT_FALSE(HasLeft({kVehicle, kKilled, false})) << "it had to be";
  EXPECT_TRUE(HasLeft({kTheWorld, kLeft, false}));
  EXPECT_TRUE(HasLeft({kTheWorld, kFailed, false})) << "that is its verdict";
  EXPECT_FALSE(HasLeft({kTheWorld, {false, 2}, false}));
  EXPECT_FALSE(HasLeft({kTheWorld, {true, SIGABRT}, false}));
}

TEST(RunEnds, ADiscoveryServerMayBeEndedByTheSignalThatAsksIt) {
  constexpr MemberId kServer{MemberKind::kDiscoveryServer, 1};
  EXPECT_TRUE(HasLeft({kServer, kLeft, false}));
  EXPECT_TRUE(HasLeft({kServer, {true, SIGTERM}, false}));
  EXPECT_FALSE(HasLeft({kServer, kKilled, false}));
  EXPECT_FALSE(HasLeft({kVehicle, {true, SIGTERM}, false}));
}

TEST(RunEnds, TheWorldsExitCodeIsAVerdict) {
  EXPECT_TRUE(IsGoodEnd({kTheWorld, kFailed, false}, kClosed));
  EXPECT_TRUE(IsGoodEnd({kTheWorld, kFailed, false}, kOpen));
  EXPECT_FALSE(IsGoodEnd({kTheWorld, kKilled, false}, kClosed));
}

TEST(ErrorLines, AreThoseOfTheLogsErrorLevel) {
  EXPECT_TRUE(IsErrorLine("12:00:00.000 error   vehicle 2: the recording ends here: No space"));
  EXPECT_TRUE(IsErrorLine(R"({"time":"","steady_ns":1,"level":"error","process":"v","text":""})"));
  EXPECT_FALSE(IsErrorLine("12:00:00.000 info    vehicle 2: no error here"));
  EXPECT_FALSE(IsErrorLine(""));
}

}  // namespace
}  // namespace giveway::fleetctl
