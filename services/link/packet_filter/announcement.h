// The DATA by which a participant announces itself, and by which it says farewell: OMG RTPS 2.3,
// 8.5.3. Read and written here; whether its parts are sound is judged before, by
// submessage_check.h. And which endpoint the DATA of another discovery writer announces.
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

using EndpointGuid = std::array<std::uint8_t, 16>;
struct PrefixHash {
  std::size_t operator()(const PrefixBytes& prefix) const;
};
// Whose packet it is, by its header.
PrefixBytes SenderOf(Bytes packet);
// How long a participant may be silent at most, whatever it announces: the library is shown no
// longer lease.
inline constexpr std::chrono::seconds kLongestLease{120};
// A participant's GUID is its prefix, and this entity id.
inline constexpr std::array<std::uint8_t, 4> kParticipantEntity = {0x00, 0x00, 0x01, 0xc1};

// Whether a sound submessage is one of a participant's announcer.
bool IsAnnouncement(const Submessage& submessage);

// Whether it ends its participant, as Fast DDS sees it: by its inline QoS alone.
bool IsFarewell(const Submessage& announcement);

// Whether its name and its lease are what Fast DDS reads too. Of a parameter that stands twice the
// library takes the last, and the hash of a key it takes for the name; it knows participants by
// their whole GUID.
bool IsUnambiguous(const Submessage& announcement);

// The same of a list that announces an endpoint, which names it by its GUID, or the hash of its
// key, or by both.
bool NamesOneEndpoint(const Submessage& of_endpoint);
// The endpoint that it names; empty where it names none, or announces the end of one.
std::optional<EndpointGuid> AnnouncedEndpoint(const Submessage& of_endpoint);
// The participant that ends by a farewell; empty where it names none.
std::optional<PrefixBytes> EndedParticipant(const Submessage& farewell);
// The endpoint whose end it announces; empty where it announces none.
std::optional<EndpointGuid> EndedEndpoint(const Submessage& of_endpoint);

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
