// What a service that restarts itself hands on to itself, and its bytes: those of a recording's
// schema, with a version and a checksum of their own.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "services/types/fleet_facts.h"
#include "services/types/handover.h"

namespace giveway {

// The world knows it by its session, the operator by the order, and its
// brain continues from the handover.
struct Resumed {
  SessionId session{};
  std::uint64_t order = 0;
  std::optional<Handover> handover;  // none: it had no place yet

  friend bool operator==(const Resumed&, const Resumed&) = default;
};

// Bytes with a version and a checksum. Nothing where they are not exactly what ToBytes made, or
// hold what no brain can continue from.
std::string ToBytes(const Resumed& resumed);
std::optional<Resumed> ResumedFrom(std::string_view bytes);

}  // namespace giveway
