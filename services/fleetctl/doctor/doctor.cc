#include "services/fleetctl/doctor/doctor.h"

#include <fmt/format.h>

#include <cstdio>
#include <vector>

#include "services/fleetctl/doctor/doctor_read.h"
#include "services/fleetctl/doctor/doctor_rules.h"
#include "services/fleetctl/doctor/memory_read.h"
#include "services/fleetctl/doctor/memory_removal.h"
#include "services/fleetctl/output/finding_text.h"
#include "services/fleetctl/output/terminal_text.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/observer/fleet/json_object.h"
#include "services/runtime/json_line.h"

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
  for (const std::string& fact : host.not_known) text += Shown("not known: " + fact) + "\n";
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

std::string ToJson(const MemoryGroup& group) {
  JsonObject object;
  object.Add("name", std::string_view(group.body));
  object.Add("state", Word(group.state));
  object.Add("bytes", group.Bytes());
  object.Add("user", group.files.front().user);
  object.AddRaw("files", JsonArray(group.files,
                                   [](const MemoryFile& file) { return JsonString(file.name); }));
  return object.Text();
}

JsonObject ToJson(const SharedMemory& memory) {
  JsonObject object;
  object.Add("folder", std::string_view(memory.folder));
  object.Add("total_bytes", memory.total_bytes);
  object.Add("free_bytes", memory.free_bytes);
  object.AddRaw("groups", JsonArray(GroupsOf(memory),
                                    [](const MemoryGroup& group) { return ToJson(group); }));
  return object;
}

std::string ToJson(const Removal& removal) {
  JsonObject object;
  object.Add("file", std::string_view(removal.file));
  object.Add("removed", removal.left.empty());
  if (!removal.left.empty()) object.Add("left", std::string_view(removal.left));
  return object.Text();
}

std::string Json(const HostFacts& host, const std::vector<Removal>& removals,
                 const qos::Findings& findings) {
  JsonObject object;
  AddFindings(findings, &object);
  object.Add("processes", host.processes.size());
  object.Add("memory", ToJson(host.memory));
  object.AddRaw("fixed",
                JsonArray(removals, [](const Removal& removal) { return ToJson(removal); }));
  object.AddRaw("not_known", JsonArray(host.not_known, JsonString));
  return object.Text() + "\n";
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
    const std::string text =
        options.json ? Json(host, removals, findings) : ForTerminal(Text(host, removals, findings));
    std::fputs(text.c_str(), stdout);
    if (std::fflush(stdout) != 0) return kCouldNotRun;
  }
  return findings.empty() ? 0 : 1;
}

}  // namespace giveway::fleetctl
