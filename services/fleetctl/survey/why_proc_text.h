// Parses the files of /proc: text in, facts out. See proc(5).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/fleetctl/survey/why_situation.h"

namespace giveway::fleetctl {

// From cmdline and environ: words that each end with a zero byte.
std::vector<std::string> ZeroEnded(std::string_view text);

struct StatFacts {
  char state = '?';
  std::uint64_t start_ticks = 0;  // since the machine's start
};
std::optional<StatFacts> ParseStat(std::string_view text);

// The start of the machine in seconds since 1970, from /proc/stat.
std::optional<std::uint64_t> ParseBootTime(std::string_view text);
// The process id in the innermost namespace, from status; absent from old kernels.
std::optional<int> ParseInnerPid(std::string_view status);
// The soft limit on open files, from limits; absent if unlimited.
std::optional<std::uint64_t> ParseOpenFilesLimit(std::string_view limits);
// From a link in ns/ or fd/: "net:[4026531840]", "socket:[12345]".
std::optional<std::uint64_t> ParseBracketed(std::string_view link, std::string_view kind);
// The file in a line of maps; absent for anonymous memory.
std::optional<FileIdentity> ParseMapped(std::string_view line);
// The local port of each UDP socket, by inode, from net/udp or net/udp6.
std::map<std::uint64_t, std::uint16_t> ParseUdp(std::string_view text);
// From net/fib_trie (local addresses), net/route (the network of each interface) and net/dev (their
// order). Addresses are in the order of interfaces, as the library finds them.
std::vector<NetworkAddress> ParseAddresses(std::string_view fib_trie, std::string_view route,
                                           std::string_view dev);

}  // namespace giveway::fleetctl
