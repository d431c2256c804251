// What the packet filter of a process made of the packets that reached its sockets: how many it
// handed on to the library, and how many it dropped, by reason. Values only, counted
// by services/link.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace giveway {

enum class PacketDrop : std::uint8_t {
  kNone,              // handed on
  kForeignSource,     // from an address that a fleet on loopback does not hear
  kNotRtps,           // too short, no RTPS header, or another major version
  kUnknownKind,       // a submessage of a kind that no sender of a fleet uses
  kStatistics,        // the library's own vendor-specific submessage, not as the library writes it
  kMalformed,         // a submessage that contradicts itself, or says what no sender says
  kListTooLong,       // a list or a submessage that ends beyond what holds it
  kSampleTooLarge,    // a fragment of a sample larger than the largest type
  kRangeTooLong,      // a GAP of more sequence numbers than any writer keeps
  kSequenceJump,      // a sequence number beyond what the writer's rate allows
  kTooManyStrangers,  // announcements of new participants, faster than a fleet grows
  kFragmentedAnnouncement,  // a part of an announcement that its sender did not send in one piece
  kTooManyEndpoints         // announcements of endpoints, more than participants of a fleet have
};
inline constexpr std::size_t kPacketDrops = 13;  // kNone included

// As in metrics and in the log: "sequence_jump".
constexpr std::string_view Name(PacketDrop drop) {
  switch (drop) {
    case PacketDrop::kNone:
      return "none";
    case PacketDrop::kForeignSource:
      return "foreign_source";
    case PacketDrop::kNotRtps:
      return "not_rtps";
    case PacketDrop::kUnknownKind:
      return "unknown_kind";
    case PacketDrop::kStatistics:
      return "statistics";
    case PacketDrop::kMalformed:
      return "malformed";
    case PacketDrop::kListTooLong:
      return "list_too_long";
    case PacketDrop::kSampleTooLarge:
      return "sample_too_large";
    case PacketDrop::kRangeTooLong:
      return "range_too_long";
    case PacketDrop::kSequenceJump:
      return "sequence_jump";
    case PacketDrop::kTooManyStrangers:
      return "too_many_strangers";
    case PacketDrop::kFragmentedAnnouncement:
      return "fragmented_announcement";
    case PacketDrop::kTooManyEndpoints:
      return "too_many_endpoints";
  }
  return "unknown";
}

struct PacketCounters {
  // By PacketDrop; those of kNone were handed on.
  std::array<std::uint64_t, kPacketDrops> packets{};

  std::uint64_t Of(PacketDrop drop) const { return packets[static_cast<std::size_t>(drop)]; }
  std::uint64_t Dropped() const {
    std::uint64_t sum = 0;
    for (std::size_t i = 1; i < kPacketDrops; ++i) sum += packets[i];
    return sum;
  }

  friend bool operator==(const PacketCounters&, const PacketCounters&) = default;
};

}  // namespace giveway
