#include "services/fleetctl/soak/verb/soak_origin.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <string_view>
#include <thread>

#include "services/fleetctl/output/shell_word.h"
#include "services/fleetctl/process/program_id.h"
#include "services/link/fastdds/library_release.h"

namespace giveway::fleetctl {
namespace {

// "2.9.1" of "Fast DDS 2.9.1".
std::string WithoutName(std::string_view library) {
  return std::string(library.substr(library.rfind(' ') + 1));
}

}  // namespace

std::string CommandLine(const SoakOptions& options) {
  std::string line = "fleetctl soak " + ShellWord(options.scenario);
  if (!options.faults.empty()) line += " --faults " + ShellWord(options.faults);
  line += fmt::format(" --duration {} --seed {} --report {}", options.duration_s, options.seed,
                      ShellWord(options.report_folder));
  const auto add = [&line](const char* flag, const std::string& value) {
    if (!value.empty()) line += fmt::format(" {} {}", flag, ShellWord(value));
  };
  const auto add_if = [&line](const char* flag, bool is_set) {
    if (is_set) line += fmt::format(" {}", flag);
  };
  if (options.vehicles) line += fmt::format(" --vehicles {}", *options.vehicles);
  add("--qos", options.qos_file);
  if (options.interface != SoakOptions().interface) add("--interface", options.interface);
  if (options.discovery_servers > 0) {
    line += fmt::format(" --discovery-servers {}", options.discovery_servers);
  }
  add("--attacker", options.attacker);
  add_if("--skip-unsupported", options.skip_unsupported);
  add_if("--record", options.record);
  add_if("--virtual", options.in_virtual_time);
  if (options.ring_s > 0) line += fmt::format(" --record-ring {}", options.ring_s);
  return line;
}

SoakVersions VersionsOf(const std::filesystem::path& program_folder, bool in_virtual_time) {
  SoakVersions versions;
  versions.programs.push_back({"fleetctl", ProgramId()});
  for (const char* const service : {"giveway-world", "giveway-vehicle"}) {
    if (!in_virtual_time)
      versions.programs.push_back({service, ProgramIdOf(program_folder / service)});
  }
  versions.fast_dds = WithoutName(link::LibraryName());
  utsname system{};
  if (::uname(&system) == 0) versions.kernel = system.release;
  versions.host_cores = std::thread::hardware_concurrency();
  return versions;
}

}  // namespace giveway::fleetctl
