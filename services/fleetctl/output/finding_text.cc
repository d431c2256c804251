#include "services/fleetctl/output/finding_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "services/runtime/json.h"
#include "services/runtime/utf8.h"

namespace giveway::fleetctl {
namespace {

std::string Name(qos::Severity severity) {
  return severity == qos::Severity::kError ? "error" : "warning";
}

std::size_t Count(const qos::Findings& findings, qos::Severity severity) {
  return static_cast<std::size_t>(std::ranges::count(findings, severity, &qos::Finding::severity));
}

}  // namespace

std::string ToText(const qos::Finding& finding, const std::string& nowhere) {
  std::string where = finding.place.file.empty() ? nowhere : finding.place.file;
  if (finding.place.line > 0) where += fmt::format(":{}", finding.place.line);
  const std::string subject = finding.subject.empty() ? "" : finding.subject + ": ";
  return fmt::format("{}\n    {}\n    Remedy: {}\n",
                     Printable(fmt::format("{}: {}: {}: {}{}", where, Name(finding.severity),
                                           finding.rule, subject, finding.values)),
                     Printable(finding.consequence), Printable(finding.remedy));
}

Json ToJson(const qos::Finding& finding) {
  Json json;
  json["severity"] = Name(finding.severity);
  json["rule"] = finding.rule;
  json["file"] = finding.place.file;
  json["line"] = finding.place.line;
  json["subject"] = finding.subject;
  json["values"] = finding.values;
  json["consequence"] = finding.consequence;
  json["remedy"] = finding.remedy;
  return json;
}

Json ToJson(const qos::Findings& findings) {
  return JsonArray(findings, [](const qos::Finding& finding) { return ToJson(finding); });
}

std::string Counted(std::size_t count, std::string_view one, std::string_view many) {
  if (count != 1 && !many.empty()) return fmt::format("{} {}", count, many);
  return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
}

std::string Tally(const qos::Findings& findings) {
  return Counted(Count(findings, qos::Severity::kError), "error") + ", " +
         Counted(Count(findings, qos::Severity::kWarning), "warning");
}

void AddFindings(const qos::Findings& findings, Json* to) {
  (*to)["errors"] = Count(findings, qos::Severity::kError);
  (*to)["warnings"] = Count(findings, qos::Severity::kWarning);
  (*to)["findings"] = ToJson(findings);
}

}  // namespace giveway::fleetctl
