// The parameter list that a discovery writer sends as its payload: what a participant, or one of
// its endpoints, says of itself. Whether the list ends where its payload ends, and the numbers and
// lengths that parameters state fit into them: Fast DDS takes memory for what is stated before it
// looks whether it is there. Formats: OMG RTPS 2.3, 9.6.2.2; DDS-Security 1.1, 7.2.
//
// What a list says is not judged here (but a participant's name and lease, and an endpoint's name,
// must be read alike by this filter and by Fast DDS), and neither what DDS-Security encrypts.
// Descriptions of types the library decodes without checking the lengths in them (CVE-2026-49863),
// and in a fleet types go by their names: they are hidden from it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "services/link/packet_filter/rtps_bytes.h"
#include "services/types/figures/packet_counters.h"

namespace giveway::link {

// What an endpoint or a participant says of itself: a vehicle's take some 600 bytes, and have one
// partition each. The library keeps all of it, and this program some. Types are described at
// length.
inline constexpr std::size_t kMostListed = 8192;  // bytes, without descriptions of types
inline constexpr std::size_t kMostDescribed = 16'384;
inline constexpr std::uint32_t kMostPartitions = 64;

// Whether a submessage that is sound by itself (submessage_check.h) is of a discovery writer, whole
// or a part.
bool IsOfDiscovery(const Submessage& submessage);

// kNone if the list of one that is, is sound. `secured`: DDS-Security is on, and so lists may hold
// tokens.
PacketDrop CheckDiscovery(const Submessage& of_discovery, bool secured);

// Makes of each description of a type in the lists of a packet that was found sound a parameter
// that is passed over.
void HideTypes(std::span<std::uint8_t> packet);

}  // namespace giveway::link
