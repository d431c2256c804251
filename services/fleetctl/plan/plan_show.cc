#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "services/fleetctl/output/finding_text.h"
#include "services/fleetctl/plan/plan.h"
#include "services/runtime/json.h"

namespace giveway::fleetctl {
namespace {

// A plan is accurate to three digits at most.
std::string Cell(const std::optional<double>& value) {
  if (!value) return "-";
  return *value >= 100 ? fmt::format("{:.0f}", *value) : fmt::format("{:.3g}", *value);
}

std::string WhatFits(const PlanReport& report) {
  std::string text;
  if (report.fewer_vehicles) text += fmt::format("{} vehicles", *report.fewer_vehicles);
  if (report.more_hosts) {
    text += fmt::format("{}{} hosts", text.empty() ? "" : ", or ", *report.more_hosts);
  }
  return text.empty() ? "" : "What would fit: " + text + ".\n";
}

Json JsonOf(const PlanRow& row) {
  Json json;
  json["name"] = row.name;
  json["vehicle"] = OrNull(row.vehicle);
  json["host"] = OrNull(row.host);
  json["fleet"] = OrNull(row.fleet);
  json["host_has"] = OrNull(row.limit);
  return json;
}

}  // namespace

std::string ToText(const PlanRequest& request, const PlanReport& report) {
  std::string text = fmt::format("{} vehicles, the world and an observer on {} host{}\n\n",
                                 request.vehicles, request.hosts, request.hosts == 1 ? "" : "s");
  text += fmt::format("  {:<30}{:>10}{:>14}{:>10}{:>10}\n", "", "a vehicle", "busiest host",
                      "fleet", "host has");
  for (const PlanRow& row : report.rows) {
    text += fmt::format("  {:<30}{:>10}{:>14}{:>10}{:>10}\n", row.name, Cell(row.vehicle),
                        Cell(row.host), Cell(row.fleet), Cell(row.limit));
  }
  text += "\n";
  for (const qos::Finding& finding : report.findings) text += ToText(finding, "plan");
  text += report.Fits() ? "It fits.\n" : "It does not fit.\n";
  return text + (report.Fits() ? "" : WhatFits(report));
}

std::string ToJson(const PlanRequest& request, const PlanReport& report) {
  Json json;
  json["vehicles"] = request.vehicles;
  json["hosts"] = request.hosts;
  json["fits"] = report.Fits();
  json["vehicles_that_fit"] = OrNull(report.fewer_vehicles);
  json["hosts_that_fit"] = OrNull(report.more_hosts);
  json["rows"] = JsonArray(report.rows, JsonOf);
  json["findings"] = ToJson(report.findings);
  return JsonText(std::move(json)) + "\n";
}

}  // namespace giveway::fleetctl
