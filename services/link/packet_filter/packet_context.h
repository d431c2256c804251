// What the header and the submessages before one say of it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "services/link/packet_filter/rtps_bytes.h"

namespace giveway::link {

struct PacketContext {
  explicit PacketContext(Bytes packet) : source(packet.data() + kSenderAt) {}

  // Of each submessage of a packet in turn, found sound before.
  void Note(const Submessage& submessage) {
    constexpr std::size_t kPrefixInInfoSrc = 8;
    if (submessage.kind == SubmessageKind::kInfoSrc) {
      source = submessage.body.data() + kPrefixInInfoSrc;
    } else if (submessage.kind == SubmessageKind::kInfoDst) {
      std::copy_n(submessage.body.begin(), destination.size(), destination.begin());
    } else if (submessage.kind == SubmessageKind::kInfoTs) {
      constexpr std::uint8_t kInvalidate = 0x02;
      time = submessage.Has(kInvalidate) ? std::nullopt : std::optional(submessage);
    }
  }
  PrefixBytes Source() const {
    PrefixBytes prefix;
    std::copy_n(source, prefix.size(), prefix.begin());
    return prefix;
  }

  const std::uint8_t* source;      // prefix, in the packet
  PrefixBytes destination{};       // of INFO_DST; all 0: none is named
  std::optional<Submessage> time;  // INFO_TS
};

}  // namespace giveway::link
