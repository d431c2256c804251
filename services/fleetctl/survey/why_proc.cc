#include "services/fleetctl/survey/why_proc.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <set>

#include "services/config/config_dir.h"
#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/process/whole_number.h"
#include "services/fleetctl/survey/launch_options.h"
#include "services/fleetctl/survey/why_proc_text.h"
#include "services/qos/xml_tree.h"
#include "services/runtime/identity.h"
#include "services/runtime/whole_file.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> ReadLink(const fs::path& link) {
  std::error_code error;
  const fs::path to = fs::read_symlink(link, error);
  if (error) return std::nullopt;
  return to.string();
}

std::optional<Started> ReadAnyStarted(const fs::path& process) {
  const auto words = ReadWholeFile(process / "cmdline");
  if (!words || words->empty()) return std::nullopt;  // gone, or a zombie
  return Started{ZeroEnded(*words), ZeroEnded(ReadWholeFile(process / "environ").value_or(""))};
}

std::optional<Started> ReadStarted(const fs::path& process) {
  auto started = ReadAnyStarted(process);
  if (!started || (!started->IsVehicle() && !started->IsWorld())) return std::nullopt;
  return started;
}

struct OpenFiles {
  std::uint64_t count = 0;
  std::set<std::uint16_t> udp_ports;
};

// nullopt, and errno set, if they cannot be read.
std::optional<OpenFiles> ReadOpenFiles(const fs::path& process) {
  std::error_code error;
  fs::directory_iterator files(process / "fd", error);
  const auto udp = ReadWholeFile(process / "net/udp");
  if (error || !udp) {
    errno = error ? error.value() : errno;
    return std::nullopt;
  }
  const auto ports = ParseUdp(*udp);
  OpenFiles open;
  for (const fs::directory_entry& file : files) {
    ++open.count;
    const auto link = ReadLink(file.path());
    const auto inode = link ? ParseBracketed(*link, "socket") : std::nullopt;
    const auto port = inode ? ports.find(*inode) : ports.end();
    if (port != ports.end()) open.udp_ports.insert(port->second);
  }
  return open;
}

// Reads one process into a situation, fact by fact.
class Reading {
 public:
  Reading(const fs::path& proc, int pid, const Started& started)
      : proc_(proc), process_(proc / std::to_string(pid)), started_(started) {
    to_.pid = pid;
    to_.environment = started.environment;
    to_.launch = ReadLaunchOptions(started, &to_.not_known);
    if (auto identity = ReadIdentity(process_)) {
      to_.participant = std::move(identity->participant);
      if (identity->vehicle != kNoVehicle) to_.launch.id = identity->vehicle;
    }
    if (!ReadWholeFile(process_ / "environ")) NotKnown("environment");
  }

  ProcessSituation Read() {
    ReadState();
    ReadNamespaces();
    ReadNetwork();
    ReadFiles();
    ReadScenario();
    ReadProfiles();
    return std::move(to_);
  }

 private:
  void NotKnown(const std::string& what) {
    to_.not_known.push_back(what + ": " + std::strerror(errno == 0 ? ENOENT : errno));
  }
  void ReadState();
  void ReadNamespaces();
  bool IsUnplugged(const NetworkAddress& address) const;
  void ReadNetwork();
  void ReadFiles();
  void ReadScenario();
  void ReadProfiles();
  // Where to read a path of the process from here.
  fs::path Seen(const fs::path& path) const {
    // Profiles sent by an operator's order are held in the process itself, see
    // services/runtime/restart.h.
    if (IsHeld(path)) return process_ / "fd" / path.filename();
    return path.is_absolute() ? process_ / "root" / path.relative_path() : process_ / "cwd" / path;
  }
  static bool IsHeld(const fs::path& path) { return path.parent_path() == "/proc/self/fd"; }
  fs::path ConfigFolder() const;
  fs::path ProfilesNamed(const std::string& argument) const;

  const fs::path proc_;
  const fs::path process_;
  const Started& started_;
  ProcessSituation to_;
  std::optional<std::uint64_t> start_s_;  // since 1970
};

