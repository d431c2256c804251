#include "services/fleetctl/finding_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "services/app/json_line.h"
#include "services/app/utf8.h"

namespace giveway::fleetctl {
namespace {

std::string Name(qos::Severity severity) {
  return severity == qos::Severity::kError ? "error" : "warning";
}

}  // namespace

std::string Shown(std::string text) {
  text = app::WellFormed(text);
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return text;
}

std::string ToText(const qos::Finding& finding, const std::string& nowhere) {
  std::string where = finding.place.file.empty() ? nowhere : finding.place.file;
  if (finding.place.line > 0) where += fmt::format(":{}", finding.place.line);
  const std::string subject = finding.subject.empty() ? "" : finding.subject + ": ";
  return fmt::format("{}\n    {}\n    Remedy: {}\n",
                     Shown(fmt::format("{}: {}: {}: {}{}", where, Name(finding.severity),
                                       finding.rule, subject, finding.values)),
                     Shown(finding.consequence), Shown(finding.remedy));
}

std::string ToJson(const qos::Finding& finding) {
  return fmt::format(
      R"({{"severity":"{}","rule":"{}","file":{},"line":{},"subject":{},"values":{},)"
      R"("consequence":{},"remedy":{}}})",
      Name(finding.severity), finding.rule, app::JsonString(finding.place.file), finding.place.line,
      app::JsonString(finding.subject), app::JsonString(finding.values),
      app::JsonString(finding.consequence), app::JsonString(finding.remedy));
}

}  // namespace giveway::fleetctl
