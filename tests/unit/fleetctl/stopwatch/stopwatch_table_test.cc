#include "services/fleetctl/stopwatch/stopwatch_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/fleetctl/stopwatch/stopwatch_limits.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(StopwatchTable, AKilledVehicleMustBeSeenByAllButAGoodBye) {
  for (const Mechanism mechanism :
       {Mechanism::kBeaconAge, Mechanism::kDeadline, Mechanism::kLiveliness, Mechanism::kLease}) {
    EXPECT_EQ(DutyOf(Fault::kKill, mechanism, Shipped()), Duty::kMust);
  }
  EXPECT_EQ(DutyOf(Fault::kKill, Mechanism::kLeaveNotice, Shipped()), Duty::kNone);
}

TEST(StopwatchTable, AHungLoopIsInvisibleToTheParticipantsLease) {
  EXPECT_EQ(DutyOf(Fault::kHung, Mechanism::kLease, Shipped()), Duty::kNone);
  EXPECT_EQ(DutyOf(Fault::kHung, Mechanism::kDeadline, Shipped()), Duty::kMust);
}

TEST(StopwatchTable, AHungLoopIsInvisibleToLivelinessThatTheLibraryAsserts) {
  Limits limits = Shipped();
  EXPECT_EQ(DutyOf(Fault::kHung, Mechanism::kLiveliness, limits), Duty::kMust);
  limits.asserted = LivelinessKind::kManualByParticipant;
  EXPECT_EQ(DutyOf(Fault::kHung, Mechanism::kLiveliness, limits), Duty::kMust);
  limits.asserted = LivelinessKind::kAutomatic;
  EXPECT_EQ(DutyOf(Fault::kHung, Mechanism::kLiveliness, limits), Duty::kNone);
  EXPECT_EQ(DutyOf(Fault::kKill, Mechanism::kLiveliness, limits), Duty::kMust);
}

TEST(StopwatchTable, WhatIsOffMustSeeNothing) {
  Limits limits = Shipped();
  limits.deadline.reset();
  EXPECT_EQ(DutyOf(Fault::kKill, Mechanism::kDeadline, limits), Duty::kNone);
  EXPECT_THAT(Promise(Mechanism::kDeadline, limits), IsEmpty());
  EXPECT_THAT(TableText(limits), HasSubstr("off in this profile"));
}

// A vehicle and its peer may each miss a scan of a busy world: a leave notice took 126 ms then.
TEST(StopwatchTable, APromiseIsTheLimitAndTheLongestTimeBetweenTwoLooks) {
  EXPECT_EQ(PromisedWithin(Mechanism::kBeaconAge, Shipped()), milliseconds(350));
  EXPECT_EQ(PromisedWithin(Mechanism::kDeadline, Shipped()), milliseconds(225));
  EXPECT_EQ(PromisedWithin(Mechanism::kLiveliness, Shipped()), milliseconds(325));
  EXPECT_EQ(PromisedWithin(Mechanism::kLease, Shipped()), milliseconds(10'125));
  EXPECT_EQ(PromisedWithin(Mechanism::kLeaveNotice, Shipped()), milliseconds(150));
}

TEST(StopwatchTable, EveryTermOfAPromiseHasAReason) {
  for (std::size_t i = 0; i < kMechanisms; ++i) {
    for (const Term& term : Promise(static_cast<Mechanism>(i), Shipped())) {
      EXPECT_FALSE(term.reason.empty());
    }
  }
}

TEST(StopwatchTable, FaultsAreFoundByTheirNames) {
  for (std::size_t i = 0; i < kFaults; ++i) {
    EXPECT_EQ(FaultNamed(Name(static_cast<Fault>(i))), static_cast<Fault>(i));
  }
  EXPECT_FALSE(FaultNamed("flood"));
}

}  // namespace
}  // namespace giveway::fleetctl
