#include "tests/attack/heard.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>

#include <bit>

namespace giveway::attack {
namespace {

using test::PacketBytes;
using test::PrefixBytes;
using test::RtpsPacket;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr PrefixBytes kOfVehicle{1, 15, 7};
constexpr PrefixBytes kOfWorld{1, 15, 9};
constexpr PrefixBytes kOfIntruder{1, 15, 66};

void Append(std::uint32_t number, PacketBytes* to) {
  for (int i = 0; i < 4; ++i) to->push_back(static_cast<std::uint8_t>(number >> (8 * i)));
}

// The test vector of idl/fleet.idl, of vehicle 7, as the library writes it.
PacketBytes Beacon() {
  PacketBytes sample{0, 1, 0, 0};
  for (const std::uint32_t number : {7U, 3735928559U, 3U, 4U, 5U, 0U}) Append(number, &sample);
  for (const double number : {1.5, -2.25, 0.4, 1.0, -2.0, 0.5, 0.5, -0.125, 0.25, 0.03125, -0.0625,
                              0.015625, 0.25, 0.0975, 0.33, 0.3, 0.6, 3.0, -4.0}) {
    const auto bits = std::bit_cast<std::uint64_t>(number);
    Append(static_cast<std::uint32_t>(bits), &sample);
    Append(static_cast<std::uint32_t>(bits >> 32U), &sample);
  }
  for (const std::uint32_t number : {1U, 4U, 2U, 9U, 6U, 8U, 7U, 0x4babb897U}) {
    Append(number, &sample);
  }
  return sample;
}

Packet To(std::uint16_t port, const RtpsPacket& bytes) {
  Packet packet;
  packet.to.s_addr = htonl(INADDR_LOOPBACK);
  packet.port = port;
  packet.bytes = bytes.Bytes();
  return packet;
}

Packet BeaconFrom(const PrefixBytes& prefix, std::int64_t number = 41) {
  return To(7661, RtpsPacket(prefix).InfoTs().Data(0x00000302, number, Beacon()).Statistics());
}

std::vector<Heard> HeardIn(const Packet& packet) {
  std::vector<Heard> found;
  FindHeard(packet, &found);
  return found;
}

TEST(Heard, ABeaconIsKnownByItsLengthAndItsSum) {
  const Packet packet = BeaconFrom(kOfVehicle);
  const auto found = HeardIn(packet);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(BeaconOf(found[0]), 7U);
  EXPECT_EQ(found[0].prefix, kOfVehicle);
  EXPECT_EQ(found[0].writer, 0x00000302U);
  for (const std::size_t at : {std::size_t{4}, std::size_t{28}, std::size_t{211}}) {
    Packet other = packet;
    other.bytes[BeaconAt(found[0]) + at] ^= 1U;
    EXPECT_EQ(BeaconOf(HeardIn(other).at(0)), std::nullopt) << at;
  }
  const Packet command = To(7661, RtpsPacket(kOfVehicle).Data(0x00000502, 41, PacketBytes(72)));
  EXPECT_EQ(BeaconOf(HeardIn(command).at(0)), std::nullopt);
}

TEST(Heard, ItsNumberIsReadAndPutInItsPlace) {
  Packet packet = BeaconFrom(kOfVehicle, (std::int64_t{3} << 32U) + 5);
  const auto found = HeardIn(packet);
  EXPECT_EQ(NumberOf(found.at(0)), (std::int64_t{3} << 32U) + 5);
  PacketBytes copy = packet.bytes;
  SetNumber(found.at(0), (std::int64_t{9} << 32U) + 6, &copy);
  packet.bytes = copy;
  EXPECT_EQ(NumberOf(found.at(0)), (std::int64_t{9} << 32U) + 6);
  EXPECT_EQ(BeaconOf(found.at(0)), 7U);
}

TEST(Heard, AVehicleListensWherePacketsGoThatNameItAndAtTheOtherPortOfThePair) {
  const std::vector<Packet> captured{
      BeaconFrom(kOfVehicle),
      To(7675, RtpsPacket(kOfWorld).InfoDst(kOfVehicle).Data(0x00000a02, 1, PacketBytes(40))),
      To(7673, RtpsPacket(kOfWorld).InfoDst(kOfIntruder).Data(0x00000a02, 1, PacketBytes(40)))};
  in_addr loopback{};
  loopback.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_THAT(PlacesOf(7, captured), ElementsAre(Place{loopback, 7675}, Place{loopback, 7674}));
  EXPECT_THAT(PlacesOf(8, captured), IsEmpty()) << "no beacon from it was received";
  EXPECT_EQ(PlacesOfAll(captured).size(), 3U);
}

TEST(Heard, WhoSpeaksAsTheVehicleNowAndThenIsNotTheVehicle) {
  const std::vector<Packet> captured{BeaconFrom(kOfVehicle, 1), BeaconFrom(kOfVehicle, 2),
                                     BeaconFrom(kOfIntruder, 900)};
  const auto beacons = BeaconsOf(7, captured);
  ASSERT_EQ(beacons.size(), 2U);
  for (const Heard& beacon : beacons) EXPECT_EQ(beacon.prefix, kOfVehicle);
}

TEST(Heard, APacketThatEndsTooEarlyIsReadUpToThere) {
  Packet packet = BeaconFrom(kOfVehicle);
  const std::size_t end = BeaconAt(HeardIn(packet).at(0)) + kBeaconBytes;
  for (std::size_t size = packet.bytes.size(); size > 0; --size) {
    packet.bytes.resize(size);
    EXPECT_EQ(HeardIn(packet).size(), size < end ? 0U : 1U) << size;
  }
}

}  // namespace
}  // namespace giveway::attack
