// LZ4 frames, as MCAP compresses its chunks. Bytes in, bytes out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace giveway::mcap {

// Nothing if the library fails, which leaves the bytes to be written as they are.
std::optional<std::string> ToLz4Frame(std::string_view bytes);
// Nothing unless it is one whole frame of exactly `size` bytes.
std::optional<std::string> FromLz4Frame(std::string_view frame, std::uint64_t size);

}  // namespace giveway::mcap
