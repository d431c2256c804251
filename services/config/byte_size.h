// Sizes of files as people write them: "64MiB", "500kB", "1000000".
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace giveway {

// A whole number and a unit: B or none, kB, MB, GB (powers of 1000), KiB, MiB, GiB (of 1024).
// Nothing for any other text, or for more than 64 bits hold.
std::optional<std::uint64_t> ParseByteSize(std::string_view text);

// What a recording may be split by: less is a file a second, more is none a year.
inline constexpr std::uint64_t kLeastSplitBytes = 64ULL << 10U;
inline constexpr std::uint64_t kMostSplitBytes = 1ULL << 40U;
inline constexpr const char* kSplitRemedy = "write a size from 64KiB to 1024GiB, such as 64MiB";

}  // namespace giveway
