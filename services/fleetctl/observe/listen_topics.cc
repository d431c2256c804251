#include "services/fleetctl/observe/listen_topics.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "services/observer/fleet/sample_format.h"
#include "services/observer/fleet/sample_json.h"

namespace giveway::fleetctl {
namespace {

constexpr std::array<std::string_view, 7> kNames = {"fleet/beacon", "fleet/status", "world/roster",
                                                    "world/signal", "world/truth",  "world/event",
                                                    "world/figures"};

bool IsAmong(const std::set<VehicleId>& asked, VehicleId vehicle) {
  return asked.empty() || asked.contains(vehicle);
}
bool IsAsked(const ReceivedBeacon& received, const std::set<VehicleId>& asked) {
  return IsAmong(asked, received.beacon.vehicle);
}
bool IsAsked(const WorldEvent& event, const std::set<VehicleId>& asked) {
  return IsAmong(asked, event.vehicle) || asked.contains(event.other);
}
bool IsAsked(const SignalState&, const std::set<VehicleId>&) { return true; }
bool IsAsked(const RunFigures&, const std::set<VehicleId>&) { return true; }
bool IsAsked(const auto& sample, const std::set<VehicleId>& asked) {
  return IsAmong(asked, sample.vehicle);
}

std::vector<std::string> LinesOf(const auto& samples, const ListenFilter& filter, double heard_s) {
  std::vector<std::string> lines;
  for (const auto& sample : samples) {
    if (!IsAsked(sample, filter.vehicles)) continue;
    if (!filter.json) {
      lines.push_back(fmt::format("{:9.3f}  {}", heard_s, ToLine(sample)));
      continue;
    }
    Json object;
    object["topic"] = Name(filter.topic);
    object["heard_s"] = heard_s;
    AddFields(sample, &object);
    lines.push_back(JsonText(std::move(object)));
  }
  return lines;
}

}  // namespace

std::optional<ListenTopic> ListenTopicNamed(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return static_cast<ListenTopic>(i);
  }
  return std::nullopt;
}

std::string_view Name(ListenTopic topic) { return kNames[static_cast<std::size_t>(topic)]; }

std::string ListenTopicNames() { return fmt::format("{}", fmt::join(kNames, ", ")); }

bool IsAboutVehicles(ListenTopic topic) {
  return topic != ListenTopic::kSignal && topic != ListenTopic::kFigures;
}

std::vector<std::string> SampleLines(const link::Observed& observed, const ListenFilter& filter,
                                     double heard_s) {
  switch (filter.topic) {
    case ListenTopic::kBeacon:
      return LinesOf(observed.beacons, filter, heard_s);
    case ListenTopic::kStatus:
      return LinesOf(observed.statuses, filter, heard_s);
    case ListenTopic::kRoster:
      return LinesOf(observed.roster, filter, heard_s);
    case ListenTopic::kSignal:
      return LinesOf(observed.signals, filter, heard_s);
    case ListenTopic::kTruth:
      return LinesOf(observed.truths, filter, heard_s);
    case ListenTopic::kEvent:
      return LinesOf(observed.events, filter, heard_s);
    case ListenTopic::kFigures:
      break;
  }
  std::vector<RunFigures> figures;
  if (observed.figures) figures.push_back(*observed.figures);
  return LinesOf(figures, filter, heard_s);
}

}  // namespace giveway::fleetctl