void Reading::ReadState() {
  const auto stat = ReadWholeFile(process_ / "stat");
  const auto facts = stat ? ParseStat(*stat) : std::nullopt;
  if (!facts) return NotKnown("state");
  to_.state = facts->state;
  const auto boot = ParseBootTime(ReadWholeFile(proc_ / "stat").value_or(""));
  if (boot)
    start_s_ = *boot + facts->start_ticks / static_cast<std::uint64_t>(sysconf(_SC_CLK_TCK));
}

void Reading::ReadNamespaces() {
  const auto read = [this](const char* kind, const char* name) {
    const auto link = ReadLink(process_ / "ns" / kind);
    const auto inode = link ? ParseBracketed(*link, kind) : std::nullopt;
    if (!inode) NotKnown(name);
    return inode;
  };
  to_.network_namespace = read("net", "network namespace");
  to_.ipc_namespace = read("ipc", "ipc namespace");
  to_.mount_namespace = read("mnt", "mount namespace");
  to_.pid_inside = ParseInnerPid(ReadWholeFile(process_ / "status").value_or("")).value_or(to_.pid);
  struct stat memory {};
  if (::stat((process_ / "root/dev/shm").c_str(), &memory) == 0) {
    to_.shared_memory = FileIdentity{memory.st_dev, memory.st_ino};
  } else {
    NotKnown("/dev/shm");
  }
}

// The library ignores interfaces that are up but not running, such as docker0 without a container:
// they have an address, but no carrier. If that cannot be read, it counts as running.
bool Reading::IsUnplugged(const NetworkAddress& address) const {
  if (address.interface.empty()) return false;
  const auto carrier =
      ReadWholeFile(process_ / "root/sys/class/net" / address.interface / "carrier");
  return carrier && carrier->starts_with('0');
}

void Reading::ReadNetwork() {
  const auto trie = ReadWholeFile(process_ / "net/fib_trie");
  const auto route = ReadWholeFile(process_ / "net/route");
  const auto dev = ReadWholeFile(process_ / "net/dev");
  if (trie && route && dev) {
    to_.addresses = ParseAddresses(*trie, *route, *dev);
    std::erase_if(*to_.addresses, [this](const NetworkAddress& one) { return IsUnplugged(one); });
  } else {
    NotKnown("addresses");
  }
}

void Reading::ReadFiles() {
  to_.open_files_limit = ParseOpenFilesLimit(ReadWholeFile(process_ / "limits").value_or(""));
  const auto open = ReadOpenFiles(process_);
  if (!open) return NotKnown("ports");
  to_.open_files = open->count;
  to_.ports.emplace(open->udp_ports.begin(), open->udp_ports.end());
}

// The folder in which the process finds its shipped files, as in services/config/config_dir.cc.
fs::path Reading::ConfigFolder() const {
  for (const std::string& variable : started_.environment) {
    if (variable.starts_with("GIVEWAY_CONFIG_DIR=")) return variable.substr(variable.find('=') + 1);
  }
  const fs::path bin = fs::path(ReadLink(process_ / "exe").value_or("")).parent_path();
  for (const char* folder : {"../share/giveway", "../../../config"}) {
    const fs::path config = (bin / folder).lexically_normal();
    std::error_code error;
    if (fs::is_directory(Seen(config / "scenarios"), error)) return config;
  }
  return {};
}

void Reading::ReadScenario() {
  if (to_.launch.scenario.empty()) return;
  fs::path file = Seen(to_.launch.scenario);
  if (!NamesFile(file)) {
    file = Seen(ConfigFolder() / "scenarios" / (to_.launch.scenario + ".textproto"));
  }
  if (!NamesFile(file)) {
    to_.not_known.push_back("scenario " + to_.launch.scenario + ": cannot be read");
    return;
  }
  const bool given = started_.Value("--impair").has_value();
  AddScenario(file, given, &to_.launch, &to_.not_known);
}

