// Which participant an endpoint is of. What a participant may say is bound to it: the first twelve
// bytes of the GUID of each of its endpoints are the same, and no others have them.
#pragma once

#include <cstdint>

#include "services/link/fastdds/writer_names.h"

namespace giveway::link {

// 64 bits that stand for all endpoints of a participant; never 0. See Identity.
inline std::uint64_t ParticipantOf(const rtps::GUID_t& endpoint) {
  rtps::GUID_t participant;
  participant.guidPrefix = endpoint.guidPrefix;
  return Identity(participant);
}

// "010f45d2a3b1000001000000".
inline std::string ParticipantName(const rtps::GUID_t& endpoint) {
  std::array<std::uint8_t, 16> guid{};
  std::copy_n(endpoint.guidPrefix.value, 12, guid.begin());
  return ParticipantText(guid);
}

}  // namespace giveway::link
