#include "services/fleetctl/doctor/doctor_read.h"

#include <fmt/format.h>
#include <sys/timex.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <iterator>
#include <set>
#include <sstream>
#include <thread>

#include "services/config/problem.h"
#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/doctor/memory_read.h"
#include "services/fleetctl/doctor/multicast_probe.h"
#include "services/fleetctl/output/finding_text.h"
#include "services/fleetctl/process/domain_lock.h"
#include "services/fleetctl/survey/why_proc.h"
#include "services/fleetctl/survey/why_proc_text.h"
#include "services/qos/xml_tree.h"
#include "services/runtime/whole_file.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

constexpr int kClockLooks = 20;
constexpr auto kBetweenLooks = std::chrono::milliseconds(10);
// A longer time between two readings of the monotonic clock means an interruption.
constexpr std::int64_t kLookNs = 50'000;

// A vehicle as it would be started now.
ProcessSituation Planned(const DoctorOptions& options) {
  ProcessSituation planned;
  planned.launch.interface = options.interface;
  planned.launch.discovery_servers = options.discovery_servers;
  planned.launch.qos_file = ResolveQosFile(options.qos);
  const auto read = ReadQosFile(planned.launch.qos_file);
  if (const auto* why = std::get_if<qos::Finding>(&read)) {
    throw InputError({{why->place.file, 0, "", "", why->values, why->remedy}});
  }
  const auto& file = std::get<qos::ProfileFile>(read);
  const qos::XmlRead xml = qos::ReadXml(file.bytes, file.name);
  if (!xml.root) {
    throw InputError({{file.name, 0, "", "", "is no XML", "fleetctl qos check says where"}});
  }
  planned.profiles = qos::ReadProfiles(*xml.root, file.name);
  return planned;
}

std::optional<std::string> ReadFact(const fs::path& file, HostFacts* host) {
  auto text = ReadWholeFile(file);
  if (!text) host->not_known.push_back(file.string() + ": " + std::strerror(errno));
  return text;
}

// "32768 60999", "9000-9249,9500".
std::vector<PortRange> ParseRanges(std::string text, char between) {
  std::ranges::replace(text, ',', '\n');
  std::istringstream lines(text);
  std::vector<PortRange> ranges;
  for (std::string line; std::getline(lines, line);) {
    if (between != ' ') std::ranges::replace(line, between, ' ');
    std::istringstream numbers(line);
    PortRange range;
    if (!(numbers >> range.first)) continue;
    if (!(numbers >> range.last)) range.last = range.first;
    ranges.push_back(range);
  }
  return ranges;
}

void ReadNetwork(const fs::path& proc, HostFacts* host) {
  if (const auto text = ReadFact(proc / "sys/net/core/rmem_max", host)) {
    std::int64_t most = 0;
    if (std::istringstream(*text) >> most) host->receive_buffer_max = most;
  }
  if (const auto text = ReadFact(proc / "sys/net/ipv4/ip_local_port_range", host)) {
    const auto ranges = ParseRanges(*text, '\t');
    if (!ranges.empty()) host->ephemeral = ranges.front();
  }
  if (const auto text = ReadFact(proc / "sys/net/ipv4/ip_local_reserved_ports", host)) {
    host->reserved = ParseRanges(*text, '-');
  }
}

std::optional<std::set<std::uint16_t>> ReadPorts(const fs::path& proc, HostFacts* host) {
  const auto udp = ReadFact(proc / "net/udp", host);
  if (!udp) return std::nullopt;
  std::set<std::uint16_t> ports;
  // A host without IPv6 has no such file.
  for (const std::string& text : {*udp, ReadWholeFile(proc / "net/udp6").value_or("")}) {
    for (const auto& [inode, port] : ParseUdp(text)) ports.insert(port);
  }
  return ports;
}

void ReadProcesses(const fs::path& proc, std::optional<std::uint32_t> domain, HostFacts* host) {
  for (const FleetMember& member : FindFleet(proc)) {
    if (domain && member.domain != *domain) continue;
    auto process = ReadSituation(proc, member.pid);
    if (!process) continue;  // it has ended meanwhile
    if (!process->not_known.empty()) {
      host->not_known.push_back(
          fmt::format("{}: {}", NameOf(*process), fmt::join(process->not_known, "; ")));
    }
    host->processes.push_back(std::move(*process));
  }
}

