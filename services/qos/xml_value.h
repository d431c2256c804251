// What the text of an element means to the library. Fast DDS 2.9 and 3.1 leave numbers and flags to
// tinyxml2, and so does this: blanks and a sign before the digits, and 0x4, are read; what follows
// the digits is dropped silently.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "services/qos/xml_tree.h"

namespace giveway::qos {

enum class NumberKind : std::uint8_t { kSigned, kUnsigned };  // of 32 bits both

struct Number {
  std::int64_t value = 0;  // as the library takes it
  bool exact = true;       // false: the text says something else, as "150ms" and "5000000000" do
};

// Nothing where the library reads no number. -1 without a sign is the largest number, and exact.
std::optional<Number> ReadNumber(const std::string& text, NumberKind kind);

std::optional<bool> ReadFlag(const std::string& text);

// Nanoseconds, or kInfinite; nothing where no process can live with it.
std::optional<std::int64_t> ReadDuration(const XmlElement& element);

// Whether the text is one of the library's names for an infinite duration.
bool IsInfinite(std::string_view text);

}  // namespace giveway::qos
