#include "services/fleetctl/doctor/doctor.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "services/fleetctl/doctor/doctor_read.h"
#include "services/fleetctl/doctor/doctor_rules.h"
#include "services/fleetctl/doctor/memory_read.h"
#include "services/fleetctl/doctor/memory_removal.h"
#include "services/fleetctl/output/finding_text.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/output/terminal_text.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/runtime/json.h"
#include "services/runtime/utf8.h"

namespace giveway::fleetctl {
namespace {

std::string Line(const Removal& removal) {
  if (removal.left.empty()) return "removed " + removal.file;
  return "left " + removal.file + ": " + removal.left;
}

std::string Text(const HostFacts& host, const std::vector<Removal>& removals,
                 const qos::Findings& findings) {
  std::string text;
  for (const Removal& removal : removals) text += Line(removal) + "\n";
  for (const qos::Finding& finding : findings) text += ToText(finding, "host");
  for (const std::string& fact : host.not_known) text += Printable("not known: " + fact) + "\n";
  return text +
         (host.processes.size() == 1 ? "1 process"
                                     : fmt::format("{} processes", host.processes.size())) +
         " of fleets, " + Tally(findings) + "\n";
}

std::string_view Word(MemoryState state) {
  switch (state) {
    case MemoryState::kInUse:
      return "in_use";
    case MemoryState::kStale:
      return "stale";
    case MemoryState::kOrphaned:
      return "orphaned";
    case MemoryState::kNotKnown:
      break;
  }
  return "not_known";
}

Json ToJson(const MemoryGroup& group) {
  Json object;
  object["name"] = group.body;
  object["state"] = Word(group.state);
  object["bytes"] = group.Bytes();
  object["user"] = group.files.front().user;
  object["files"] = JsonArray(group.files, &MemoryFile::name);
  return object;
}

Json ToJson(const SharedMemory& memory) {
  Json object;
  object["folder"] = memory.folder;
  object["total_bytes"] = memory.total_bytes;
  object["free_bytes"] = memory.free_bytes;
  object["groups"] =
      JsonArray(GroupsOf(memory), [](const MemoryGroup& group) { return ToJson(group); });
  return object;
}

Json ToJson(const Removal& removal) {
  Json object;
  object["file"] = removal.file;
  object["removed"] = removal.left.empty();
  if (!removal.left.empty()) object["left"] = removal.left;
  return object;
}

std::string ToJson(const HostFacts& host, const std::vector<Removal>& removals,
                   const qos::Findings& findings) {
  Json object;
  AddFindings(findings, &object);
  object["processes"] = host.processes.size();
  object["memory"] = ToJson(host.memory);
  object["fixed"] = JsonArray(removals, [](const Removal& removal) { return ToJson(removal); });
  object["not_known"] = host.not_known;
  return JsonText(std::move(object)) + "\n";
}

}  // namespace

int RunDoctor(const DoctorOptions& options) {
  const HostFolders folders;
  HostFacts host = ReadHost(options, folders);
  host.interfaces = ReadInterfaces(options.interface);
  host.clock = ReadClock();
  std::vector<Removal> removals;
  if (options.fix) {
    removals = RemoveGone(host.memory, host.user);
    host.memory = ReadSharedMemory(folders.memory, folders.proc);
  }
  const qos::Findings findings = Examine(host);
  if (!options.quiet) {
    const std::string text = options.json ? ToJson(host, removals, findings)
                                          : ForTerminal(Text(host, removals, findings));
    if (!PrintAll(text)) return kCouldNotRun;
  }
  return findings.empty() ? 0 : 1;
}

}  // namespace giveway::fleetctl
