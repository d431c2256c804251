// Which connection is closed for a new one at the health port. The sockets are tested in
// tests/system/health.sh.
#include "services/health/connection_desk.h"

#include <gtest/gtest.h>

namespace giveway {
namespace {

using std::chrono::milliseconds;

std::vector<Guest> Guests(std::size_t count, const std::string& address) {
  std::vector<Guest> guests;
  for (std::size_t i = 0; i < count; ++i) {
    guests.push_back(
        {address.empty() ? "10.0.0." + std::to_string(i) : address, milliseconds(100 - i)});
  }
  return guests;
}

TEST(ConnectionDesk, AnAddressHasTwoPlacesAndItsOldestGoesForAThird) {
  EXPECT_EQ(WhoGivesWay(Guests(1, "10.0.0.1"), "10.0.0.1"), std::nullopt);
  EXPECT_EQ(WhoGivesWay(Guests(2, "10.0.0.1"), "10.0.0.1"), 1U);
  EXPECT_EQ(WhoGivesWay(Guests(2, "10.0.0.1"), "10.0.0.2"), std::nullopt);
}

// Issue 25: ten clients that trickle bytes, and every probe fails.
TEST(ConnectionDesk, WhateverOthersHoldThisMachinesPlacesAreFree) {
  std::vector<Guest> guests = Guests(kPlacesOfOthers, "");
  EXPECT_EQ(WhoGivesWay(guests, kThisMachine), std::nullopt);
  EXPECT_EQ(WhoGivesWay(guests, "10.0.1.1"), kPlacesOfOthers - 1) << "the oldest of the others";
  guests.push_back({std::string(kThisMachine), milliseconds(1)});
  EXPECT_EQ(WhoGivesWay(guests, "10.0.1.1"), kPlacesOfOthers - 1);
  EXPECT_EQ(WhoGivesWay(guests, kThisMachine), std::nullopt);
}

}  // namespace
}  // namespace giveway
