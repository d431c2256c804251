// Which of some names was probably meant by a mistyped one: "did you mean". Pure.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace giveway {

// How many letters must be inserted, removed or changed, or neighbours swapped.
std::size_t EditDistance(std::string_view a, std::string_view b);

// The name that starts with `typed` (from three letters on), else the one at the least edit
// distance, where that is at most a third of the longer of both; none if every name is further.
// Of several the first.
std::optional<std::string> NearestName(std::string_view typed,
                                       const std::vector<std::string>& names);

// "; did you mean 'NAME'?", or nothing.
std::string DidYouMean(std::string_view typed, const std::vector<std::string>& names);

}  // namespace giveway
