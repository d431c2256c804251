#include "services/types/nearest_name.h"

#include <algorithm>
#include <numeric>

namespace giveway {
namespace {

constexpr std::size_t kLongestName = 64;  // of one that is compared
constexpr std::size_t kLeastPrefix = 3;

}  // namespace

std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::optional<std::string> NearestName(std::string_view typed,
                                       const std::vector<std::string>& names) {
  typed = typed.substr(0, kLongestName);
  const auto prefixed = std::ranges::find_if(names, [&](const std::string& name) {
    return typed.size() >= kLeastPrefix && name.starts_with(typed);
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
