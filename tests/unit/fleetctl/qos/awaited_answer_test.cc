// Which answer to an administrative request counts: the service's own or an intruder's.
#include "services/fleetctl/qos/awaited_answer.h"

#include <gtest/gtest.h>

namespace giveway::fleetctl {
namespace {

constexpr SteadyTime kSent = std::chrono::seconds(100);
constexpr VehicleId kSeven{7};
constexpr std::uint64_t kOrder = 5;

AdminAnswer Answer(AnswerState state, bool sealed) {
  AdminAnswer answer{
      .vehicle = kSeven, .order = kOrder, .state = state, .interface = "", .profiles = {}};
  if (sealed) answer.seal[0] = 1;
  return answer;
}

TEST(AwaitedAnswer, ASealedOneCountsAtOnce) {
  AwaitedAnswer awaited(kSeven, kOrder, true);
  awaited.Take(Answer(AnswerState::kInEffect, true), kSent);
  EXPECT_TRUE(awaited.IsThere(kSent));
  EXPECT_EQ(awaited.Get()->state, AnswerState::kInEffect);
}

TEST(AwaitedAnswer, OneOfAnotherVehicleOrToAnotherOrderDoesNotCount) {
  AwaitedAnswer awaited(kSeven, kOrder, true);
  AdminAnswer other = Answer(AnswerState::kInEffect, true);
  other.vehicle = VehicleId{8};
  awaited.Take(other, kSent);
  other = Answer(AnswerState::kInEffect, true);
  other.order = 6;
  awaited.Take(other, kSent);
  EXPECT_FALSE(awaited.IsThere(kSent));
  EXPECT_FALSE(awaited.Get());
}

TEST(AwaitedAnswer, ARefusalWithoutASealCountsAfterAWhile) {
  AwaitedAnswer awaited(kSeven, kOrder, true);
  awaited.Take(Answer(AnswerState::kRefused, false), kSent);
  const SteadyTime counts = kSent + AwaitedAnswer::kUnsealedPatience;
  EXPECT_FALSE(awaited.IsThere(counts));
  EXPECT_TRUE(awaited.IsThere(counts + Nanoseconds{1}));
  EXPECT_EQ(awaited.Get()->state, AnswerState::kRefused);
  awaited.Take(Answer(AnswerState::kInEffect, true), counts);
  EXPECT_EQ(awaited.Get()->state, AnswerState::kInEffect);
}

TEST(AwaitedAnswer, ARefusalWithoutASealCountsNeverOnceTheServiceSealedAnAnswer) {
  for (const bool refused_first : {true, false}) {
    AwaitedAnswer awaited(kSeven, kOrder, true);
    if (refused_first) awaited.Take(Answer(AnswerState::kRefused, false), kSent);
    awaited.Take(Answer(AnswerState::kRestarting, true), kSent);
    if (!refused_first) awaited.Take(Answer(AnswerState::kRefused, false), kSent);
    EXPECT_FALSE(awaited.IsThere(kSent + std::chrono::hours(1)));
    EXPECT_FALSE(awaited.Get()) << "it restarts, and has not come back";
    awaited.Take(Answer(AnswerState::kInEffect, true), kSent);
    EXPECT_EQ(awaited.Get()->state, AnswerState::kInEffect);
  }
}

TEST(AwaitedAnswer, WithoutAKeyTheFirstCounts) {
  AwaitedAnswer awaited(kSeven, kOrder, false);
  awaited.Take(Answer(AnswerState::kRestarting, false), kSent);
  EXPECT_FALSE(awaited.IsThere(kSent));
  awaited.Take(Answer(AnswerState::kRefused, false), kSent);
  EXPECT_TRUE(awaited.IsThere(kSent));
}

}  // namespace
}  // namespace giveway::fleetctl
