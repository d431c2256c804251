// The sender of a packet, by its header and by discovery.
#include "services/link/impairment/impairer.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace giveway::link {
namespace {

constexpr std::chrono::seconds kNow(1);

PrefixBytes Prefix(std::uint8_t number) {
  PrefixBytes prefix{};
  prefix.front() = 1;
  prefix.back() = number;
  return prefix;
}

std::vector<std::uint8_t> PacketFrom(const PrefixBytes& prefix) {
  constexpr std::array<std::uint8_t, 8> kHeader = {'R', 'T', 'P', 'S', 2, 2, 1, 15};
  std::vector<std::uint8_t> packet(100);
  std::ranges::copy(kHeader, packet.begin());
  std::ranges::copy(prefix, packet.begin() + kHeader.size());
  return packet;
}

Impairer DeafTo(ImpairedSender from, std::uint32_t vehicle = 0) {
  return Impairer(
      {.seed = 1, .rules = {{.from = from, .from_vehicle = VehicleId{vehicle}, .loss = 1}}});
}

bool Heard(Impairer& impairer, const PrefixBytes& from) {
  return !impairer.Decide(PacketFrom(from), kNow).dropped;
}

TEST(Impairer, LeavesTheOwnPacketsAloneAndAllBeforeTheyAreKnown) {
  Impairer impairer({.seed = 1, .rules = {{.loss = 1}}});
  EXPECT_TRUE(Heard(impairer, Prefix(2)));
  impairer.NameOwn(Prefix(1));
  EXPECT_TRUE(Heard(impairer, Prefix(1)));
  EXPECT_EQ(impairer.Counters().packets, 0U);
  EXPECT_FALSE(Heard(impairer, Prefix(2)));
  EXPECT_EQ(impairer.Counters().packets, 1U);
}

TEST(Impairer, KnowsAVehicleByItsBeaconWriterFromThenOnForGood) {
  Impairer impairer = DeafTo(ImpairedSender::kOneVehicle, 7);
  impairer.NameOwn(Prefix(1));
  EXPECT_TRUE(Heard(impairer, Prefix(2)));
  impairer.OnWriter(Prefix(2), {"v7"});  // as the world's writer of its ranges has
  EXPECT_TRUE(Heard(impairer, Prefix(2)));
  impairer.OnWriter(Prefix(2), {"main/v7"});
  EXPECT_FALSE(Heard(impairer, Prefix(2)));
  impairer.OnWriter(Prefix(2), {"fleet"});
  EXPECT_FALSE(Heard(impairer, Prefix(2)));
  EXPECT_TRUE(Heard(impairer, Prefix(3)));
  EXPECT_EQ(impairer.CountersOf(VehicleId{7}).dropped_loss, 2U);
}

TEST(Impairer, KnowsTheWorld) {
  Impairer impairer = DeafTo(ImpairedSender::kWorld);
  impairer.NameOwn(Prefix(1));
  EXPECT_TRUE(Heard(impairer, Prefix(2)));
  impairer.OnWriter(Prefix(2), {"world"});
  EXPECT_FALSE(Heard(impairer, Prefix(2)));
}

TEST(Impairer, WhatIsNoRtpsPacketIsFromAStranger) {
  Impairer impairer({.seed = 1, .rules = {{.loss = 1}}});
  impairer.NameOwn(Prefix(1));
  std::vector<std::uint8_t> other = PacketFrom(Prefix(1));
  other[0] = 'X';
  EXPECT_TRUE(impairer.Decide(other, kNow).dropped);
  EXPECT_TRUE(impairer.Decide({other.data(), 3}, kNow).dropped);
  EXPECT_TRUE(impairer.Decide({}, kNow).dropped);
}

TEST(Impairer, ForgedSendersWithoutEndAreCountedAndNotRemembered) {
  Impairer impairer({.seed = 1, .rules = {{.loss = 1}}});
  impairer.NameOwn(Prefix(1));
  for (std::uint32_t i = 0; i < 10'000; ++i) {
    PrefixBytes forged = Prefix(9);
    forged[1] = static_cast<std::uint8_t>(i);
    forged[2] = static_cast<std::uint8_t>(i >> 8U);
    EXPECT_FALSE(Heard(impairer, forged));
  }
  EXPECT_EQ(impairer.Counters().packets, 10'000U);
  EXPECT_LE(impairer.Senders(), 4096U);
}

}  // namespace
}  // namespace giveway::link
