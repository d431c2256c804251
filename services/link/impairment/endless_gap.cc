#include "services/link/impairment/endless_gap.h"

namespace giveway::link {
namespace {

// Of the RTPS wire protocol: the packet's header, and a submessage's: kind, flags, length.
constexpr std::size_t kHeader = 20;
constexpr std::size_t kSubmessageHeader = 4;
constexpr std::uint8_t kGap = 0x08;
constexpr std::uint8_t kLittleEndian = 0x01;
// A GAP's body: reader, writer, the first sample that will not come, the first that may.
constexpr std::size_t kFirst = 8;
constexpr std::size_t kBehind = 16;
constexpr std::size_t kShortestGap = 24;
constexpr std::uint64_t kLongest = 100'000;

using Bytes = std::span<const std::uint8_t>;

std::uint64_t Word(Bytes bytes, std::size_t at, std::size_t size, bool little_endian) {
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < size; ++i) {
    word = word << 8U | bytes[at + (little_endian ? size - 1 - i : i)];
  }
  return word;
}

// The high half stands first in either byte order.
std::uint64_t SequenceNumber(Bytes bytes, std::size_t at, bool little_endian) {
  return Word(bytes, at, 4, little_endian) << 32U | Word(bytes, at + 4, 4, little_endian);
}

bool IsEndless(Bytes gap, bool little_endian) {
  if (gap.size() < kShortestGap) return false;
  const auto first = static_cast<std::int64_t>(SequenceNumber(gap, kFirst, little_endian));
  const auto behind = static_cast<std::int64_t>(SequenceNumber(gap, kBehind, little_endian));
  return behind > first &&
         static_cast<std::uint64_t>(behind) - static_cast<std::uint64_t>(first) > kLongest;
}

}  // namespace

bool HasEndlessGap(Bytes packet) {
  if (packet.size() < kHeader) return false;
  packet = packet.subspan(kHeader);
  while (packet.size() >= kSubmessageHeader) {
    const std::uint8_t kind = packet[0];
    const bool little_endian = (packet[1] & kLittleEndian) != 0;
    std::size_t length = Word(packet, 2, 2, little_endian);
    packet = packet.subspan(kSubmessageHeader);
    // The last one may say 0 for all that is left.
    if (length == 0 || length > packet.size()) length = packet.size();
    if (kind == kGap && IsEndless(packet.first(length), little_endian)) return true;
    packet = packet.subspan(length);
  }
  return false;
}

}  // namespace giveway::link
