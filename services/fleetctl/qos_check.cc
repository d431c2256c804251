#include "services/fleetctl/qos_check.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>

#include "services/app/json_line.h"
#include "services/app/scenario_file.h"
#include "services/app/utf8.h"
#include "services/fleetctl/qos_files.h"

namespace giveway::fleetctl {
namespace {

constexpr int kCouldNotRun = 2;

std::string Name(qos::Severity severity) {
  return severity == qos::Severity::kError ? "error" : "warning";
}

// What a file holds must not command the terminal it is shown on.
std::string Shown(std::string text) {
  text = app::WellFormed(text);
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return text;
}

std::string ToText(const qos::Finding& finding) {
  std::string where = finding.place.file.empty() ? "environment" : finding.place.file;
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

std::string Counted(std::size_t count, const char* thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

std::size_t Count(const qos::Findings& findings, qos::Severity severity) {
  return static_cast<std::size_t>(std::ranges::count(findings, severity, &qos::Finding::severity));
}

void Print(const qos::Findings& findings, std::size_t files, bool json) {
  const std::size_t errors = Count(findings, qos::Severity::kError);
  const std::size_t warnings = Count(findings, qos::Severity::kWarning);
  std::string text;
  for (const qos::Finding& finding : findings) {
    if (json && !text.empty()) text += ",";
    text += json ? ToJson(finding) : ToText(finding);
  }
  if (json) {
    text = fmt::format(R"({{"errors":{},"warnings":{},"findings":[{}]}})", errors, warnings, text);
  } else {
    text += fmt::format("{}, {}, {}", Counted(files, "file"), Counted(errors, "error"),
                        Counted(warnings, "warning"));
  }
  std::puts(text.c_str());
}

qos::Deployment DeploymentOf(const QosCheckOptions& options) {
  qos::Deployment deployment;
  deployment.complete = !options.partial;
  if (!options.scenario.empty()) {
    const Scenario scenario = app::LoadScenario(options.scenario, {});
    deployment.vehicles =
        static_cast<std::int64_t>(scenario.vehicles.size() + scenario.spawns.size());
    deployment.signals = static_cast<std::int64_t>(scenario.signals.size());
    deployment.tick_ns = scenario.tick_period.count();
  }
  if (options.vehicles) deployment.vehicles = *options.vehicles;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    deployment.environment.emplace_back(*variable);
  }
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(".", error)) {
    deployment.folder_files.push_back(entry.path().filename());
  }
  return deployment;
}

int Check(const QosCheckOptions& options) {
  const qos::Deployment deployment = DeploymentOf(options);
  std::vector<std::string> arguments = options.files;
  if (arguments.empty()) arguments.emplace_back();
  qos::Findings findings;
  std::vector<qos::ProfileFile> files;
  for (const std::string& argument : arguments) {
    auto read = ReadQosFile(ResolveQosFile(argument));
    if (auto* why = std::get_if<qos::Finding>(&read)) findings.push_back(std::move(*why));
    if (auto* file = std::get_if<qos::ProfileFile>(&read)) files.push_back(std::move(*file));
  }
  std::ranges::move(qos::Check(files, deployment), std::back_inserter(findings));
  Print(findings, arguments.size(), options.json);
  return std::fflush(stdout) == 0 ? qos::ExitCode(findings) : kCouldNotRun;
}

}  // namespace

int RunQosCheck(const QosCheckOptions& options) {
  try {
    return Check(options);
  } catch (const std::exception& error) {  // InputError, out of memory
    std::fprintf(stderr, "%s\n", error.what());
    if (options.json) {
      Print({{qos::Severity::kError,
              "could_not_run",
              {},
              "",
              error.what(),
              "Nothing was checked.",
              "correct what is named"}},
            0, true);
    }
    return kCouldNotRun;
  }
}

}  // namespace giveway::fleetctl
