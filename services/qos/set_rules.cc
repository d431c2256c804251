// A profile set as a whole, its writers against its readers, and two sets: whether processes with
// one discover those with the other, by the same protocol at the same ports, and of clients a
// server in common.
#include <algorithm>
#include <set>

#include "services/qos/qos_rules.h"
#include "services/qos/request_offered.h"

namespace giveway::qos {
namespace {

struct Wanted {
  Owner owner;
  std::string name;
};

std::vector<Wanted> WantedProfiles() {
  std::vector<Wanted> wanted = {{Owner::kParticipant, std::string(kParticipantProfile)}};
  for (const Topic& topic : FleetTopics()) {
    wanted.push_back({Owner::kWriter, std::string(topic.stem) + "_writer"});
    wanted.push_back({Owner::kReader, std::string(topic.stem) + "_reader"});
  }
  return wanted;
}

// Of the wanted names the one that differs in the fewest places; typing errors are near.
std::string Closest(const std::string& name) {
  std::string closest;
  std::size_t fewest = name.size();
  for (const Wanted& wanted : WantedProfiles()) {
    std::size_t same_head = 0;
    const std::size_t shorter = std::min(name.size(), wanted.name.size());
    while (same_head < shorter && name[same_head] == wanted.name[same_head]) ++same_head;
    std::size_t same_tail = 0;
    while (same_tail < shorter - same_head &&
           name[name.size() - 1 - same_tail] == wanted.name[wanted.name.size() - 1 - same_tail]) {
      ++same_tail;
    }
    const std::size_t differ = std::max(name.size(), wanted.name.size()) - same_head - same_tail;
    if (differ < fewest) {
      fewest = differ;
      closest = wanted.name;
    }
  }
  return closest;
}

void CheckTwice(const ProfileSet& set, Findings* findings) {
  std::set<std::pair<Owner, std::string>> seen;
  for (const Profile& profile : set.profiles) {
    if (profile.name.empty() || seen.insert({profile.owner, profile.name}).second) continue;
    findings->push_back({Severity::kError, "duplicate_profile", profile.place, profile.name,
                         "is named already at line " +
                             std::to_string(set.Find(profile.owner, profile.name)->place.line),
                         "The library refuses the file, or keeps the first and drops this one.",
                         "remove one of them"});
  }
}

std::string ElementOf(Owner owner) {
  if (owner == Owner::kParticipant) return "<participant>";
  return owner == Owner::kWriter ? "<data_writer>" : "<data_reader>";
}

// The name is right, and the element is not.
void AddWrongElement(const Profile& profile, Owner wanted, Findings* findings) {
  findings->push_back({Severity::kWarning, "unused_profile", profile.place, profile.name,
                       "is a " + ElementOf(profile.owner) + ", and services ask for a " +
                           ElementOf(wanted) + " of that name",
                       "What it says has no effect.", "write " + ElementOf(wanted)});
}

void CheckUnused(const ProfileSet& set, Findings* findings) {
  const std::vector<Wanted> wanted = WantedProfiles();
  for (const Profile& profile : set.profiles) {
    const bool used = std::ranges::any_of(wanted, [&](const Wanted& one) {
      return one.owner == profile.owner && one.name == profile.name;
    });
    if (used || profile.name.empty()) continue;
    const auto of_another = std::ranges::find(wanted, profile.name, &Wanted::name);
    if (of_another != wanted.end()) {
      AddWrongElement(profile, of_another->owner, findings);
      continue;
    }
    findings->push_back(
        {Severity::kWarning, "unused_profile", profile.place, profile.name,
         "no service asks for it; the nearest name asked for is " + Closest(profile.name),
         "What it says has no effect.", "correct the name, or remove it"});
  }
}

void CheckMissing(const ProfileSet& set, Findings* findings) {
  std::string missing;
  std::size_t count = 0;
  for (const Wanted& wanted : WantedProfiles()) {
    if (set.Find(wanted.owner, wanted.name) != nullptr) continue;
    ++count;
    if (count <= 3) missing += (missing.empty() ? "" : ", ") + wanted.name;
  }
  if (count == 0) return;
  if (count > 3) missing += " and " + std::to_string(count - 3) + " more";
  findings->push_back({Severity::kError,
                       "missing_profile",
                       {set.file, 0},
                       "",
                       "lacks " + missing,
                       "A service that asks for one of them does not start.",
                       "copy what is missing from config/qos/default.xml"});
}

void AddMismatch(const Profile& writer, const Profile& reader, const MatchRule& rule,
                 Findings* findings) {
  const Profile& later = reader[rule.policy].given ? reader : writer;
  findings->push_back(
      {rule.enforced ? Severity::kError : Severity::kWarning, std::string(rule.name),
       PlaceOf(later, rule.policy), writer.name + " to " + reader.name,
       "the writer offers " + StatedValue(writer, rule.policy) + ", the reader requests " +
           StatedValue(reader, rule.policy),
       rule.enforced ? "The two never match, and the reader hears nothing."
                     : "Fast DDS matches them all the same; other DDS implementations do not.",
       "change one of the two: " + std::string(rule.rule)});
}

constexpr char kApart[] =
    "Processes with one set do not find those with the other, nor does an operator find both.";
constexpr char kTogether[] =
    "the same in both; in a fleet that drives, start all processes again at once";

bool IsClient(const Profile& participant) {
  const std::int64_t protocol = participant.Number(Policy::kDiscoveryProtocol);
  return protocol == kClient || protocol == kSuperClient;
}

void CheckSame(const Profile& one, const Profile& other, Policy policy, Findings* findings) {
  if (one.Number(policy) == other.Number(policy)) return;
  findings->push_back({Severity::kError, "discovery_mismatch", PlaceOf(one, policy), one.name,
                       std::string(Info(policy).name) + " " + StatedValue(one, policy) + ", and " +
                           StatedValue(other, policy) + " in " + other.place.file,
                       kApart, kTogether});
}

// Clients know a server by its prefix. Two addresses may reach one, or two that chose one prefix.
void CheckServers(const ProfileSet& a, const ProfileSet& b, Findings* findings) {
  const Participation* const one = a.OurParticipation();
  const Participation* const other = b.OurParticipation();
  if (one == nullptr || other == nullptr || one->servers.empty() || other->servers.empty()) return;
  const DiscoveryServer* shown = &one->servers.front();
  const DiscoveryServer* against = &other->servers.front();
  bool one_prefix = false;
  for (const DiscoveryServer& server : one->servers) {
    for (const DiscoveryServer& theirs : other->servers) {
      if (server.prefix != theirs.prefix) continue;
      if (server.address == theirs.address) return;
      one_prefix = true;
      shown = &server;
      against = &theirs;
    }
  }
  const auto words = [](const DiscoveryServer& server) {
    return "RemoteServer " + server.prefix + " at " + server.address + " (line " +
           std::to_string(server.place.line) + ")";
  };
  findings->push_back({one_prefix ? Severity::kWarning : Severity::kError,
                       one_prefix ? "discovery_address" : "discovery_mismatch", shown->place,
                       one->profile, words(*shown) + ", and " + words(*against) + " in " + b.file,
                       one_prefix ? "Where the two addresses are two servers, processes with one "
                                    "set do not find those with the other."
                                  : kApart,
                       kTogether});
}

}  // namespace

std::string StatedValue(const Profile& profile, Policy policy) {
  const Value& value = profile[policy];
  std::string text = Text(policy, value.number);
  if (!value.given) return text + " (library default)";
  return text + " (line " + std::to_string(value.place.line) + ")";
}

void CheckNames(const ProfileSet& set, const Deployment& deployment, Findings* findings) {
  CheckTwice(set, findings);
  CheckUnused(set, findings);
  if (deployment.complete) CheckMissing(set, findings);
}

void CheckPairs(const ProfileSet& writers, const ProfileSet& readers, Findings* findings) {
  for (const Profile& writer : writers.profiles) {
    if (writer.owner != Owner::kWriter || !writer.name.ends_with("_writer")) continue;
    const std::string stem = writer.name.substr(0, writer.name.rfind('_'));
    const Profile* reader = readers.Find(Owner::kReader, stem + "_reader");
    if (reader == nullptr) continue;
    for (const MatchRule* rule : Broken(writer, *reader)) {
      AddMismatch(writer, *reader, *rule, findings);
    }
  }
}

void CheckFindEachOther(const ProfileSet& a, const ProfileSet& b, Findings* findings) {
  const Profile* const one = a.Find(Owner::kParticipant, kParticipantProfile);
  const Profile* const other = b.Find(Owner::kParticipant, kParticipantProfile);
  if (one == nullptr || other == nullptr) return;
  if (IsClient(*one) && IsClient(*other)) {
    CheckServers(a, b, findings);
  } else {
    CheckSame(*one, *other, Policy::kDiscoveryProtocol, findings);
  }
  for (const Policy policy :
       {Policy::kPortBase, Policy::kDomainGain, Policy::kParticipantGain, Policy::kOffset0,
        Policy::kOffset1, Policy::kOffset2, Policy::kOffset3}) {
    CheckSame(*one, *other, policy, findings);
  }
}

}  // namespace giveway::qos
