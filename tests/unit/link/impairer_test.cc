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

PrefixBytes ForgedPrefix(std::uint32_t number) {
  PrefixBytes prefix = Prefix(9);
  prefix[1] = static_cast<std::uint8_t>(number);
  prefix[2] = static_cast<std::uint8_t>(number >> 8U);
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
  for (std::uint32_t i = 0; i < 10'000; ++i) EXPECT_FALSE(Heard(impairer, ForgedPrefix(i)));
  EXPECT_EQ(impairer.Counters().packets, 10'000U);
  EXPECT_LE(impairer.Senders(), 4096U);
}

// Regression: once 4096 prefixes had been heard, forged ones included, no vehicle that started
// later was identified, and rules that name it did nothing.
TEST(Impairer, KnowsAVehicleThatStartsAfterAFloodOfForgedSenders) {
  Impairer impairer = DeafTo(ImpairedSender::kOneVehicle, 7);
  impairer.NameOwn(Prefix(1));
  for (std::uint32_t i = 0; i < 10'000; ++i) EXPECT_TRUE(Heard(impairer, ForgedPrefix(i)));
  impairer.OnWriter(Prefix(2), {"main/v7"});
  EXPECT_FALSE(Heard(impairer, Prefix(2)));
}

TEST(Impairer, OneThatIsGoneStaysKnownUntilAnotherNeedsItsPlace) {
  Impairer impairer = DeafTo(ImpairedSender::kOneVehicle, 7);
  impairer.NameOwn(Prefix(1));
  impairer.OnWriter(Prefix(2), {"main/v7"});
  impairer.OnWriterGone(Prefix(2), {"main/v7"});
  EXPECT_FALSE(Heard(impairer, Prefix(2)));
  for (std::uint32_t i = 1; i < 4096; ++i) impairer.OnWriter(ForgedPrefix(i), {"main/v8"});
  EXPECT_FALSE(Heard(impairer, Prefix(2))) << "there is a place for each";
  impairer.OnWriter(Prefix(3), {"main/v7"});
  EXPECT_FALSE(Heard(impairer, Prefix(3)));
  EXPECT_TRUE(Heard(impairer, Prefix(2)));
  impairer.OnWriter(Prefix(4), {"main/v7"});
  EXPECT_TRUE(Heard(impairer, Prefix(4))) << "all others are there";
  impairer.OnWriterGone(ForgedPrefix(9), {"main/v8"});
  impairer.OnWriter(Prefix(4), {"main/v7"});
  EXPECT_FALSE(Heard(impairer, Prefix(4)));
}

}  // namespace
}  // namespace giveway::link
