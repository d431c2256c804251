#include "services/fleetctl/qos/qos_show.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "services/config/problem.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/output/terminal_text.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/qos/qos_effective.h"
#include "services/qos/changes.h"
#include "services/qos/deployment.h"
#include "services/qos/xml_tree.h"
#include "services/runtime/json.h"

namespace giveway::fleetctl {
namespace {

// By its profile or its topic; all, where none is named.
bool IsWanted(const std::vector<std::string>& wanted, const std::string& profile) {
  const qos::Topic* const topic = qos::TopicOfProfile(profile);
  return wanted.empty() || std::ranges::any_of(wanted, [&](const std::string& word) {
           return word == profile || (topic != nullptr && word == topic->name);
         });
}

EffectiveSet Resolve(const std::string& argument, const QosShowOptions& options) {
  EffectiveSet shown = EffectiveQosOfFile(argument, options.interface, options.vehicles);
  std::erase_if(shown.endpoints, [&](const EffectiveEndpoint& endpoint) {
    return !IsWanted(options.wanted, endpoint.profile);
  });
  if (shown.endpoints.empty()) {
    throw InputError({{options.wanted.front(), 0, "", "", "is no profile and no topic",
                       "name one, as fleet_beacon_writer or fleet/beacon"}});
  }
  return shown;
}

std::string ToText(const EffectiveSet& shown) {
  std::string text;
  for (const EffectiveEndpoint& endpoint : shown.endpoints) {
    text += fmt::format("{}{}{}\n", endpoint.profile, endpoint.topic.empty() ? "" : "  on ",
                        endpoint.topic);
    for (const QosRow& row : endpoint.rows) {
      text +=
          fmt::format("  {:<28} {:<24} {}\n", row.policy, row.value, OriginText(row, shown.file));
    }
  }
  return text;
}

void AddValue(const QosRow& row, Json* json) {
  (*json)["value"] = row.value;
  (*json)["origin"] = Name(row.origin);
  if (row.line > 0) (*json)["line"] = row.line;
}

Json JsonOf(const QosRow& row) {
  Json json;
  json["policy"] = row.policy;
  AddValue(row, &json);
  return json;
}

Json JsonOf(const EffectiveEndpoint& endpoint) {
  Json json;
  json["profile"] = endpoint.profile;
  json["topic"] = endpoint.topic;
  json["values"] = JsonArray(endpoint.rows, [](const QosRow& row) { return JsonOf(row); });
  return json;
}

std::string ToJson(const EffectiveSet& shown) {
  Json json;
  json["file"] = shown.file;
  json["endpoints"] = JsonArray(shown.endpoints,
                                [](const EffectiveEndpoint& endpoint) { return JsonOf(endpoint); });
  return JsonText(std::move(json)) + "\n";
}

struct Difference {
  std::string profile;
  QosRow a;
  QosRow b;
};

// A value that one of the files does not have is the library's.
QosRow RowOf(const std::string& what, const std::string& value) {
  if (value.empty()) return {what, "-", QosOrigin::kDefault};
  return {what, value, QosOrigin::kProfile};
}

// What no table of policies holds, which the library resolves by itself: transports and the like.
void AddDifferencesElsewhere(const EffectiveSet& a, const EffectiveSet& b,
                             const std::vector<std::string>& wanted,
                             std::vector<Difference>* found) {
  const qos::XmlRead from = qos::ReadXml(a.text, a.file);
  const qos::XmlRead to = qos::ReadXml(b.text, b.file);
  if (!from.root || !to.root) return;
  for (const qos::Change& change : qos::ChangesElsewhere(*from.root, *to.root)) {
    if (!IsWanted(wanted, change.profile)) continue;
    found->push_back(
        {change.profile, RowOf(change.what, change.from), RowOf(change.what, change.to)});
  }
}

std::vector<Difference> Differences(const EffectiveSet& a, const EffectiveSet& b,
                                    const std::vector<std::string>& wanted) {
  std::vector<Difference> found;
  // Both were resolved by one list of endpoints and one table of policies.
  for (std::size_t i = 0; i < a.endpoints.size() && i < b.endpoints.size(); ++i) {
    const auto& rows = b.endpoints[i].rows;
    for (const QosRow& row : a.endpoints[i].rows) {
      const auto other = std::ranges::find(rows, row.policy, &QosRow::policy);
      if (other == rows.end() || other->value == row.value) continue;
      found.push_back({a.endpoints[i].profile, row, *other});
    }
  }
  AddDifferencesElsewhere(a, b, wanted, &found);
  return found;
}

std::string ToText(const std::vector<Difference>& differences, const EffectiveSet& a,
                   const EffectiveSet& b) {
  std::string text;
  for (const Difference& one : differences) {
    text += fmt::format("{} {}\n  {:<24} {}\n  {:<24} {}\n", one.profile, one.a.policy, one.a.value,
                        OriginText(one.a, a.file), one.b.value, OriginText(one.b, b.file));
  }
  return text + fmt::format("{} values differ\n", differences.size());
}

Json JsonOf(const Difference& one) {
  Json json;
  json["profile"] = one.profile;
  json["policy"] = one.a.policy;
  AddValue(one.a, &json["a"]);
  AddValue(one.b, &json["b"]);
  return json;
}

std::string ToJson(const std::vector<Difference>& differences, const EffectiveSet& a,
                   const EffectiveSet& b) {
  Json json;
  json["a"] = a.file;
  json["b"] = b.file;
  json["differences"] = JsonArray(differences, [](const Difference& one) { return JsonOf(one); });
  return JsonText(std::move(json)) + "\n";
}

}  // namespace

int RunQosShow(const QosShowOptions& options) {
  if (options.diff.empty()) {
    const EffectiveSet shown = Resolve(options.qos_file, options);
    const bool all = PrintAll(options.json ? ToJson(shown) : FoldedForTerminal(ToText(shown)));
    return all ? 0 : kCouldNotRun;
  }
  const EffectiveSet a = Resolve(options.diff.at(0), options);
  const EffectiveSet b = Resolve(options.diff.at(1), options);
  const std::vector<Difference> found = Differences(a, b, options.wanted);
  if (!PrintAll(options.json ? ToJson(found, a, b) : FoldedForTerminal(ToText(found, a, b)))) {
    return kCouldNotRun;
  }
  return found.empty() ? 0 : 1;
}

}  // namespace giveway::fleetctl
