#include "services/fleetctl/why/why.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <map>
#include <set>
#include <utility>

#include "services/fleetctl/args/observer_session.h"
#include "services/fleetctl/output/terminal_text.h"
#include "services/fleetctl/process/domain_lock.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/process/whole_number.h"
#include "services/fleetctl/why/why_report.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kProc = "/proc";

bool Fits(const Named& named, const FleetMember& member) {
  if (named.pid != 0) return member.pid == named.pid;
  if (named.world || member.is_world) return named.world == member.is_world;
  return member.id == named.id;
}

// Those of the domain, if one is given.
std::string Listed(const std::vector<FleetMember>& members,
                   std::optional<std::uint32_t> domain = std::nullopt) {
  std::string text;
  for (const FleetMember& member : members) {
    if (domain && member.domain != *domain) continue;
    const std::string who = member.is_world ? "the world"
                            : member.id == kNoVehicle
                                ? "a vehicle without a given id"
                                : fmt::format("vehicle {}", Number(member.id));
    text += fmt::format("\n  pid:{}  {} in domain {}, interface {}", member.pid, who, member.domain,
                        member.interface);
    if (member.network_namespace) {
      text += fmt::format(", network namespace {}", *member.network_namespace);
    }
  }
  if (!text.empty()) return text;
  return domain ? fmt::format(" no process of a fleet in domain {}", *domain)
                : " no process of a fleet";
}

// A hearer or speaker of which only the name is known; it is assumed to be like the other.
ProcessSituation StandIn(const Named& named, const ProcessSituation& other) {
  ProcessSituation situation;
  situation.pid = other.pid;
  situation.network_namespace = other.network_namespace;
  situation.mount_namespace = other.mount_namespace;
  situation.launch = other.launch;
  situation.launch.is_world = named.world;
  situation.launch.id = named.id;
  situation.launch.impairment = {};
  return situation;
}

bool IsIn(const std::optional<std::uint32_t>& domain, const FleetMember& member) {
  return !domain || member.domain == *domain;
}

// Whether a named vehicle may be among those without an id.
bool MayBeNameless(const Named& named, const std::vector<FleetMember>& members,
                   const std::optional<std::uint32_t>& domain) {
  const auto found = std::ranges::find_if(members, [&](const FleetMember& member) {
    return Fits(named, member) && (named.pid != 0 || IsIn(domain, member));
  });
  if (named.pid == 0) return !named.world && found == members.end();
  return found != members.end() && !found->is_world && found->id == kNoVehicle;
}

// Names the vehicles that publish no id, if the probe hears them in the place of the first of them.
// Two that discovery cannot distinguish, with the same process id in two containers, stay unnamed.
void NameByProbe(const std::vector<FleetMember*>& nameless) {
  std::map<std::uint16_t, std::vector<FleetMember*>> by_process;
  std::optional<ProcessSituation> place;
  for (FleetMember* const member : nameless) {
    auto situation = ReadSituation(kProc, member->pid);
    if (!situation) continue;
    by_process[static_cast<std::uint16_t>(situation->pid_inside)].push_back(member);
    if (!place) place = std::move(situation);
  }
  if (!place) return;
  std::set<std::uint16_t> wanted;
  for (const auto& [process, members] : by_process) {
    if (members.size() == 1) wanted.insert(process);
  }
  for (const auto& [process, id] : ListenForNames(*place, wanted)) {
    if (wanted.contains(process)) by_process[process].front()->id = id;
  }
}

// Names the vehicles of a domain without an id, fleet by fleet: one domain number may belong to
// several, each with a network of its own.
void NameNameless(std::uint32_t domain, std::vector<FleetMember>* members) {
  std::map<std::pair<std::uint64_t, std::string>, std::vector<FleetMember*>> nameless;
  for (FleetMember& member : *members) {
    if (member.is_world || member.id != kNoVehicle || member.domain != domain) continue;
    nameless[{member.network_namespace.value_or(0), member.interface}].push_back(&member);
  }
  for (const auto& [network, fleet] : nameless) NameByProbe(fleet);
}

std::optional<ProcessSituation> Read(int pid, const std::vector<FleetMember>& members) {
  if (pid == 0) return std::nullopt;
  auto situation = ReadSituation(kProc, pid);
  const auto member = std::ranges::find(members, pid, &FleetMember::pid);
  if (situation && member != members.end()) situation->launch.id = member->id;
  return situation;
}

std::uint32_t VehiclesIn(const std::vector<FleetMember>& members, std::uint32_t domain) {
  return static_cast<std::uint32_t>(std::ranges::count_if(
      members, [&](const FleetMember& one) { return !one.is_world && one.domain == domain; }));
}

// `foreign`: the vendor of its DDS that the probe found, if it is not ours.
void AddNotKnown(const std::optional<ProcessSituation>& process, const Named& named,
                 const std::string& foreign, WhyReport* report) {
  if (!process) {
    report->not_known.push_back(
        foreign.empty()
            ? TextOf(named) + " is no process of a fleet on this machine: judged by what is heard"
            : fmt::format("{} is foreign ({}): judged by what discovery reports and what is heard",
                          TextOf(named), foreign));
    return;
  }
  for (const std::string& fact : process->not_known) {
    report->not_known.push_back(NameOf(*process) + ": " + fact);
  }
}

