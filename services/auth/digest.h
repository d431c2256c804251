// SHA-256 and HMAC-SHA256 by OpenSSL, and what of them stands for a session. Knows no DDS, no
// files.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "services/types/fleet_facts.h"

namespace giveway::auth {

using Digest = std::array<std::uint8_t, 32>;

Digest Sha256(std::string_view bytes);
Digest HmacSha256(std::string_view key, std::string_view bytes);
// Takes the same time wherever they differ.
bool AreEqual(const Digest& a, const Digest& b);

// The session that goes with a secret: the first 128 bits of the SHA-256 of its four numbers,
// each little-endian. The session is public; a participant that shows the secret made it.
SessionId SessionOf(const SessionId& secret);

}  // namespace giveway::auth
