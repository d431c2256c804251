// Conversion between a soak's result and the message of idl/soak.proto.
#pragma once

#include <string>

#include "services/fleetctl/soak/soak_result.h"
#include "soak.pb.h"

namespace giveway::fleetctl {

inline constexpr std::uint32_t kSoakFormat = 1;

// Numbers that JSON cannot represent are left at 0; text is made well-formed.
schema::SoakReport SchemaOf(const SoakResult& result);
// All complaints at once, field by field; empty: `result` is valid.
std::string ReadInto(const schema::SoakReport& message, SoakResult* result);

}  // namespace giveway::fleetctl