// A file, or the shipped set of that name, as in services/config/config_dir.cc.
fs::path Reading::ProfilesNamed(const std::string& argument) const {
  if (argument.find('/') != std::string::npos || argument.ends_with(".xml")) return argument;
  if (NamesFile(Seen(argument))) return argument;
  const fs::path shipped = ConfigFolder() / "qos" / (argument + ".xml");
  return NamesFile(Seen(shipped)) ? shipped : fs::path(argument);
}

void Reading::ReadProfiles() {
  if (to_.launch.qos_file.empty() && ConfigFolder().empty()) {
    to_.launch.qos_file = ResolveQosFile("");
    to_.not_known.push_back("profiles: their folder cannot be read; taken to be the default");
    return;
  }
  fs::path path = to_.launch.qos_file.empty() ? ConfigFolder() / "qos/default.xml"
                                              : ProfilesNamed(to_.launch.qos_file);
  const fs::path seen = Seen(path);
  const bool held = IsHeld(path);
  if (held) path = seen;
  if (path.is_relative()) path = fs::path(ReadLink(process_ / "cwd").value_or("")) / path;
  to_.launch.qos_file = path.lexically_normal().string();
  const auto read = ReadQosFile(seen.string());
  if (const auto* why = std::get_if<qos::Finding>(&read)) {
    to_.not_known.push_back("profiles " + to_.launch.qos_file + ": " + why->values);
    return;
  }
  const qos::XmlRead xml =
      qos::ReadXml(std::get<qos::ProfileFile>(read).bytes, to_.launch.qos_file);
  if (!xml.root) {
    to_.not_known.push_back("profiles " + to_.launch.qos_file + ": no XML");
    return;
  }
  to_.profiles = qos::ReadProfiles(*xml.root, to_.launch.qos_file);
  struct stat written {};
  if (start_s_ && !held && ::stat(seen.c_str(), &written) == 0) {
    // A second of tolerance: both are whole seconds.
    to_.profiles_changed = static_cast<std::uint64_t>(written.st_mtime) > *start_s_ + 1;
  }
}

}  // namespace

std::vector<int> ProcessIds(const fs::path& proc) {
  std::vector<int> pids;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(proc, error)) {
    if (const auto pid = WholeNumber<int>(entry.path().filename().string())) pids.push_back(*pid);
  }
  std::ranges::sort(pids);
  return pids;
}

std::vector<FleetMember> FindFleet(const fs::path& proc) {
  std::vector<FleetMember> members;
  for (const int pid : ProcessIds(proc)) {
    const auto started = ReadStarted(proc / std::to_string(pid));
    if (!started) continue;
    std::vector<std::string> ignored;
    const fs::path process = proc / std::to_string(pid);
    const LaunchOptions launch = ReadLaunchOptions(*started, &ignored);
    const auto identity = ReadIdentity(process);
    const bool given = identity && identity->vehicle != kNoVehicle;
    const auto network = ReadLink(process / "ns/net");
    members.push_back({pid, launch.is_world, given ? identity->vehicle : launch.id, launch.domain,
                       launch.interface, network ? ParseBracketed(*network, "net") : std::nullopt});
  }
  return members;
}

std::optional<std::vector<std::uint16_t>> PortsOfTools(const fs::path& proc) {
  std::set<std::uint16_t> ports;
  for (const int pid : ProcessIds(proc)) {
    const fs::path process = proc / std::to_string(pid);
    const auto started = ReadAnyStarted(process);
    if (!started || !started->IsTool()) continue;
    const auto open = ReadOpenFiles(process);
    std::error_code error;
    if (!open && fs::exists(process, error)) return std::nullopt;
    if (open) ports.insert(open->udp_ports.begin(), open->udp_ports.end());
  }
  return std::vector<std::uint16_t>(ports.begin(), ports.end());
}

std::optional<ProcessSituation> ReadSituation(const fs::path& proc, int pid) {
  const auto started = ReadStarted(proc / std::to_string(pid));
  if (!started) return std::nullopt;
  return Reading(proc, pid, *started).Read();
}

}  // namespace giveway::fleetctl
