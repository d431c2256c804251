#include "tests/attack/heard.h"

#include <algorithm>
#include <boost/crc.hpp>
#include <cstring>
#include <map>

namespace giveway::attack {
namespace {

using test::PacketBytes;
using test::PrefixBytes;

constexpr std::uint8_t kData = 0x15;
constexpr std::uint8_t kHeartbeat = 0x07;
constexpr std::uint8_t kInfoDst = 0x0e;
constexpr std::size_t kPrefixAt = 8;
constexpr std::size_t kBody = 4;         // behind a submessage's header
constexpr std::size_t kNumber = 4 + 12;  // in a DATA: its high half, then the low one
constexpr std::size_t kSample = 4 + 20;  // of a DATA without inline QoS

// idl/fleet.idl: five numbers of 32 bits, padding, doubles and eight more such numbers, of which
// the last is the sum of all others. Encapsulation: plain CDR, little-endian.
constexpr std::size_t kEncapsulation = 4;
constexpr std::size_t kHead = 20;
constexpr std::size_t kPadding = 4;
constexpr std::size_t kSum = 4;

std::uint32_t EntityAt(const PacketBytes& bytes, std::size_t at) {
  return std::uint32_t{bytes[at]} << 24U | std::uint32_t{bytes[at + 1]} << 16U |
         std::uint32_t{bytes[at + 2]} << 8U | bytes[at + 3];
}

std::uint32_t NumberAt(const PacketBytes& bytes, std::size_t at) {
  std::uint32_t number = 0;
  std::memcpy(&number, &bytes[at], sizeof number);
  return number;
}

std::size_t LengthAt(const PacketBytes& bytes, std::size_t at) {
  const bool little = (bytes[at + 1] & 1U) != 0;
  return little ? bytes[at + 2] + 256U * bytes[at + 3] : bytes[at + 3] + 256U * bytes[at + 2];
}

PrefixBytes PrefixAt(const PacketBytes& bytes, std::size_t at) {
  PrefixBytes prefix;
  std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), prefix.size(), prefix.begin());
  return prefix;
}

// Calls with the place and the length of each submessage that is whole.
template <typename Function>
void ForEachSubmessage(const PacketBytes& bytes, const Function& function) {
  for (std::size_t at = kRtpsHeader; at + kBody <= bytes.size();) {
    const std::size_t length = LengthAt(bytes, at);
    if (at + kBody + length > bytes.size()) return;
    function(at, length);
    at += kBody + length;
  }
}

bool IsTo(const PrefixBytes& prefix, const Packet& packet) {
  bool is_to = false;
  ForEachSubmessage(packet.bytes, [&](std::size_t at, std::size_t length) {
    if (packet.bytes[at] != kInfoDst || length < prefix.size()) return;
    is_to = is_to || PrefixAt(packet.bytes, at + kBody) == prefix;
  });
  return is_to;
}

void AddPlace(const Place& place, std::vector<Place>* places) {
  if (std::ranges::find(*places, place) == places->end()) places->push_back(place);
}

}  // namespace

// Fast DDS writes them little-endian here.
void FindHeard(const Packet& packet, std::vector<Heard>* found) {
  const PacketBytes& bytes = packet.bytes;
  ForEachSubmessage(bytes, [&](std::size_t at, std::size_t length) {
    const std::uint8_t kind = bytes[at];
    const bool little = (bytes[at + 1] & 1U) != 0;
    if (!little || (kind != kData && kind != kHeartbeat) || length < 20) return;
    const std::size_t reader_at = at + kBody + (kind == kData ? 4 : 0);
    found->push_back({&packet, at, kind, PrefixAt(bytes, kPrefixAt), EntityAt(bytes, reader_at + 4),
                      EntityAt(bytes, reader_at)});
  });
}

std::int64_t NumberOf(const Heard& data) {
  const PacketBytes& bytes = data.packet->bytes;
  return static_cast<std::int64_t>(std::uint64_t{NumberAt(bytes, data.at + kNumber)} << 32U |
                                   NumberAt(bytes, data.at + kNumber + 4));
}

void SetNumber(const Heard& data, std::int64_t number, PacketBytes* packet) {
  const auto bits = static_cast<std::uint64_t>(number);
  for (const std::size_t half : {std::size_t{0}, std::size_t{1}}) {
    const auto word = static_cast<std::uint32_t>(half == 0 ? bits >> 32U : bits);
    std::memcpy(&(*packet)[data.at + kNumber + 4 * half], &word, sizeof word);
  }
}

std::size_t BeaconAt(const Heard& beacon) { return beacon.at + kSample; }

std::optional<std::uint32_t> BeaconOf(const Heard& heard) {
  const PacketBytes& bytes = heard.packet->bytes;
  const bool fits = heard.kind == kData && LengthAt(bytes, heard.at) == 20 + kBeaconBytes;
  if (!fits) return std::nullopt;
  const std::uint8_t* const fields = &bytes[BeaconAt(heard) + kEncapsulation];
  const std::size_t end = kBeaconBytes - kEncapsulation;
  boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true> sum;
  sum.process_bytes(fields, kHead);
  sum.process_bytes(fields + kHead + kPadding, end - kHead - kPadding - kSum);
  if (sum.checksum() != NumberAt(bytes, BeaconAt(heard) + kBeaconBytes - kSum)) return std::nullopt;
  return NumberAt(bytes, BeaconAt(heard) + kEncapsulation);
}

std::vector<Heard> BeaconsOf(std::uint32_t vehicle, const std::vector<Packet>& captured) {
  std::vector<Heard> all;
  for (const Packet& packet : captured) FindHeard(packet, &all);
  std::erase_if(all, [vehicle](const Heard& heard) { return BeaconOf(heard) != vehicle; });
  // Another intruder may impersonate the vehicle, but publishes less often than the vehicle itself.
  std::map<PrefixBytes, std::size_t> times;
  for (const Heard& heard : all) ++times[heard.prefix];
  const auto most = std::ranges::max_element(times, {}, [](const auto& by) { return by.second; });
  std::erase_if(all, [&](const Heard& heard) { return heard.prefix != most->first; });
  return all;
}

std::vector<Place> PlacesOf(std::uint32_t vehicle, const std::vector<Packet>& captured) {
  std::vector<Place> places;
  const std::vector<Heard> beacons = BeaconsOf(vehicle, captured);
  if (beacons.empty()) return places;
  for (const Packet& packet : captured) {
    if (!IsTo(beacons.back().prefix, packet)) continue;
    AddPlace({packet.to, packet.port}, &places);
    // RTPS 2.3, 9.6.1.1: ports of discovery are even, and those of samples the next higher.
    AddPlace({packet.to, static_cast<std::uint16_t>(packet.port ^ 1U)}, &places);
  }
  return places;
}

std::vector<Place> PlacesOfAll(const std::vector<Packet>& captured) {
  std::vector<Place> places;
  for (const Packet& packet : captured) AddPlace({packet.to, packet.port}, &places);
  return places;
}

}  // namespace giveway::attack
