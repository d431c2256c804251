// The DATA by which a participant announces itself, and by which it says farewell: OMG RTPS 2.3,
// 8.5.3. Read and written here; whether its parts are sound is judged before, by
// submessage_check.h.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "services/link/packet_filter/rtps_bytes.h"
#include "services/types/time.h"

namespace giveway::link {

// A participant's GUID is its prefix, and this entity id.
using PrefixBytes = std::array<std::uint8_t, 12>;
struct PrefixHash {
  std::size_t operator()(const PrefixBytes& prefix) const;
};
// Whose packet it is, by its header.
PrefixBytes SenderOf(Bytes packet);
inline constexpr std::array<std::uint8_t, 4> kParticipantEntity = {0x00, 0x00, 0x01, 0xc1};

// Whether a sound submessage is one of a participant's announcer.
bool IsAnnouncement(const Submessage& submessage);

// Whether its name and its lease are what Fast DDS reads too. Of a parameter that stands twice the
// library takes the last, and the hash of a key it takes for the name; it knows participants by
// their whole GUID.
bool IsUnambiguous(const Submessage& announcement);

// The participant that it names; empty in a farewell, or where there is none.
std::optional<PrefixBytes> AnnouncedParticipant(const Submessage& announcement);
// How long it may be silent; empty in a farewell, or where there is none.
std::optional<Nanoseconds> AnnouncedLease(const Submessage& announcement);
// Makes each lease in a packet that was found sound `most` where it is longer, or endless.
void ShortenLeases(std::span<std::uint8_t> packet, std::chrono::seconds most);
std::int64_t AnnouncementNumber(const Submessage& announcement);

using Farewell = std::array<std::uint8_t, 76>;
// The packet by which a participant ends, with the number that follows its last announcement.
Farewell FarewellOf(const PrefixBytes& participant, std::int64_t number);

}  // namespace giveway::link
