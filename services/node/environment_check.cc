#include "services/node/environment_check.h"

#include <unistd.h>

#include "services/qos/qos_rules.h"
#include "services/runtime/process.h"
#include "services/runtime/utf8.h"

namespace giveway {
namespace {

std::string LineOf(const qos::Finding& finding) {
  std::string line = "environment: " + finding.subject + ": " + finding.values;
  line += (line.ends_with('?') ? " " : ": ") + finding.consequence;
  if (line.ends_with('.')) line.pop_back();
  return Printable(line + "; " + finding.remedy);
}

}  // namespace

std::vector<std::string> EnvironmentWarnings(const std::vector<std::string>& variables) {
  qos::Findings findings;
  for (const std::string& variable : variables) {
    qos::CheckVariable(variable.substr(0, variable.find('=')), {}, "is set", &findings);
  }
  std::vector<std::string> lines;
  for (const qos::Finding& finding : findings) lines.push_back(LineOf(finding));
  return lines;
}

void WarnOfEnvironment() {
  std::vector<std::string> variables;
  for (char** at = environ; at != nullptr && *at != nullptr; ++at) variables.emplace_back(*at);
  for (const std::string& line : EnvironmentWarnings(variables)) LogWarning(line);
}

}  // namespace giveway
