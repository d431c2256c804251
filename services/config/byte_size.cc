#include "services/config/byte_size.h"

#include <array>
#include <charconv>
#include <limits>
#include <utility>

namespace giveway {
namespace {

constexpr std::array<std::pair<std::string_view, std::uint64_t>, 8> kUnits{{{"", 1},
                                                                            {"B", 1},
                                                                            {"kB", 1'000},
                                                                            {"MB", 1'000'000},
                                                                            {"GB", 1'000'000'000},
                                                                            {"KiB", 1U << 10U},
                                                                            {"MiB", 1U << 20U},
                                                                            {"GiB", 1U << 30U}}};

}  // namespace

std::optional<std::uint64_t> ParseByteSize(std::string_view text) {
  std::uint64_t count = 0;
  const auto read = std::from_chars(text.begin(), text.end(), count);
  if (read.ec != std::errc()) return std::nullopt;
  const std::string_view unit = text.substr(static_cast<std::size_t>(read.ptr - text.begin()));
  for (const auto& [name, bytes] : kUnits) {
    if (unit != name) continue;
    if (count > std::numeric_limits<std::uint64_t>::max() / bytes) return std::nullopt;
    return count * bytes;
  }
  return std::nullopt;
}

}  // namespace giveway
