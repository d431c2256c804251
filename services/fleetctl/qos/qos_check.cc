#include "services/fleetctl/qos/qos_check.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/output/finding_text.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/output/terminal_text.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/qos/compose_text.h"
#include "services/runtime/json.h"
#include "services/runtime/whole_file.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

// False if stdout did not take all of it.
bool Print(const qos::Findings& findings, std::size_t files, bool json) {
  std::string text;
  if (json) {
    Json object;
    AddFindings(findings, &object);
    text = JsonText(std::move(object));
  } else {
    for (const qos::Finding& finding : findings) text += ToText(finding);
    text += Counted(files, "file") + ", " + Tally(findings);
  }
  return PrintAll((json ? text : ForTerminal(text)) + "\n");
}

qos::Deployment DeploymentOf(const QosCheckOptions& options) {
  qos::Deployment deployment;
  if (!options.scenario.empty()) {
    deployment = fleetctl::DeploymentOf(LoadScenario(options.scenario, {}));
  }
  deployment.complete = !options.partial;
  if (options.vehicles) deployment.vehicles = *options.vehicles;
  deployment.environment = OwnEnvironment();
  deployment.folder_files = NamesIn(".");
  return deployment;
}

// What is checked together, and the files that could not be read.
struct Checked {
  std::vector<qos::ProfileFile> files;
  std::vector<qos::ComposeSet> given;
  qos::Findings findings;
  std::size_t named = 0;  // files, read or not

  // The index of the file among `files`; nullopt if it cannot be read.
  std::optional<std::size_t> Add(const std::string& path);
};

std::optional<std::size_t> Checked::Add(const std::string& path) {
  const auto known = std::ranges::find(files, path, &qos::ProfileFile::name);
  if (known != files.end()) return known - files.begin();
  ++named;
  auto read = ReadQosFile(path);
  if (auto* why = std::get_if<qos::Finding>(&read)) {
    findings.push_back(std::move(*why));
    return std::nullopt;
  }
  files.push_back(std::move(std::get<qos::ProfileFile>(read)));
  return files.size() - 1;
}

// The set that a service names inside its container: mounted from here, or a shipped one.
std::optional<std::string> SetOf(const qos::ComposeService& service, const fs::path& folder) {
  const std::string mounted = qos::HostPath(service, service.qos);
  if (!mounted.empty()) return (folder / mounted).lexically_normal().string();
  if (service.qos.find('/') == std::string::npos) return ResolveQosFile(service.qos);
  const std::string name = fs::path(service.qos).stem();
  const std::string shipped = ResolveQosFile(name);
  return shipped == name ? std::nullopt : std::optional(shipped);
}

void AddServices(const std::vector<qos::ComposeService>& services, const fs::path& folder,
                 Checked* checked) {
  for (const qos::ComposeService& service : services) {
    const std::optional<std::string> path = SetOf(service, folder);
    if (!path) {
      checked->findings.push_back({qos::Severity::kError, "qos_not_mounted", service.qos_place,
                                   service.name, service.qos + " is in no volume of the service",
                                   "The service does not find it and does not start.",
                                   "mount it, or name a shipped set"});
      continue;
    }
    if (const auto file = checked->Add(*path)) checked->given.push_back({*file, service});
  }
}

// What compose puts into a file of that folder: this shell's variables, then those of its .env.
std::vector<std::string> VariablesFor(const fs::path& folder, std::vector<std::string> own) {
  std::ranges::move(qos::EnvFileVariables(ReadWholeFile(folder / ".env").value_or("")),
                    std::back_inserter(own));
  return own;
}

// The services of the compose file, with their sets; the number of vehicles goes to `deployment`.
void AddCompose(const QosCheckOptions& options, qos::Deployment* deployment, Checked* checked) {
  auto read = ReadQosFile(options.compose);
  ++checked->named;
  if (auto* why = std::get_if<qos::Finding>(&read)) {
    checked->findings.push_back(std::move(*why));
    return;
  }
  const std::vector<std::string> variables =
      VariablesFor(fs::path(options.compose).parent_path(), deployment->environment);
  qos::ComposeRead compose =
      qos::ReadCompose(std::get<qos::ProfileFile>(read).bytes, options.compose, variables);
  std::ranges::move(compose.findings, std::back_inserter(checked->findings));
  qos::CheckCompose(compose.services, &checked->findings);
  AddServices(compose.services, fs::path(options.compose).parent_path(), checked);
  std::int64_t vehicles = 0;
  for (const qos::ComposeService& service : compose.services) {
    vehicles += service.is_vehicle ? service.containers : 0;
  }
  if (vehicles > 0 && !options.vehicles) deployment->vehicles = vehicles;
}

int Check(const QosCheckOptions& options) {
  qos::Deployment deployment = DeploymentOf(options);
  Checked checked;
  for (const std::string& file : options.files) checked.Add(ResolveQosFile(file));
  if (!options.compose.empty()) {
    AddCompose(options, &deployment, &checked);
  } else if (options.files.empty()) {
    checked.Add(ResolveQosFile(""));
  }
  qos::Findings findings = std::move(checked.findings);
  std::ranges::move(qos::Check(checked.files, deployment, checked.given),
                    std::back_inserter(findings));
  const bool printed = Print(findings, checked.named, options.json);
  return printed ? qos::ExitCode(findings) : kCouldNotRun;
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