int Report(const WhyOptions& options, const std::vector<FleetMember>& members,
           const ChosenPair& chosen) {
  const auto hearer = Read(chosen.hearer, members);
  const auto speaker = Read(chosen.speaker, members);
  if (!hearer && !speaker) {
    std::fprintf(stderr, "both processes have ended meanwhile\n");
    return kCouldNotRun;
  }
  const ProcessSituation from = hearer ? *hearer : StandIn(options.hearer, *speaker);
  const ProcessSituation to = speaker ? *speaker : StandIn(options.speaker, *hearer);
  WhyReport report;
  report.hearer = hearer ? NameOf(*hearer) : TextOf(options.hearer);
  report.speaker = speaker ? NameOf(*speaker) : TextOf(options.speaker);
  report.hearer_here = hearer.has_value();
  report.predicted = hearer && speaker;
  report.topics = report.predicted ? Predict(from, to, VehiclesIn(members, from.launch.domain))
                                   : TopicsBetween(from.launch, to.launch);
  if (report.topics.empty()) {
    std::fprintf(stderr, "two worlds do not talk to each other\n");
    return kCouldNotRun;
  }
  report.host_id = speaker ? HostId(*speaker) : std::nullopt;
  if (options.probe) {
    report.probe = Probe({from, to, hearer.has_value(), report.topics,
                          options.seconds.value_or(ListenSeconds(report.topics))});
    AddNotJoined(from, to, &report);
    AddUnfit(&report);
  }
  const ProbeResult heard = report.probe.value_or(ProbeResult{});
  AddNotKnown(hearer, options.hearer, heard.hearer_foreign, &report);
  AddNotKnown(speaker, options.speaker, heard.speaker_foreign, &report);
  const WriteResult result =
      WriteStdout(options.json ? ToJson(report) : ForTerminal(ToText(report)));
  return result == WriteResult::kFailed ? ExitCodeOf(result) : ExitCode(report);
}

}  // namespace

std::optional<Named> ParseNamed(const std::string& text) {
  if (text == "world") return Named{.world = true};
  if (text.starts_with("pid:")) {
    const int pid = WholeNumber<int>(std::string_view(text).substr(4)).value_or(0);
    return pid > 0 ? std::optional(Named{.pid = pid}) : std::nullopt;
  }
  const std::uint32_t id = WholeNumber<std::uint32_t>(text).value_or(0);
  return id > 0 ? std::optional(Named{.id = VehicleId{id}}) : std::nullopt;
}

std::string TextOf(const Named& named) {
  if (named.world) return "the world";
  if (named.pid != 0) return fmt::format("pid {}", named.pid);
  return fmt::format("vehicle {}", Number(named.id));
}

std::variant<ChosenPair, std::string> Choose(const std::vector<FleetMember>& members,
                                             const WhyOptions& options) {
  const auto fitting = [&](const Named& named) {
    std::vector<FleetMember> fit;
    for (const FleetMember& member : members) {
      const bool here = named.pid != 0 || IsIn(options.domain, member);
      if (here && Fits(named, member)) fit.push_back(member);
    }
    return fit;
  };
  const auto hearers = fitting(options.hearer);
  const auto speakers = fitting(options.speaker);
  for (const auto& [named, fit] :
       {std::pair{&options.hearer, &hearers}, {&options.speaker, &speakers}}) {
    if (named->pid != 0 && fit->empty()) {
      return fmt::format("pid {} is no process of a fleet; there is:{}", named->pid,
                         Listed(members));
    }
  }
  if (hearers.empty() && speakers.empty()) {
    return fmt::format("neither {} nor {} is a process of this machine; there is:{}",
                       TextOf(options.hearer), TextOf(options.speaker),
                       Listed(members, options.domain));
  }
  std::vector<ChosenPair> pairs;
  std::vector<ChosenPair> together;  // in one domain
  for (const FleetMember& a : hearers.empty() ? std::vector<FleetMember>(1) : hearers) {
    for (const FleetMember& b : speakers.empty() ? std::vector<FleetMember>(1) : speakers) {
      if (a.pid != 0 && a.pid == b.pid) continue;
      pairs.push_back({a.pid, b.pid});
      if (a.domain == b.domain) together.push_back(pairs.back());
    }
  }
  if (pairs.empty())
    return "both names are of one process, and a process does not receive its own samples";
  if (pairs.size() == 1) return pairs.front();
  if (together.size() == 1) return together.front();
  std::vector<FleetMember> meant = hearers;
  meant.insert(meant.end(), speakers.begin(), speakers.end());
  return fmt::format("several processes are called {} or {}; choose by --domain or pid:{}",
                     TextOf(options.hearer), TextOf(options.speaker), Listed(meant));
}

int RunWhy(const WhyOptions& options) {
  if (!HasStdout()) return kCouldNotRun;
  std::vector<FleetMember> members = FindFleet(kProc);
  const bool nameless = MayBeNameless(options.hearer, members, options.domain) ||
                        MayBeNameless(options.speaker, members, options.domain);
  if (nameless) {
    for (std::uint32_t domain = kFirstDomain; domain <= kLastDomain; ++domain) {
      if (!options.domain || domain == *options.domain) NameNameless(domain, &members);
    }
  }
  const auto chosen = Choose(members, options);
  if (const auto* why = std::get_if<std::string>(&chosen)) {
    std::fprintf(stderr, "%s\n", why->c_str());
    return kCouldNotRun;
  }
  return Report(options, members, std::get<ChosenPair>(chosen));
}

}  // namespace giveway::fleetctl
