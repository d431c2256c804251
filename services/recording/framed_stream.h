// Frames in a stream of bytes: each says how long it is and proves that it is whole. Distinguishes
// a stream that was cut off, as by the death of its writer, from a damaged one. Knows no contents.
//
// A frame is the payload's length, the payload's CRC-32C, the CRC-32C of those eight bytes (each
// four bytes, little-endian), and the payload. The head has a sum of its own because a wrong length
// would look like a cut.
#pragma once

#include <cstdint>
#include <istream>
#include <string>
#include <string_view>

namespace giveway {

inline constexpr std::uint32_t kMostPayloadBytes = 16U << 20U;

// The frame of a payload of at most kMostPayloadBytes.
std::string Framed(std::string_view payload);

enum class FrameEnd : std::uint8_t { kFrame, kEnd, kCutOff, kDamaged };

// Reads the next frame into `payload`: kFrame. Else there is none: kEnd where the stream ends
// between frames.
FrameEnd ReadFrame(std::istream& stream, std::string* payload);

}  // namespace giveway
