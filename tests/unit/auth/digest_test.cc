#include "services/auth/digest.h"

#include <gmock/gmock.h>

#include <string>

namespace giveway::auth {
namespace {

std::string Hex(const Digest& digest) {
  std::string text;
  for (const std::uint8_t byte : digest) {
    text += "0123456789abcdef"[byte >> 4U];
    text += "0123456789abcdef"[byte & 15U];
  }
  return text;
}

// FIPS 180-4, "abc"; RFC 4231, case 2.
TEST(Digest, IsThatOfTheStandards) {
  EXPECT_EQ(Hex(Sha256("abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Hex(HmacSha256("Jefe", "what do ya want for nothing?")),
            "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");
}

// sha256sum of the bytes 01 00 00 00 02 00 00 00 03 00 00 00 04 00 00 00.
TEST(Digest, ASessionIsTheBeginningOfItsSecretsDigest) {
  EXPECT_EQ(SessionOf({1, 2, 3, 4}), (SessionId{0xeead97cf, 0x5be059db, 0xb4a273fd, 0x5788a8c2}));
  EXPECT_NE(SessionOf({1, 2, 3, 5}), SessionOf({1, 2, 3, 4}));
}

}  // namespace
}  // namespace giveway::auth
