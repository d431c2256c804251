#include "services/fleetctl/faults/faults_show.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "services/faults/kind_table.h"
#include "services/faults/schedule_text.h"
#include "services/runtime/json.h"

namespace giveway::fleetctl {
namespace {

using faults::Fault;
using faults::KindRow;
using faults::QuantityRow;

// One line per rule with faults that were left out.
std::string LeftOutLines(const faults::Expansion& expansion, std::string_view before) {
  std::string text;
  for (const faults::LeftOut& left : expansion.left_out) {
    text += fmt::format(
        "{}{}: left out {} that another excludes, {} that would not have ended in time\n", before,
        left.rule, left.excluded, left.too_late);
  }
  return text;
}

Json FaultJson(const Fault& fault) {
  Json json;
  json["name"] = fault.rule;
  json["nth"] = fault.nth;
  json["time_s"] = fault.at_s;
  json["kind"] = faults::ToString(fault.kind);
  if (fault.target.what == faults::Target::What::kVehicle) {
    json["vehicle"] = Number(fault.target.vehicle);
  } else {
    json["target"] = faults::ToString(fault.target.what);
  }
  if (faults::RowOf(fault.kind).takes_time) json["for_s"] = fault.for_s;
  for (std::size_t i = 0; i < faults::kQuantities; ++i) {
    const auto quantity = static_cast<faults::Quantity>(i);
    json[faults::FieldOf(quantity)] = OrNull(faults::Get(fault.parameters, quantity));
  }
  if (fault.parameters.from) json["from"] = Number(*fault.parameters.from);
  if (!fault.parameters.qos.empty()) json["qos"] = fault.parameters.qos;
  return json;
}

Json LeftOutJson(const faults::LeftOut& left) {
  Json json;
  json["name"] = left.rule;
  json["excluded"] = left.excluded;
  json["too_late"] = left.too_late;
  return json;
}

Json QuantityJson(const QuantityRow& row) {
  Json json;
  json["field"] = faults::FieldOf(row.quantity);
  json["default"] = row.usual;
  json["low"] = row.low;
  json["high"] = row.high;
  return json;
}

Json KindJson(const KindRow& row) {
  Json json;
  json["kind"] = row.word;
  json["actor"] = faults::ToString(row.actor);
  for (const auto what : {faults::Target::What::kVehicle, faults::Target::What::kWorld,
                          faults::Target::What::kDiscoveryServer, faults::Target::What::kAll}) {
    if (row.Allows(what)) json["targets"].push_back(faults::ToString(what));
  }
  json["takes_time"] = row.takes_time;
  json["virtual"] = row.in_virtual_time;
  json["parameters"] = JsonArray(row.numbers, QuantityJson);
  json["takes_from"] = row.takes_from;
  if (!row.usual_qos.empty()) json["qos"] = row.usual_qos;
  json["what"] = row.what;
  return json;
}

// "probability 0.2 (0 to 0.9), count 10 (10 to 10000)".
std::string Takes(const KindRow& row) {
  std::string text;
  const auto add = [&](const std::string& item) { text += (text.empty() ? "" : ", ") + item; };
  for (const QuantityRow& taken : row.numbers) {
    add(fmt::format("{} {} ({} to {})", faults::FieldOf(taken.quantity),
                    faults::NumberText(taken.usual), faults::NumberText(taken.low),
                    faults::NumberText(taken.high)));
  }
  if (row.takes_from) add("from (id of a vehicle)");
  if (!row.usual_qos.empty()) add(fmt::format("qos \"{}\"", row.usual_qos));
  return text;
}

}  // namespace

std::string ExpansionFile(const faults::Expansion& expansion) {
  return LeftOutLines(expansion, "# ") + faults::AsTextproto(expansion.schedule);
}

std::string ExpansionText(const faults::Expansion& expansion) {
  std::string text;
  for (const Fault& fault : expansion.schedule) {
    text += fmt::format("{}  [{} {}]\n", faults::Line(fault), fault.rule, fault.nth);
  }
  return text + fmt::format("{} faults\n", expansion.schedule.size()) + LeftOutLines(expansion, "");
}

std::string ExpansionJson(const faults::Expansion& expansion) {
  Json json;
  json["faults"] = JsonArray(expansion.schedule, FaultJson);
  json["left_out"] = JsonArray(expansion.left_out, LeftOutJson);
  return JsonText(std::move(json)) + "\n";
}

std::string KindsText() {
  std::string text;
  for (const auto actor : {faults::Actor::kSupervisor, faults::Actor::kHearer,
                           faults::Actor::kWorld, faults::Actor::kAttacker}) {
    text += fmt::format("{}{}\n", text.empty() ? "" : "\n", faults::ToString(actor));
    for (const KindRow& row : faults::KindTable()) {
      if (row.actor != actor) continue;
      text += fmt::format("  {:<24}{}{}{}\n", row.word, row.what, row.takes_time ? "; for_s" : "",
                          row.in_virtual_time ? "; in virtual time too" : "");
      text += fmt::format("  {:<24}on {}\n", "", faults::TargetsOf(row));
      if (const std::string takes = Takes(row); !takes.empty()) {
        text += fmt::format("  {:<24}{}\n", "", takes);
      }
    }
  }
  return text;
}

std::string KindsJson() { return JsonText(JsonArray(faults::KindTable(), KindJson)) + "\n"; }

}  // namespace giveway::fleetctl
