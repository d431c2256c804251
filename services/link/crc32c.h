// CRC-32C (Castagnoli): reflected, initial value and final xor 0xffffffff. "123456789" gives
// 0xe3069283.
#pragma once

#include <cstdint>
#include <span>

namespace giveway::link {

std::uint32_t Crc32c(std::span<const std::uint8_t> bytes);

}  // namespace giveway::link
