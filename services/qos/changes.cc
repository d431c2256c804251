#include "services/qos/changes.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "services/qos/deployment.h"

namespace giveway::qos {
namespace {

// Policies are distinguished by the table; everything else by where it stands in the file.
using Elsewhere = std::map<std::pair<std::string, std::string>, std::string>;

bool IsPolicy(Owner owner, const std::string& path) {
  return std::ranges::any_of(Policies(), [&](const PolicyInfo& info) {
    return Has(owner, info) &&
           (path == info.path || path.starts_with(std::string(info.path) + '/'));
  });
}

// Adds the texts and attributes below an element whose path `skip` does not know. Where several
// children have one name, those behind the first are numbered: "locator[2]".
template <typename Skip>
void Flatten(const XmlElement& element, const std::string& owner, const std::string& path,
             const std::string& numbered, const Skip& skip, Elsewhere& to) {
  if (!path.empty()) {
    if (skip(path)) return;
    if (!element.text.empty()) to[{owner, numbered}] = element.text;
    for (const XmlAttribute& attribute : element.attributes) {
      to[{owner, numbered + '@' + attribute.name}] = attribute.value;
    }
  }
  std::map<std::string, std::size_t> seen;
  for (const XmlElement& child : element.children) {
    const std::size_t number = ++seen[child.name];
    const std::string name =
        number == 1 ? child.name : child.name + '[' + std::to_string(number) + ']';
    Flatten(child, owner, path.empty() ? child.name : path + '/' + child.name,
            numbered.empty() ? name : numbered + '/' + name, skip, to);
  }
}

void FlattenProfiles(const XmlElement& profiles, Elsewhere& to) {
  static const std::map<std::string, Owner> kOwners = {{"participant", Owner::kParticipant},
                                                       {"data_writer", Owner::kWriter},
                                                       {"publisher", Owner::kWriter},
                                                       {"data_reader", Owner::kReader},
                                                       {"subscriber", Owner::kReader}};
  const auto nothing = [](const std::string&) { return false; };
  for (const XmlElement& child : profiles.children) {
    if (const auto owner = kOwners.find(child.name); owner != kOwners.end()) {
      const auto is_policy = [&](const std::string& path) { return IsPolicy(owner->second, path); };
      Flatten(child, child.Attribute("profile_name"), "", "", is_policy, to);
    } else if (child.name == "transport_descriptors") {
      for (const XmlElement& descriptor : child.children) {
        const XmlElement* const id = descriptor.Child("transport_id");
        Flatten(descriptor, "transport " + (id == nullptr ? "" : id->text), "", "", nothing, to);
      }
    } else {
      Flatten(child, child.name, "", "", nothing, to);
    }
  }
}

Elsewhere ElsewhereOf(const XmlElement& root) {
  Elsewhere all;
  if (const XmlElement* profiles = ProfilesOf(root)) FlattenProfiles(*profiles, all);
  for (const XmlElement& child : root.children) {
    if (child.name != "profiles" && root.name != "profiles") {
      Flatten(
          child, child.name, "", "", [](const std::string&) { return false; }, all);
    }
  }
  return all;
}

void AddValues(const Profile& from, const Profile& to, std::vector<Change>* changes) {
  for (const PolicyInfo& info : Policies()) {
    const std::int64_t before = from.Number(info.policy);
    const std::int64_t after = to.Number(info.policy);
    if (!Has(to.owner, info) || before == after) continue;
    const Effect effect = info.policy == Policy::kDeadline ? Effect::kNow : Effect::kRestart;
    changes->push_back({to.name, std::string(info.name), Text(info.policy, before),
                        Text(info.policy, after), effect, after, before});
  }
}

void AddValues(const ProfileSet& from, const ProfileSet& to, std::vector<Change>* changes) {
  std::set<std::pair<std::string, Owner>> names;
  for (const ProfileSet* set : {&from, &to}) {
    for (const Profile& profile : set->profiles) names.emplace(profile.name, profile.owner);
  }
  for (const auto& [name, owner] : names) {
    const Profile* const before = from.Find(owner, name);
    const Profile* const after = to.Find(owner, name);
    if (before != nullptr && after != nullptr) {
      AddValues(*before, *after, changes);
    } else {
      changes->push_back({name, "profile", before == nullptr ? "" : "there",
                          after == nullptr ? "" : "there", Effect::kRestart, 0, 0});
    }
  }
}

}  // namespace

std::vector<Change> Changes(const XmlElement& from, const XmlElement& to) {
  std::vector<Change> changes;
  AddValues(ReadProfiles(from, ""), ReadProfiles(to, ""), &changes);
  std::ranges::move(ChangesElsewhere(from, to), std::back_inserter(changes));
  return changes;
}

std::vector<Change> ChangesElsewhere(const XmlElement& from, const XmlElement& to) {
  std::vector<Change> changes;
  Elsewhere before = ElsewhereOf(from);
  Elsewhere after = ElsewhereOf(to);
  for (const auto& [where, text] : before) after.try_emplace(where, "");
  for (const auto& [where, text] : after) {
    const std::string& old = before[where];
    if (old != text)
      changes.push_back({where.first, where.second, old, text, Effect::kRestart, 0, 0});
  }
  return changes;
}

bool Concerns(Role role, std::string_view profile) {
  const Topic* const topic = TopicOfProfile(profile);
  if (topic == nullptr) return true;
  const bool writes = profile.ends_with("_writer");
  if (topic->name == "fleet/admin") return writes == (role == Role::kOperator);
  if (topic->name == "fleet/answer") return writes != (role == Role::kOperator);
  if (role == Role::kOperator) return topic->name == "fleet/status" && !writes;
  const bool of_fleet = topic->name.starts_with("fleet/");
  if (role == Role::kVehicle) {
    const bool of_observers = topic->name == "world/truth" || topic->name == "world/event" ||
                              topic->name == "world/figures";
    return of_fleet ? writes || topic->name == "fleet/beacon" : !writes && !of_observers;
  }
  if (!of_fleet) return writes;
  return !writes && (topic->name == "fleet/motor_command" || topic->name == "fleet/join");
}

std::vector<Change> ChangesFor(Role role, std::vector<Change> changes) {
  std::erase_if(changes, [&](const Change& change) { return !Concerns(role, change.profile); });
  return changes;
}

bool NeedsRestart(const std::vector<Change>& changes) {
  return std::ranges::any_of(changes,
                             [](const Change& one) { return one.effect == Effect::kRestart; });
}

}  // namespace giveway::qos
