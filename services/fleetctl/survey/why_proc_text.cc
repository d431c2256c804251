#include "services/fleetctl/survey/why_proc_text.h"

#include <sys/sysmacros.h>

#include <algorithm>
#include <bit>
#include <sstream>

#include "services/fleetctl/process/whole_number.h"

namespace giveway::fleetctl {
namespace {

constexpr std::uint32_t kLoopbackMask = 0xff000000U;

std::vector<std::string> Words(std::string_view line) {
  std::istringstream stream{std::string(line)};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::vector<std::string> Lines(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// The words of the first line that starts with `name`, without the name.
std::vector<std::string> WordsAfter(std::string_view text, std::string_view name) {
  for (const std::string& line : Lines(text)) {
    if (line.starts_with(name)) return Words(std::string_view(line).substr(name.size()));
  }
  return {};
}

std::optional<std::uint32_t> ParseAddress(std::string_view text) {
  std::uint32_t address = 0;
  for (int part = 0; part < 4; ++part) {
    const std::size_t end = part < 3 ? text.find('.') : text.size();
    if (end == std::string_view::npos) return std::nullopt;
    const auto number = WholeNumber<std::uint32_t>(text.substr(0, end));
    if (!number || *number > 255) return std::nullopt;
    address = address << 8U | *number;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return address;
}

struct Route {
  std::string interface;
  std::uint32_t network = 0;
  std::uint32_t mask = 0;
};

// /proc prints the bytes of an address as one number in host byte order.
std::uint32_t FromNetworkOrder(std::uint32_t printed) {
  if constexpr (std::endian::native == std::endian::big) return printed;
  return __builtin_bswap32(printed);
}

// Networks that are reached without a gateway, the narrowest first.
std::vector<Route> ParseRoutes(std::string_view text) {
  std::vector<Route> routes;
  for (const std::string& line : Lines(text)) {
    const auto words = Words(line);
    if (words.size() < 8) continue;
    const auto network = WholeNumber<std::uint32_t>(words[1], 16);
    const auto mask = WholeNumber<std::uint32_t>(words[7], 16);
    if (!network || !mask || *mask == 0 || words[2] != "00000000") continue;
    routes.push_back({words[0], FromNetworkOrder(*network), FromNetworkOrder(*mask)});
  }
  std::ranges::stable_sort(routes, std::greater<>{}, &Route::mask);
  return routes;
}

NetworkAddress Placed(std::uint32_t address, const std::vector<Route>& routes) {
  if (address >> 24U == 127) return {"lo", address, kLoopbackMask};
  for (const Route& route : routes) {
    if ((address & route.mask) == route.network) return {route.interface, address, route.mask};
  }
  return {"", address, 0xffffffffU};
}

// In the file's order; the first is the loopback.
std::vector<std::string> ParseInterfaces(std::string_view dev) {
  std::vector<std::string> names;
  for (const std::string& line : Lines(dev)) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || line.find('|') != std::string::npos) continue;
    const auto words = Words(line.substr(0, colon));
    if (words.size() == 1) names.push_back(words.front());
  }
  return names;
}

}  // namespace

std::vector<std::string> ZeroEnded(std::string_view text) {
  std::vector<std::string> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\0'), text.size());
    words.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

std::optional<StatFacts> ParseStat(std::string_view text) {
  // After the name, which may contain anything: state is the 3rd field, the start the 22nd.
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string_view::npos) return std::nullopt;
  const auto words = Words(text.substr(name_end + 1));
  if (words.size() < 20) return std::nullopt;
  const auto start = WholeNumber<std::uint64_t>(words[19]);
  if (!start) return std::nullopt;
  return StatFacts{words[0].front(), *start};
}

std::optional<std::uint64_t> ParseBootTime(std::string_view text) {
  const auto words = WordsAfter(text, "btime ");
  return words.empty() ? std::nullopt : WholeNumber<std::uint64_t>(words.front());
}

std::optional<int> ParseInnerPid(std::string_view status) {
  const auto words = WordsAfter(status, "NSpid:");
  return words.empty() ? std::nullopt : WholeNumber<int>(words.back());
}

std::optional<std::uint64_t> ParseOpenFilesLimit(std::string_view limits) {
  const auto words = WordsAfter(limits, "Max open files");
  return words.empty() ? std::nullopt : WholeNumber<std::uint64_t>(words.front());
}

std::optional<std::uint64_t> ParseBracketed(std::string_view link, std::string_view kind) {
  const std::string before = std::string(kind) + ":[";
  if (!link.starts_with(before) || !link.ends_with(']')) return std::nullopt;
  return WholeNumber<std::uint64_t>(link.substr(before.size(), link.size() - before.size() - 1));
}

std::optional<FileIdentity> ParseMapped(std::string_view line) {
  const auto words = Words(line);  // addresses, permissions, offset, device, inode, path
  if (words.size() < 5) return std::nullopt;
  const std::string_view device = words[3];
  const std::size_t colon = device.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto major = WholeNumber<unsigned>(device.substr(0, colon), 16);
  const auto minor = WholeNumber<unsigned>(device.substr(colon + 1), 16);
  const auto inode = WholeNumber<std::uint64_t>(words[4]);
  if (!major || !minor || !inode || *inode == 0) return std::nullopt;
  return FileIdentity{gnu_dev_makedev(*major, *minor), *inode};
}

std::map<std::uint64_t, std::uint16_t> ParseUdp(std::string_view text) {
  std::map<std::uint64_t, std::uint16_t> ports;
  for (const std::string& line : Lines(text)) {
    const auto words = Words(line);  // sl, local, remote, st, queues, tr, retr, uid, timeout, inode
    if (words.size() < 10 || words[1].find(':') == std::string::npos) continue;
    const auto port =
        WholeNumber<std::uint16_t>(std::string_view(words[1]).substr(words[1].find(':') + 1), 16);
    const auto inode = WholeNumber<std::uint64_t>(words[9]);
    if (port && inode) ports[*inode] = *port;
  }
  return ports;
}

std::vector<NetworkAddress> ParseAddresses(std::string_view fib_trie, std::string_view route,
                                           std::string_view dev) {
  const std::vector<Route> routes = ParseRoutes(route);
  std::vector<NetworkAddress> addresses;
  std::optional<std::uint32_t> leaf;
  for (const std::string& line : Lines(fib_trie)) {
    const auto words = Words(line);
    if (words.size() == 2 && words[0] == "|--") leaf = ParseAddress(words[1]);
    if (!leaf || words.size() != 3 || words[0] != "/32" || words[2] != "LOCAL") continue;
    const NetworkAddress placed = Placed(*leaf, routes);
    // The same table may be there twice.
    if (std::ranges::find(addresses, placed) == addresses.end()) addresses.push_back(placed);
  }
  const std::vector<std::string> order = ParseInterfaces(dev);
  std::ranges::stable_sort(addresses, {}, [&](const NetworkAddress& one) {
    return std::ranges::find(order, one.interface) - order.begin();
  });
  return addresses;
}

}  // namespace giveway::fleetctl
