#include "services/auth/digest.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <string>

#include "services/types/check.h"

namespace giveway::auth {
namespace {

const std::uint8_t* BytesOf(std::string_view text) {
  return reinterpret_cast<const std::uint8_t*>(text.data());
}

}  // namespace

Digest Sha256(std::string_view bytes) {
  Digest digest{};
  unsigned size = 0;
  const int done =
      EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr);
  GIVEWAY_CHECK(done == 1 && size == digest.size(), size);
  return digest;
}

Digest HmacSha256(std::string_view key, std::string_view bytes) {
  Digest digest{};
  unsigned size = 0;
  const auto* const made = HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()),
                                BytesOf(bytes), bytes.size(), digest.data(), &size);
  GIVEWAY_CHECK(made != nullptr && size == digest.size(), size);
  return digest;
}

bool AreEqual(const Digest& a, const Digest& b) {
  return CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

SessionId SessionOf(const SessionId& secret) {
  std::string bytes;
  for (const std::uint32_t number : secret) {
    for (unsigned i = 0; i < 4; ++i) bytes.push_back(static_cast<char>(number >> (8 * i)));
  }
  const Digest digest = Sha256(bytes);
  SessionId session{};
  for (std::size_t i = 0; i < 16; ++i) {
    session[i / 4] |= static_cast<std::uint32_t>(digest[i]) << (8 * (i % 4));
  }
  return session;
}

}  // namespace giveway::auth
