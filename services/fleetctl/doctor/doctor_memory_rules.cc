// The rules of `fleetctl doctor` about shared memory.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "services/fleetctl/doctor/doctor_rules.h"
#include "services/fleetctl/output/finding_text.h"
#include "services/fleetctl/why/why_rules.h"
#include "services/qos/deployment.h"

namespace giveway::fleetctl {
namespace {

using qos::Severity;

constexpr std::size_t kNamesShown = 3;
constexpr std::int64_t kSegmentDefault = 549'408;  // of the library, measured
constexpr std::int64_t kSegmentExtra = 49'696;     // beyond segment_size, measured
constexpr std::int64_t kQueueDefault = 512;        // port_queue_capacity
constexpr std::int64_t kQueueCellBytes = 20;       // of a port's file, measured
constexpr std::int64_t kPortBytes = 42'176;        // without its queue, measured
constexpr std::int64_t kPortsEach = 2;             // of its own: discovery and data

std::string Megabytes(std::uint64_t bytes) {
  return fmt::format("{:.1f} MB", static_cast<double>(bytes) * 1e-6);
}

std::string Ago(std::int64_t seconds) {
  if (seconds < 120) return fmt::format("{} s", seconds);
  if (seconds < 7200) return fmt::format("{} min", seconds / 60);
  return fmt::format("{} h", seconds / 3600);
}

// "3 files of 2 segments and ports, 1.2 MB, the newest 5 min old: fastrtps_a, fastrtps_b".
std::string Summary(const std::vector<MemoryGroup>& groups) {
  std::size_t files = 0;
  std::uint64_t bytes = 0;
  std::int64_t newest_s = groups.front().files.front().age_s;
  std::string names;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    files += groups[i].files.size();
    bytes += groups[i].Bytes();
    for (const MemoryFile& file : groups[i].files) newest_s = std::min(newest_s, file.age_s);
    if (i < kNamesShown) names += (i == 0 ? "" : ", ") + groups[i].body;
  }
  if (groups.size() > kNamesShown) names += ", ...";
  return fmt::format("{} of {}, {}, the newest {} old: {}", Counted(files, "file"),
                     Counted(groups.size(), "segment or port", "segments and ports"),
                     Megabytes(bytes), Ago(newest_s), names);
}

void AddGroups(const HostFacts& host, MemoryState state, const char* rule, const char* consequence,
               const char* remedy, qos::Findings* findings) {
  std::vector<MemoryGroup> groups = GroupsOf(host.memory);
  std::erase_if(groups, [state](const MemoryGroup& group) { return group.state != state; });
  if (groups.empty()) return;
  findings->push_back({Severity::kWarning,
                       rule,
                       {host.memory.folder, 0},
                       "",
                       Summary(groups),
                       consequence,
                       remedy});
}

// Locks any user may open.
bool IsShut(const HostFacts& host, const MemoryFile& file) {
  return PartOf(file.name) != MemoryPart::kLock && !MayUse(host.user, file);
}

std::int64_t ElementOf(const qos::Transport& transport, const char* element,
                       std::int64_t otherwise) {
  const auto said = transport.numbers.find(element);
  return said == transport.numbers.end() ? otherwise : said->second.number;
}

// What one participant of the planned set takes; 0 if it takes none.
std::uint64_t BytesEach(const ProcessSituation& planned) {
  if (!UsesSharedMemory(planned)) return 0;
  for (const qos::Transport& transport : planned.profiles->transports) {
    if (transport.type != "SHM") continue;
    const std::int64_t size = ElementOf(transport, "segment_size", 0);
    const std::int64_t segment = size > 0 ? size + kSegmentExtra : kSegmentDefault;
    const std::int64_t queue = ElementOf(transport, "port_queue_capacity", kQueueDefault);
    return static_cast<std::uint64_t>(segment +
                                      kPortsEach * (kPortBytes + queue * kQueueCellBytes));
  }
  return 0;
}

// Calls `check` for every two processes of different kinds: one of each kind stands for all.
template <typename Check>
void ForPairs(const HostFacts& host, Check&& check) {
  using Kind = std::tuple<std::uint32_t, std::optional<std::uint64_t>, std::uint64_t, std::uint64_t,
                          std::optional<std::uint16_t>, bool>;
  std::set<Kind> known;
  std::vector<const ProcessSituation*> kinds;
  for (const ProcessSituation& process : host.processes) {
    const FileIdentity memory = process.shared_memory.value_or(FileIdentity{});
    const Kind kind{process.launch.domain, process.network_namespace, memory.device,
                    memory.inode,          HostId(process),           UsesSharedMemory(process)};
    if (known.insert(kind).second) kinds.push_back(&process);
  }
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    for (std::size_t j = i + 1; j < kinds.size(); ++j) {
      if (kinds[i]->launch.domain == kinds[j]->launch.domain) check(*kinds[i], *kinds[j]);
    }
  }
}

}  // namespace

