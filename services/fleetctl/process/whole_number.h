// Parses a text that is a whole number and nothing else.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace giveway::fleetctl {

// nullopt for any other text: empty, with spaces, out of the type's range.
template <typename Number>
std::optional<Number> WholeNumber(std::string_view text, int base = 10) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number, base);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return number;
}

}  // namespace giveway::fleetctl
