#include "services/types/nearest_name.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace giveway {
namespace {

constexpr std::size_t kMostCompared = 64;  // of one that is compared
constexpr std::size_t kLeastPrefixLetters = 3;

}  // namespace

std::size_t EditDistance(std::string_view a, std::string_view b) {
  // Of the first i letters of `a` to the first j of `b`; the rows of i, i - 1 and i - 2.
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  std::vector<std::size_t> before;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    const std::vector<std::size_t> two_before = std::exchange(before, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = before[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({changed, before[j] + 1, row[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], two_before[j - 2] + 1);
    }
  }
  return row.back();
}

std::optional<std::string> NearestName(std::string_view typed,
                                       const std::vector<std::string>& names) {
  typed = typed.substr(0, kMostCompared);
  const auto prefixed = std::ranges::find_if(names, [&](const std::string& name) {
    return typed.size() >= kLeastPrefixLetters && name.starts_with(typed);
  });
  if (prefixed != names.end()) return *prefixed;
  std::optional<std::string> nearest;
  std::size_t least = 0;
  for (const std::string& name : names) {
    const std::size_t distance = EditDistance(typed, name);
    if (distance * 3 > std::max(typed.size(), name.size())) continue;
    if (nearest && distance >= least) continue;
    nearest = name;
    least = distance;
  }
  return nearest;
}

std::string DidYouMean(std::string_view typed, const std::vector<std::string>& names) {
  const auto nearest = NearestName(typed, names);
  return nearest ? "; did you mean '" + *nearest + "'?" : "";
}

}  // namespace giveway
