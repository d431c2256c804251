// What captured packets say, submessage by submessage: who wrote it, which vehicle's beacon it is,
// and where a vehicle listens. As an intruder finds it out, from the packets alone.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tests/attack/capture.h"
#include "tests/support/rtps_packet.h"

namespace giveway::attack {

inline constexpr std::size_t kRtpsHeader = 20;

// A submessage of a captured packet that names a writer.
struct Heard {
  const Packet* packet = nullptr;
  std::size_t at = 0;  // of its header
  std::uint8_t kind = 0;
  test::PrefixBytes prefix{};
  std::uint32_t writer = 0;
  std::uint32_t reader = 0;
};

// Appends the DATA and HEARTBEAT of a packet, which outlives them.
void FindHeard(const Packet& packet, std::vector<Heard>* found);

// Of a DATA.
std::int64_t NumberOf(const Heard& data);
void SetNumber(const Heard& data, std::int64_t number, test::PacketBytes* packet);
// Whose beacon it is, by its length and its checksum; nothing if it is none.
std::optional<std::uint32_t> BeaconOf(const Heard& heard);
// Where the sample of a beacon stands in its packet, and its bytes with the encapsulation.
inline constexpr std::size_t kBeaconBytes = 212;
std::size_t BeaconAt(const Heard& beacon);

// The DATA of a vehicle's beacons, in the order they came.
std::vector<Heard> BeaconsOf(std::uint32_t vehicle, const std::vector<Packet>& captured);

struct Place {
  in_addr address{};
  std::uint16_t port = 0;

  friend bool operator==(const Place& a, const Place& b) {
    return a.address.s_addr == b.address.s_addr && a.port == b.port;
  }
};

// Where a vehicle listens: whither packets went that name its participant as their destination, and
// the other one of each pair of ports. Empty until its beacons and such a packet were heard.
std::vector<Place> PlacesOf(std::uint32_t vehicle, const std::vector<Packet>& captured);
// Whither anything went.
std::vector<Place> PlacesOfAll(const std::vector<Packet>& captured);

}  // namespace giveway::attack
