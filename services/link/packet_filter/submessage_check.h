// Whether one submessage is sound by itself: its fields fit each other and end where it ends. Knows
// nothing of what came before; see writer_table.h for that.
#pragma once

#include <cstdint>
#include <optional>

#include "services/link/packet_filter/rtps_bytes.h"
#include "services/types/figures/packet_counters.h"

namespace giveway::link {

// Sequence numbers a GAP may span at most. The library steps through them one by one under the
// locks that all receiving threads need: CVE-2025-64438. These take it 10 ms.
inline constexpr std::int64_t kLongestGap = 100'000;

// Samples that are smaller are sent whole: UDP carries 65 kB, and no profile or vendor limits
// messages to less than an Ethernet frame. Readers keep fragments until their sample is complete.
inline constexpr std::uint32_t kLeastFragmented = 1024;  // bytes, encapsulation included

// kNone if it is sound. `largest_sample` in bytes, encapsulation included.
PacketDrop CheckSubmessage(const Submessage& submessage, std::uint32_t largest_sample);

// Where in a DATA, checked before, its payload starts: behind the inline QoS.
std::size_t PayloadOfData(const Submessage& data);

// The parameter list that a checked DATA has as its payload, in the byte order that the
// encapsulation names. Nothing where there is none, or another encapsulation: Fast DDS reads no
// list then.
std::optional<Submessage> ParametersOf(const Submessage& data);

// What a checked parameter list holds under an id; empty if it has none. `list` starts with the
// first parameter.
Bytes FindParameter(const Submessage& submessage, std::size_t list, std::uint16_t id);

}  // namespace giveway::link
