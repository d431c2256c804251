// CRC-32C (Castagnoli): reflected, initial value and final xor 0xffffffff. "123456789" gives
// 0xe3069283.
#pragma once

#include <cstdint>
#include <span>

namespace giveway::link {

// By the processor's instruction where it has one.
std::uint32_t Crc32c(std::span<const std::uint8_t> bytes);
// The same value everywhere, by table.
std::uint32_t PortableCrc32c(std::span<const std::uint8_t> bytes);

}  // namespace giveway::link
