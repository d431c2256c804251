#include <fmt/format.h>

#include "services/fleetctl/output/finding_text.h"
#include "services/fleetctl/plan/plan.h"
#include "services/observer/fleet/json_object.h"

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

std::string JsonOf(const PlanRow& row) {
  JsonObject json;
  json.Add("name", std::string_view(row.name));
  json.Add("vehicle", row.vehicle);
  json.Add("host", row.host);
  json.Add("fleet", row.fleet);
  json.Add("host_has", row.limit);
  return json.Text();
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
  JsonObject json;
  json.Add("vehicles", request.vehicles);
  json.Add("hosts", request.hosts);
  json.Add("fits", report.Fits());
  if (report.fewer_vehicles) json.Add("vehicles_that_fit", *report.fewer_vehicles);
  if (report.more_hosts) json.Add("hosts_that_fit", *report.more_hosts);
  json.AddRaw("rows", JsonArray(report.rows, JsonOf));
  json.AddRaw("findings", JsonArray(report.findings,
                                    [](const qos::Finding& finding) { return ToJson(finding); }));
  return json.Text() + "\n";
}

}  // namespace giveway::fleetctl
