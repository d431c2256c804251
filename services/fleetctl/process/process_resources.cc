#include "services/fleetctl/process/process_resources.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

#include "services/runtime/whole_file.h"

namespace giveway::fleetctl {
namespace {

// The value of "\nKEY:   1234 kB"; 0 if there is none, as for a process that has just ended.
std::uint64_t NumberOf(std::string_view status, std::string_view key) {
  const std::size_t at = status.find("\n" + std::string(key) + ":");
  if (at == std::string_view::npos) return 0;
  return std::strtoull(std::string(status.substr(at + key.size() + 2, 40)).c_str(), nullptr, 10);
}

}  // namespace

// utime and stime are fields 14 and 15; the name, field 2, may contain anything and ends with the
// last ')'.
std::optional<ProcessResources> ParseResources(std::string_view stat, std::string_view status,
                                               double ticks_per_second) {
  const std::size_t name_end = stat.rfind(')');
  if (name_end == std::string_view::npos) return std::nullopt;
  std::istringstream fields{std::string(stat.substr(name_end + 1))};
  std::string skipped;
  for (int field = 3; field < 14; ++field) fields >> skipped;
  double user = 0;
  double system = 0;
  if (!(fields >> user >> system)) return std::nullopt;
  constexpr std::uint64_t kKilobyte = 1024;
  return ProcessResources{.cpu_s = (user + system) / ticks_per_second,
                          .resident_bytes = NumberOf(status, "VmRSS") * kKilobyte,
                          .private_bytes = NumberOf(status, "RssAnon") * kKilobyte,
                          .threads = static_cast<std::uint32_t>(NumberOf(status, "Threads"))};
}

std::optional<ProcessResources> ReadResources(pid_t pid) {
  const std::filesystem::path folder = "/proc/" + std::to_string(pid);
  std::optional<ProcessResources> resources = ParseResources(
      ReadWholeFile(folder / "stat").value_or(""), ReadWholeFile(folder / "status").value_or(""),
      static_cast<double>(::sysconf(_SC_CLK_TCK)));
  if (!resources) return std::nullopt;
  std::error_code gone;
  for (std::filesystem::directory_iterator entry(folder / "fd", gone), end; !gone && entry != end;
       entry.increment(gone)) {
    ++resources->descriptors;
  }
  return resources;
}

double OwnProcessorSeconds() {
  rusage own{};
  ::getrusage(RUSAGE_SELF, &own);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
  };
  return seconds(own.ru_utime) + seconds(own.ru_stime);
}

}  // namespace giveway::fleetctl