void CheckMemoryFiles(const HostFacts& host, qos::Findings* findings) {
  AddGroups(
      host, MemoryState::kStale, "memory_stale",
      "Their owners are gone: they take memory until removed, and every killed participant adds "
      "its segment; when /dev/shm is full, the next participant dies of SIGBUS.",
      "fleetctl doctor --fix", findings);
  AddGroups(host, MemoryState::kOrphaned, "memory_orphaned",
            "Incomplete sets, without lock or body, that no process uses: they take memory until "
            "removed.",
            "fleetctl doctor --fix", findings);
}

void CheckForeignFiles(const HostFacts& host, qos::Findings* findings) {
  std::vector<MemoryGroup> groups = GroupsOf(host.memory);
  std::erase_if(groups, [&](const MemoryGroup& group) {
    return std::ranges::none_of(group.files,
                                [&](const MemoryFile& file) { return IsShut(host, file); });
  });
  if (groups.empty()) return;
  const MemoryGroup& first = groups.front();
  const auto foreign =
      std::ranges::find_if(first.files, [&](const MemoryFile& file) { return IsShut(host, file); });
  findings->push_back(
      {Severity::kWarning,
       "memory_foreign",
       {host.memory.folder, 0},
       "",
       fmt::format("{}; {} is user {}'s, and you are user {}", Summary(groups), foreign->name,
                   foreign->user, host.user),
       "A participant of yours cannot open them: on these ports it neither sends nor listens by "
       "shared memory, and takes the participants there for deaf.",
       "run the whole fleet as one user, in another domain than other users', or without SHM; "
       "those "
       "whose owner is gone root removes with fleetctl doctor --fix"});
}

void CheckMemoryRoom(const HostFacts& host, qos::Findings* findings) {
  const SharedMemory& memory = host.memory;
  if (memory.total_bytes == 0) return;
  const std::uint64_t each = BytesEach(host.planned);
  const auto add = [&](Severity severity, const char* rule, std::uint64_t needed,
                       std::string consequence) {
    findings->push_back({severity,
                         rule,
                         {memory.folder, 0},
                         "",
                         fmt::format("{} free of {}; needed: {}", Megabytes(memory.free_bytes),
                                     Megabytes(memory.total_bytes), Megabytes(needed)),
                         std::move(consequence),
                         "fleetctl doctor --fix removes what no process uses; else a larger one "
                         "(--shm-size or shm_size "
                         "of a container, mount -o remount,size=), or a profile set without SHM"});
  };
  if (each == 0) {
    if (memory.free_bytes > 0) return;
    add(Severity::kWarning, "memory_full", 1,
        "The planned set does not use it; programs that do die of SIGBUS, and vehicles and worlds "
        "come back over UDP alone.");
  } else if (memory.free_bytes < each) {
    add(Severity::kError, "memory_full", each,
        "The segment of one more participant does not fit: it dies of SIGBUS on its first write "
        "there; a vehicle or a world comes back over UDP alone.");
  } else {
    // The fleet also needs a world and an observer. Those of it that run have their segments.
    const std::uint64_t all = host.vehicles + std::uint64_t{qos::kOtherParticipants};
    const auto have = std::ranges::count_if(host.processes, [&](const ProcessSituation& process) {
      return process.launch.domain == host.domains.front() && UsesSharedMemory(process);
    });
    const std::uint64_t others = all - std::min(all, static_cast<std::uint64_t>(have));
    if (memory.free_bytes >= others * each) return;
    add(Severity::kError, "memory_small", others * each,
        fmt::format(
            "There is space for {} of {} more participants; the next dies of SIGBUS on its first "
            "write beyond the free space, and so may any other.",
            memory.free_bytes / each, others));
  }
}

void CheckMemoryShared(const HostFacts& host, qos::Findings* findings) {
  ForPairs(host, [&](const ProcessSituation& a, const ProcessSituation& b) {
    Causes causes;
    CheckSharedMemory(a, b, &causes);
    for (Cause& cause : causes) findings->push_back(std::move(cause.finding));
  });
}

void CheckHostIds(const HostFacts& host, qos::Findings* findings) {
  ForPairs(host, [&](const ProcessSituation& a, const ProcessSituation& b) {
    if (!UsesSharedMemory(a) || !UsesSharedMemory(b)) return;
    const auto id_a = HostId(a);
    const auto id_b = HostId(b);
    if (!id_a || !id_b || *id_a == *id_b) return;
    const bool one_memory = a.shared_memory && a.shared_memory == b.shared_memory;
    findings->push_back(
        {Severity::kWarning,
         "host_ids_apart",
         {},
         "",
         fmt::format("{} has host id {:#06x} by its addresses, {} has {:#06x}{}", NameOf(a), *id_a,
                     NameOf(b), *id_b, one_memory ? "; both have one /dev/shm" : ""),
         "Each takes the other for another host: samples between them go over UDP, and their "
         "shared "
         "memory is used by neither.",
         "one network namespace for both (--network=host), or a profile set without SHM"});
  });
}

}  // namespace giveway::fleetctl
