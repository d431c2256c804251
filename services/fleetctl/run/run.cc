#include "services/fleetctl/run/run.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "services/config/config_dir.h"
#include "services/config/impair.h"
#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/fleetctl/args/places.h"
#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/output/live_screen.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/output/terminal_text.h"
#include "services/fleetctl/process/child_process.h"
#include "services/fleetctl/process/domain_lock.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/process/run_key.h"
#include "services/fleetctl/run/run_session.h"
#include "services/report/report.h"
#include "services/runtime/terminal_size.h"

namespace giveway::fleetctl {
namespace {

constexpr unsigned kDrawing_s = 30;

// False if it could not be written to stdout: then the verdict is lost.
bool Print(const RunOptions& options, const Report& report) {
  const std::string text =
      options.json ? ToJson(report) : ForTerminal(ToTable(report, SizeOfTerminal().columns));
  std::fputs(text.c_str(), stdout);
  if (!text.ends_with('\n')) std::fputc('\n', stdout);
  return std::fflush(stdout) == 0;
}

int RefuseToRun(const RunOptions& options, const char* reason, const std::exception& why) {
  std::fprintf(stderr, "%s\n", why.what());
  if (options.json) {
    Report report;
    report.scenario = options.scenario;
    report.reason = reason;
    report.seed = options.fleet.seed.value_or(0);
    report.domain = options.domain.value_or(0);
    Print(options, report);
  }
  return kCouldNotRun;
}

// For files that are needed only during the run.
class ScratchFolder {
 public:
  explicit ScratchFolder(bool wanted) {
    if (!wanted) return;
    std::string name = std::filesystem::temp_directory_path() / "giveway_run_XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) throw OutputError("cannot make a folder: " + name);
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code error;
    if (!path_.empty()) std::filesystem::remove_all(path_, error);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::string File(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

// In lockstep the world waits for every command, and a vehicle answers only scans.
void RefuseImpairedLockstep(const RunOptions& options, const Scenario& scenario) {
  const Impairment impairment = options.fleet.impair.empty()
                                    ? scenario.impairment
                                    : ParseImpairment(options.fleet.impair).impairment;
  if (!options.fleet.lockstep || impairment.rules.empty()) return;
  throw InputError({{options.scenario, 0, "--lockstep", "",
                     "the world would wait for ever for the answer to a scan that is lost",
                     "leave --lockstep out, or give --impair none"}});
}

// The world of a closed fleet ends the run when one of its vehicles dies.
void RefuseRestartOfClosed(const RunOptions& options, const Scenario& scenario) {
  if (!options.restart || !scenario.spawns.empty()) return;
  throw InputError({{options.scenario, 0, "--restart", "",
                     "the scenario names all of its vehicles: a death is the end of its run",
                     "leave --restart out, or write spawn { ... } in the scenario"}});
}

int StartAndWatch(const RunOptions& options) {
  const ScenarioOverrides overrides{options.fleet.seed, options.fleet.behaviour,
                                    options.fleet.duration_s};
  const Scenario scenario = LoadScenario(options.scenario, overrides);
  RefuseVehiclesWithoutPlace(options.scenario, options.fleet.vehicles, scenario);
  RefuseImpairedLockstep(options, scenario);
  RefuseRestartOfClosed(options, scenario);
  const std::string qos_file = ResolveQosFile(options.qos_file);
  static_cast<void>(ReadSoundQos(qos_file, DeploymentOf(scenario)));
  for (const std::string& file : {options.picture_file, options.html_file}) {
    if (!file.empty()) CheckWritable(file);
  }
  if (!options.fleet.logs_folder.empty()) CheckFolder(options.fleet.logs_folder);
  if (!options.fleet.record_folder.empty()) CheckFolder(options.fleet.record_folder);

  const DomainLock lock(options.domain);
  const ScratchFolder scratch(options.restart);
  const RunKey key(options.fleet.admin_key, lock.Domain());
  FleetSpec spec{.program_folder = ProgramFolder(),
                 .scenario_file = ResolveScenario(options.scenario),
                 .domain = lock.Domain(),
                 .qos_file = qos_file,
                 .lock_fd = lock.Fd(),
                 .hands_on_lines = true,
                 .names_newcomers = options.restart,  // a restarted newcomer keeps its identity
                 .options = options.fleet};
  if (options.restart) spec.extra_words[kTheWorld] = {"--checkpoint", scratch.File("checkpoint")};
  spec.options.admin_key = key.File();
  std::fprintf(stderr, "%s on domain %u\n", scenario.name.c_str(), lock.Domain());
  const auto started = std::filesystem::file_time_type::clock::now();
  RunSession session(options, scenario, spec);
  const Report report = session.Run();

  const bool printed = Print(options, report);
  if (!printed) std::fprintf(stderr, "cannot write the verdict to stdout\n");
  const bool recorded = session.FinishTopics(BrainRecordings(options.fleet.record_folder, started));
  const int code = std::max(ExitCode(report.verdict), printed && recorded ? 0 : 1);
  if (options.picture_file.empty() && options.html_file.empty()) return code;
  Interrupts::AllowSeconds(kDrawing_s);
  return WriteAfterVerdict(code, [&] {
    if (!options.picture_file.empty()) WriteFile(options.picture_file, session.DrawPicture());
    if (!options.html_file.empty()) WriteFile(options.html_file, session.DrawPage());
  });
}

}  // namespace

int Run(const RunOptions& options) {
  try {
    return StartAndWatch(options);
  } catch (const InputError& error) {
    return RefuseToRun(options, "bad_input", error);
  } catch (const OutputError& error) {
    return RefuseToRun(options, "unwritable_output", error);
  } catch (const DomainError& error) {
    return RefuseToRun(options, "no_domain", error);
  } catch (const std::exception& error) {  // LinkError, StartError, out of memory
    return RefuseToRun(options, "could_not_start", error);
  }
}

}  // namespace giveway::fleetctl
