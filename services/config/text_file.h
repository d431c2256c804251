// Reads a text file that came from outside. Refuses what cannot be one before anyone parses it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace giveway {

inline constexpr std::uintmax_t kMaxFileBytes = 8U << 20;
inline constexpr int kMaxNesting = 32;  // our schemas need 4

// The whole file. Throws InputError for what is absent, no regular file, unreadable, empty, larger
// than `most_bytes` (not read), or not UTF-8 text, or nests deeper than kMaxNesting.
std::string ReadTextFile(const std::string& path, std::uintmax_t most_bytes = kMaxFileBytes);

// The same of any bytes: what they are is for the caller to judge.
std::string ReadBytes(const std::string& path, std::uintmax_t most_bytes = kMaxFileBytes);

// The first line (from 1) on which brackets of protobuf text nest deeper than kMaxNesting; 0 if
// none does. Strings and comments do not count.
int LineNestedTooDeep(std::string_view text);

}  // namespace giveway
