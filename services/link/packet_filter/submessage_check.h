// Whether one submessage is sound by itself: its fields fit each other and end where it ends. Knows
// nothing of what came before; see writer_table.h for that.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "services/link/packet_filter/rtps_bytes.h"
#include "services/types/figures/packet_counters.h"

namespace giveway::link {

// Sequence numbers a GAP may span at most. The library steps through them one by one under the
// locks that all receiving threads need, and keeps those behind a hole: CVE-2025-64438. These take
// it 10 ms. All GAPs of one packet together.
inline constexpr std::int64_t kLongestGap = 100'000;

// Samples that are smaller are sent whole: UDP carries 65 kB, and no profile or vendor limits
// messages to less than an Ethernet frame. Fragments are kept until their sample is complete.
inline constexpr std::uint32_t kLeastFragmented = 1024;  // bytes, encapsulation included

// Nor does one cut a sample into smaller fragments; the last one may be of a single byte. The
// library, which would write indexes over what is short (CVE-2025-62799), sees none of them:
// fragment_store.h.
inline constexpr std::uint16_t kLeastFragment = 512;

// What a DATA_FRAG says of its place in its sample.
struct Fragment {
  std::int64_t number = 0;  // of its sample
  std::uint32_t first = 0;  // from 1
  std::uint32_t count = 0;  // that stand in one submessage
  std::uint32_t sample_bytes = 0;
  std::uint16_t fragment_bytes = 0;  // of each but the last
};

// kNone if it is sound. `largest_sample` in bytes, encapsulation included.
PacketDrop CheckSubmessage(const Submessage& submessage, std::uint32_t largest_sample);

// Cuts off what the GAPs of a packet, sound but for that, span beyond kLongestGap: the library asks
// for the rest again.
void ShortenGaps(std::span<std::uint8_t> packet);

// Of a checked DATA_FRAG.
Fragment FragmentOf(const Submessage& frag);
struct InlineAndPayload {
  Bytes inline_qos;  // with its sentinel; empty: none
  Bytes payload;     // may be padded
};
InlineAndPayload PartsOfFragment(const Submessage& frag);

// Where in a DATA, checked before, its payload starts: behind the inline QoS.
std::size_t PayloadOfData(const Submessage& data);

// The parameter list that a checked DATA has as its payload, in the byte order that the
// encapsulation names. Nothing where there is none, or another encapsulation: Fast DDS reads no
// list then.
std::optional<Submessage> ParametersOf(const Submessage& data);

// What a checked parameter list holds under an id; empty if it has none. `list` starts with the
// first parameter.
Bytes FindParameter(const Submessage& submessage, std::size_t list, std::uint16_t id);

// The same of the inline QoS of a checked DATA.
Bytes FindInlineParameter(const Submessage& data, std::uint16_t id);

}  // namespace giveway::link