// The processes, and the ports that are taken: processes from before and after, because one that
// starts or ends meanwhile must not be mistaken for another program.
void ReadProcessesAndPorts(const fs::path& proc, std::optional<std::uint32_t> domain,
                           HostFacts* host) {
  const auto before = ReadPorts(proc, host);
  ReadProcesses(proc, domain, host);
  host->tool_ports = PortsOfTools(proc);
  if (!before) return;
  host->ports.emplace();
  std::ranges::set_intersection(*before, ReadPorts(proc, host).value_or(*before),
                                std::back_inserter(*host->ports));
}

// Where each runs; processes of one folder with the same environment once.
void ReadSurroundings(const fs::path& proc, HostFacts* host) {
  std::error_code error;
  host->surroundings.push_back(
      {fs::current_path(error).string(), "this shell", OwnEnvironment(), NamesIn(".")});
  for (const ProcessSituation& process : host->processes) {
    const fs::path folder = proc / std::to_string(process.pid) / "cwd";
    const std::string name = fs::read_symlink(folder, error).string();
    const bool known = std::ranges::any_of(host->surroundings, [&](const Surroundings& other) {
      return other.folder == name && other.environment == process.environment;
    });
    if (known) continue;
    host->surroundings.push_back({name, NameOf(process), process.environment, NamesIn(folder)});
  }
}

std::vector<std::uint32_t> DomainsOf(const DoctorOptions& options, const HostFacts& host) {
  if (options.domain) return {*options.domain};
  std::set<std::uint32_t> domains;
  for (const ProcessSituation& process : host.processes) {
    if (process.launch.domain != 0) domains.insert(process.launch.domain);
  }
  if (domains.empty()) domains.insert(kFirstDomain);
  return {domains.begin(), domains.end()};
}

std::int64_t NowNs(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

}  // namespace

HostFacts ReadHost(const DoctorOptions& options, const HostFolders& folders) {
  HostFacts host;
  host.planned = Planned(options);
  host.vehicles = options.vehicles;
  host.user = ::geteuid();
  ReadProcessesAndPorts(folders.proc, options.domain, &host);
  host.domains = DomainsOf(options, host);
  host.memory = ReadSharedMemory(folders.memory, folders.proc);
  if (host.memory.total_bytes == 0) {
    host.not_known.push_back(host.memory.folder + ": " + std::strerror(errno));
  }
  const auto unknown =
      std::ranges::count(GroupsOf(host.memory), MemoryState::kNotKnown, &MemoryGroup::state);
  if (unknown > 0) {
    host.not_known.push_back(fmt::format(
        "whether another process uses {}: only their owner and root may ask",
        Counted(static_cast<std::size_t>(unknown), "segment or port", "segments and ports")));
  }
  ReadNetwork(folders.proc, &host);
  if (const auto limits = ReadFact(folders.proc / "self/limits", &host)) {
    host.open_files_limit = ParseOpenFilesLimit(*limits);
  }
  ReadSurroundings(folders.proc, &host);
  return host;
}

std::vector<HostInterface> ReadInterfaces(const std::string& interface) {
  std::vector<HostInterface> interfaces;
  for (const link::Interface& one : link::Ipv4Interfaces()) {
    const bool meant = interface == "any" || interface == one.name || interface == one.address;
    interfaces.push_back({one, meant ? EchoesMulticast(one.address) : std::nullopt});
  }
  return interfaces;
}

ClockFacts ReadClock() {
  ClockFacts clock;
  const std::int64_t begun = NowNs(CLOCK_MONOTONIC);
  for (int look = 0; look < kClockLooks; ++look) {
    const std::int64_t before = NowNs(CLOCK_MONOTONIC);
    const std::int64_t wall = NowNs(CLOCK_REALTIME);
    const std::int64_t after = NowNs(CLOCK_MONOTONIC);
    if (after - before < kLookNs) clock.offsets_ns.push_back(wall - before);
    std::this_thread::sleep_for(kBetweenLooks);
  }
  clock.window_ns = NowNs(CLOCK_MONOTONIC) - begun;
  timex kernel{};
  if (::adjtimex(&kernel) >= 0) clock.synchronised = (kernel.status & STA_UNSYNC) == 0;
  return clock;
}

}  // namespace giveway::fleetctl
