// JSON as this project writes and reads it, on nlohmann-json: keys in the order in which they were
// added, one line. The values are the library's own; a file that makes or reads one includes
// <nlohmann/json.hpp>, which costs a second of compile time, and a header includes this one.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace giveway {

using Json = nlohmann::ordered_json;

// Of an object what does not exist is left out: null, and a number that is not finite. A whole
// number is written without a fraction, whatever type it has here. Bytes that are not UTF-8 become
// U+FFFD.
std::string JsonText(Json json);

// Nothing if the text is not JSON, or is nested deeper than kMostJsonDepth.
inline constexpr int kMostJsonDepth = 64;
std::optional<Json> ReadJson(std::string_view text);

// Throws std::range_error unless it is a whole number of 0 to 2^32 - 1.
std::uint32_t Uint32Of(const Json& json);

// Null for nothing: left out of an object.
template <typename Value, typename Result = Json>
Result OrNull(const std::optional<Value>& value) {
  return value ? Result(*value) : Result();
}

// `of` gives each item's JSON.
template <typename Items, typename Of, typename Array = Json>
Array JsonArray(const Items& items, Of&& of) {
  Array array = Array::array();
  for (const auto& item : items) array.push_back(std::invoke(of, item));
  return array;
}

}  // namespace giveway
