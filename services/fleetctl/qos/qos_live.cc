#include "services/fleetctl/qos/qos_live.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "services/fleetctl/args/observer_session.h"
#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/output/terminal_text.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/process/run_key.h"
#include "services/fleetctl/qos/admin_client.h"
#include "services/fleetctl/qos/qos_effective.h"
#include "services/fleetctl/qos/qos_foreign.h"
#include "services/fleetctl/survey/other_fleets.h"
#include "services/qos/deployment.h"
#include "services/qos/xml_tree.h"
#include "services/runtime/json.h"

namespace giveway::fleetctl {
namespace {

constexpr auto kAnswerPatience = std::chrono::seconds(10);
// Our vehicles are reached in a second; after that foreign ones are considered.
constexpr auto kOwnPatience = std::chrono::seconds(3);

// One live value, and what the file gives for it; nullopt if it has no such endpoint or value.
struct LiveRow {
  std::string profile;
  QosRow live;
  std::optional<QosRow> expected;

  bool AsExpected() const { return !expected || expected->value == live.value; }
};

// What is known of a vehicle: its own answer, or for a foreign one what discovery reports.
struct LiveQos {
  std::string runs_with;         // the name of its set; empty for a foreign one
  std::string foreign;           // the vendor of its DDS, if it is not ours
  std::uint32_t fleet_size = 0;  // as it says; 0 of a foreign one
  std::vector<EffectiveEndpoint> endpoints;
};

link::LinkOptions LinkOptionsOf(const QosLiveOptions& options, const std::string& file) {
  link::LinkOptions link_options;
  link_options.domain = options.domain;
  link_options.interface = options.set.interface;
  link_options.fleet_size = options.set.vehicles;
  link_options.qos = ReadSoundQos(file);
  return link_options;
}

// The live endpoints, with the origin of each value in the file that the vehicle has.
std::vector<EffectiveEndpoint> LiveEndpoints(const AdminAnswer& answer) {
  std::vector<link::ResolvedEntity> entities;
  for (const LiveValue& value : answer.live) {
    if (entities.empty() || entities.back().profile != value.profile) {
      const qos::Topic* const topic = qos::TopicOfProfile(value.profile);
      entities.push_back({value.profile, topic == nullptr ? "" : std::string(topic->name), {}});
    }
    entities.back().values.push_back({value.policy, value.number});
  }
  const qos::XmlRead read = qos::ReadXml(answer.profiles.text, answer.profiles.name);
  return EffectiveQos(entities, read.root ? qos::ReadProfiles(*read.root, answer.profiles.name)
                                          : qos::ProfileSet{});
}

// nullopt if there is none: then the reason has been printed, and *exit_code set.
std::optional<LiveQos> LiveQosOf(const QosLiveOptions& options, const std::string& file,
                                 int* exit_code) {
  const link::LinkOptions link_options = LinkOptionsOf(options, file);
  ReportOtherFleets(options.domain, options.set.interface);
  const Interrupts interrupts;
  AdminClient client(link_options, KeyToOrderWith(options.admin_key, options.domain));
  const VehicleId vehicle{options.vehicle};
  bool reached = client.Seek({vehicle}, kOwnPatience).empty();
  if (!reached) {
    if (auto foreign = SeekForeign(link_options, vehicle)) {
      return LiveQos{"", std::move(foreign->vendor), 0, std::move(foreign->endpoints)};
    }
    reached = client.Seek({vehicle}, kAnswerPatience).empty();
  }
  if (!reached) {
    *exit_code = ReportNotReached(vehicle, options.domain);
    return std::nullopt;
  }
  const auto answer = client.AskQos(vehicle, kAnswerPatience);
  if (!answer) {
    *exit_code = ReportNoAnswer(vehicle);
    return std::nullopt;
  }
  if (answer->state == AnswerState::kRefused) {
    *exit_code = ReportRefused(*answer);
    return std::nullopt;
  }
  return LiveQos{answer->profiles.name, "", answer->fleet_size, LiveEndpoints(*answer)};
}

std::optional<QosRow> Expected(const EffectiveSet& set, const std::string& profile,
                               const std::string& policy) {
  const auto endpoint = std::ranges::find(set.endpoints, profile, &EffectiveEndpoint::profile);
  if (endpoint == set.endpoints.end()) return {};
  const auto row = std::ranges::find(endpoint->rows, policy, &QosRow::policy);
  return row == endpoint->rows.end() ? std::nullopt : std::optional(*row);
}

// The partition of a foreign vehicle is not what the set gives for partitions in general.
std::vector<LiveRow> HoldAgainst(const EffectiveSet& set, const LiveQos& live,
                                 const std::vector<std::string>& wanted) {
  std::vector<LiveRow> all;
  for (const EffectiveEndpoint& endpoint : live.endpoints) {
    const auto is_it = [&](const std::string& word) {
      return word == endpoint.profile || word == endpoint.topic;
    };
    if (!wanted.empty() && std::ranges::none_of(wanted, is_it)) continue;
    for (const QosRow& row : endpoint.rows) {
      const bool comparable = live.foreign.empty() || row.policy != "partition";
      all.push_back({endpoint.profile, row,
                     comparable ? Expected(set, endpoint.profile, row.policy) : std::nullopt});
    }
  }
  return all;
}

std::string ToText(const LiveRow& row, const std::string& own_file, const std::string& file) {
  const std::string origin = OriginText(row.live, own_file);
  return fmt::format("  {:<28} {:<24} {}{}\n", row.live.policy, row.live.value, origin,
                     row.AsExpected() ? ""
                                      : fmt::format("; not {} as by {}", row.expected->value,
                                                    OriginText(*row.expected, file)));
}

Json ToJson(const LiveRow& row) {
  Json json;
  json["profile"] = row.profile;
  json["policy"] = row.live.policy;
  json["value"] = row.live.value;
  json["origin"] = Name(row.live.origin);
  if (row.live.line > 0) json["line"] = row.live.line;
  if (row.expected) json["expected"] = row.expected->value;
  return json;
}

std::string ToJson(const QosLiveOptions& options, const std::string& file, const LiveQos& live,
                   const std::vector<LiveRow>& all) {
  Json object;
  object["vehicle"] = options.vehicle;
  object["domain"] = options.domain;
  if (live.foreign.empty()) {
    object["runs_with"] = live.runs_with;
  } else {
    object["foreign"] = live.foreign;
  }
  object["file"] = file;
  object["values"] = JsonArray(all, [](const LiveRow& row) { return ToJson(row); });
  return JsonText(std::move(object)) + "\n";
}

std::string Text(const std::string& file, const LiveQos& live, const std::vector<LiveRow>& all) {
  std::string text;
  if (!live.foreign.empty()) text = "foreign (" + live.foreign + "), as discovery reports it\n";
  std::string profile;
  for (const LiveRow& row : all) {
    if (row.profile != profile) text += row.profile + "\n";
    profile = row.profile;
    text += ToText(row, live.runs_with, file);
  }
  return text;
}

}  // namespace

int RunQosLive(const QosLiveOptions& options) {
  if (!HasStdout()) return kCouldNotRun;
  const auto expected = [&](std::uint32_t vehicles) {
    return EffectiveQosOfFile(options.set.qos_file, options.set.interface, vehicles);
  };
  EffectiveSet set = expected(options.set.vehicles);  // before any vehicle is asked
  int exit_code = 0;
  const auto live = LiveQosOf(options, set.file, &exit_code);
  if (!live) return exit_code;
  const bool other_size = live->fleet_size > 0 && live->fleet_size != options.set.vehicles;
  if (options.of_its_fleet && other_size) set = expected(live->fleet_size);
  const std::vector<LiveRow> all = HoldAgainst(set, *live, options.set.wanted);
  const std::string text = options.set.json ? ToJson(options, set.file, *live, all)
                                            : ForTerminal(Text(set.file, *live, all));
  if (!PrintAll(text)) return kCouldNotRun;
  return std::ranges::all_of(all, &LiveRow::AsExpected) ? 0 : 1;
}

}  // namespace giveway::fleetctl
