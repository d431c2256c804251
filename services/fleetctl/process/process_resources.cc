#include "services/fleetctl/process/process_resources.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <charconv>
#include <filesystem>
#include <string>
#include <vector>

#include "services/runtime/whole_file.h"

namespace giveway::fleetctl {
namespace {

// The numbers of a text, up to the first word that is none.
std::vector<std::int64_t> NumbersOf(std::string_view text) {
  std::vector<std::int64_t> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    while (at != end && *at == ' ') ++at;
    std::int64_t number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc{}) return numbers;
    numbers.push_back(number);
    at = next;
  }
}

// Of a folder in /proc: Linux says how many since 6.2.
std::uint32_t DescriptorsIn(const std::string& folder) {
  struct stat there {};
  if (::stat(folder.c_str(), &there) == 0 && there.st_size > 0) {
    return static_cast<std::uint32_t>(there.st_size);
  }
  std::uint32_t descriptors = 0;
  std::error_code gone;
  for (std::filesystem::directory_iterator entry(folder, gone), end; !gone && entry != end;
       entry.increment(gone)) {
    ++descriptors;
  }
  return descriptors;
}

}  // namespace

// Of stat, utime and stime are fields 14 and 15, the threads 20; the name, field 2, may contain
// anything and ends with the last ')', and field 3 is a letter. Of statm, what is resident is the
// second number, and of that in files or shared memory the third.
std::optional<ProcessResources> ParseResources(std::string_view stat, std::string_view statm,
                                               const MachineUnits& units) {
  const std::size_t name_end = stat.rfind(')');
  if (name_end == std::string_view::npos || stat.size() < name_end + 4) return std::nullopt;
  const std::vector<std::int64_t> fields = NumbersOf(stat.substr(name_end + 4));
  constexpr std::size_t kFirst = 4;
  if (fields.size() <= 20 - kFirst) return std::nullopt;
  ProcessResources resources{
      .cpu_s = static_cast<double>(fields[14 - kFirst] + fields[15 - kFirst]) / units.ticks_per_s,
      .threads = static_cast<std::uint32_t>(fields[20 - kFirst])};
  const std::vector<std::int64_t> pages = NumbersOf(statm);
  if (pages.size() < 3) return resources;  // it has just ended
  resources.resident_bytes = static_cast<std::uint64_t>(pages[1]) * units.page_bytes;
  resources.private_bytes = static_cast<std::uint64_t>(pages[1] - pages[2]) * units.page_bytes;
  return resources;
}

std::optional<ProcessResources> ReadResources(pid_t pid) {
  static const MachineUnits units{static_cast<double>(::sysconf(_SC_CLK_TCK)),
                                  static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE))};
  const std::string folder = "/proc/" + std::to_string(pid);
  std::optional<ProcessResources> resources =
      ParseResources(ReadWholeFile(folder + "/stat").value_or(""),
                     ReadWholeFile(folder + "/statm").value_or(""), units);
  if (resources) resources->descriptors = DescriptorsIn(folder + "/fd");
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
