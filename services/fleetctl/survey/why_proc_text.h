// What the files of /proc say, as values: text in, facts out. See proc(5).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/fleetctl/survey/why_situation.h"

namespace giveway::fleetctl {

// Of cmdline and environ: words that each end with a zero byte.
std::vector<std::string> ZeroEnded(std::string_view text);

struct StatFacts {
  char state = '?';
  std::uint64_t start_ticks = 0;  // since the machine's start
};
std::optional<StatFacts> ParseStat(std::string_view text);

// The seconds since 1970 at which the machine started, of /proc/stat.
std::optional<std::uint64_t> ParseBootTime(std::string_view text);
// The process id in the innermost namespace, of status; absent from old kernels.
std::optional<int> ParseInnerPid(std::string_view status);
// The soft limit on open files, of limits; absent if unlimited.
std::optional<std::uint64_t> ParseOpenFilesLimit(std::string_view limits);
// Of a link in ns/ or fd/: "net:[4026531840]", "socket:[12345]".
std::optional<std::uint64_t> ParseBracketed(std::string_view link, std::string_view kind);
// The file behind a line of maps; absent for memory of no file.
std::optional<FileIdentity> ParseMapped(std::string_view line);
// The local port of each UDP socket, by inode, of net/udp or net/udp6.
std::map<std::uint64_t, std::uint16_t> ParseUdp(std::string_view text);
// Of net/fib_trie (which addresses are local), net/route (which network is at which interface) and
// net/dev (their order). Addresses come in the order of interfaces, as the library finds them.
std::vector<NetworkAddress> ParseAddresses(std::string_view fib_trie, std::string_view route,
                                           std::string_view dev);

}  // namespace giveway::fleetctl
