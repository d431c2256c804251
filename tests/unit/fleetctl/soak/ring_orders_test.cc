// Which answers end the wait for rings to be kept.
#include <gtest/gtest.h>

#include "services/fleetctl/soak/ring_keeper.h"

namespace giveway::fleetctl {
namespace {

constexpr VehicleId kSeven{7};

AdminAnswer Answer(AnswerState state, bool sealed, VehicleId vehicle = kSeven) {
  AdminAnswer answer{
      .vehicle = vehicle, .order = 5, .state = state, .interface = "", .profiles = {}};
  if (sealed) answer.seal[0] = 1;
  return answer;
}

class RingOrdersOfSeven : public ::testing::Test {
 protected:
  static RingOrders Ordered(bool has_key) {
    RingOrders orders(has_key);
    orders.Add(5, kSeven, 2);
    return orders;
  }
};

TEST_F(RingOrdersOfSeven, ARefusalWithoutASealDoesNotEndTheWait) {
  RingOrders orders = Ordered(true);
  EXPECT_EQ(orders.Take(Answer(AnswerState::kRefused, false)), std::nullopt);
  EXPECT_EQ(orders.Take(Answer(AnswerState::kInEffect, true)), 2U);
  EXPECT_EQ(orders.Take(Answer(AnswerState::kInEffect, true)), std::nullopt) << "once";
}

TEST_F(RingOrdersOfSeven, ASealedRefusalEndsTheWait) {
  RingOrders orders = Ordered(true);
  EXPECT_EQ(orders.Take(Answer(AnswerState::kRefused, true)), std::nullopt);
  EXPECT_EQ(orders.Take(Answer(AnswerState::kInEffect, true)), std::nullopt);
}

TEST_F(RingOrdersOfSeven, AnAnswerOfAnotherVehicleDoesNotCount) {
  RingOrders orders = Ordered(false);
  EXPECT_EQ(orders.Take(Answer(AnswerState::kInEffect, false, VehicleId{8})), std::nullopt);
  EXPECT_EQ(orders.Take(Answer(AnswerState::kInEffect, false)), 2U);
}

}  // namespace
}  // namespace giveway::fleetctl
