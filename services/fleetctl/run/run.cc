#include "services/fleetctl/run/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include "services/config/config_dir.h"
#include "services/config/impair.h"
#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/config/writing/scenario_edit.h"
#include "services/faults/schedule_text.h"
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
#include "services/fleetctl/run/run_faults.h"
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
  return PrintAll(text.ends_with('\n') ? text : text + '\n');
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
  std::string File(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

Impairment ImpairmentOf(const RunOptions& options, const Scenario& scenario) {
  return options.fleet.impair.empty() ? scenario.impairment
                                      : ParseImpairment(options.fleet.impair).impairment;
}

// In lockstep the world waits for every command, and a vehicle answers only scans. Faults of what
// is heard leave scans alone.
void RefuseImpairedLockstep(const RunOptions& options, const Scenario& scenario) {
  if (!options.fleet.lockstep || ImpairmentOf(options, scenario).rules.empty()) return;
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

// Faults of what vehicles hear are rules for each, by times that count from its start; newcomers
// next to named vehicles are given none, nor what --impair says for all.
void RefuseUnheardOf(const RunOptions& options, const Scenario& scenario, const RunFaults& faults) {
  if (faults.heard.empty()) return;
  std::vector<Problem> problems;
  if (options.restart) {
    problems.push_back({options.scenario, 0, "--restart", "",
                        "a restarted vehicle would count the times of its faults again",
                        "leave --restart out, or use fleetctl soak"});
  }
  const bool has_unnamed = !scenario.vehicles.empty() && NewcomerCount(options.fleet, scenario) > 0;
  if (has_unnamed && !options.fleet.impair.empty()) {
    problems.push_back({options.scenario, 0, "--impair", options.fleet.impair,
                        "newcomers would not be given it next to faults of named vehicles",
                        "write it into the scenario, as impair"});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

// The vehicles that faults may meet: those of the scenario, or where it names none those that ask
// for the ids 1, 2, 3 ..., see FleetSpec::names_newcomers. Next to named ones they would ask for
// ids that are taken.
std::vector<VehicleId> FleetOf(const RunOptions& options, const Scenario& scenario) {
  std::vector<VehicleId> fleet;
  for (const VehicleOptions& vehicle : scenario.vehicles) fleet.push_back(vehicle.id);
  if (!fleet.empty()) return fleet;
  for (std::uint32_t id = 1; id <= NewcomerCount(options.fleet, scenario); ++id) {
    fleet.push_back(VehicleId{id});
  }
  return fleet;
}

// Every process reads files that hold its share of the list, as in a soak.
void CarryOut(const RunFaults& faults, const RunOptions& options, const ScratchFolder& scratch,
              FleetSpec* spec) {
  spec->scenario_file = scratch.File("scenario.textproto");
  WriteFile(spec->scenario_file,
            EditScenario(options.scenario, {.keep_faults = false, .kills = faults.kills}));
  if (!faults.worlds.empty()) {
    const std::string file = scratch.File("faults_of_world.textproto");
    WriteFile(file, faults::AsTextproto(faults.worlds));
    std::vector<std::string>& words = spec->extra_words[kTheWorld];
    words.insert(words.end(), {"--faults", file});
  }
  if (!faults.heard.empty()) spec->options.impair.clear();  // it is part of what each is given
  for (const auto& [vehicle, impairment] : faults.heard) {
    const std::string file = scratch.File(fmt::format("vehicle-{}.impair", Number(vehicle)));
    WriteFile(file, ImpairmentText(impairment) + "\n");
    spec->extra_words[MemberOf(vehicle)] = {"--impair", "@" + file};
  }
}

// On a slow disk.
unsigned SecondsToCopy(const std::vector<std::string>& files) {
  constexpr std::uintmax_t kBytesPerSecond = 10'000'000;
  std::uintmax_t bytes = 0;
  for (const std::string& file : files) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (!error) bytes += size;
  }
  return static_cast<unsigned>(bytes / kBytesPerSecond);
}

int StartAndWatch(const RunOptions& options) {
  const ScenarioOverrides overrides{options.fleet.seed, options.fleet.behaviour,
                                    options.fleet.duration_s};
  const auto [scenario, own_faults] = LoadScenarioWithFaults(options.scenario, overrides);
  RefuseVehiclesWithoutPlace(options.scenario, options.fleet.vehicles, scenario);
  RefuseImpairedLockstep(options, scenario);
  RefuseRestartOfClosed(options, scenario);
  std::optional<RunFaults> faults;
  if (own_faults) {
    faults = FaultsOfRun(*own_faults, scenario, FleetOf(options, scenario),
                         ImpairmentOf(options, scenario));
    RefuseUnheardOf(options, scenario, *faults);
  }
  const std::string qos_file = ResolveQosFile(options.qos_file);
  static_cast<void>(ReadSoundQos(qos_file, DeploymentOf(scenario)));
  for (const std::string& file : {options.picture_file, options.html_file}) {
    if (!file.empty()) CheckWritable(file);
  }
  if (!options.fleet.logs_folder.empty()) CheckFolder(options.fleet.logs_folder);
  if (!options.fleet.record_folder.empty()) CheckFolder(options.fleet.record_folder);

  const DomainLock lock(options.domain);
  const ScratchFolder scratch(options.restart || faults);
  const RunKey key(options.fleet.admin_key, lock.Domain());
  FleetSpec spec{.program_folder = ProgramFolder(),
                 .scenario_file = ResolveScenario(options.scenario),
                 .domain = lock.Domain(),
                 .qos_file = qos_file,
                 .lock_fd = lock.Fd(),
                 .hands_on_lines = true,
                 // A restarted newcomer keeps its identity, and faults name theirs.
                 .names_newcomers = options.restart || (faults && scenario.vehicles.empty()),
                 .options = options.fleet};
  if (options.restart) spec.extra_words[kTheWorld] = {"--checkpoint", scratch.File("checkpoint")};
  if (faults) CarryOut(*faults, options, scratch, &spec);
  spec.options.admin_key = key.File();
  std::fprintf(stderr, "%s on domain %u\n", scenario.name.c_str(), lock.Domain());
  const auto started = std::filesystem::file_time_type::clock::now();
  RunSession session(options, scenario, spec);
  const Report report = session.Run();

  const bool printed = Print(options, report);
  if (!printed) std::fprintf(stderr, "cannot write the verdict to stdout\n");
  const auto brains = BrainRecordings(options.fleet.record_folder, started);
  Interrupts::AllowSeconds(kDrawing_s + SecondsToCopy(brains));
  const bool recorded = session.FinishTopics(brains);
  Interrupts::AllowSeconds(kDrawing_s);
  const int code = std::max(ExitCode(report.verdict), printed && recorded ? 0 : 1);
  // Each by itself: one that cannot be written does not cost the other.
  const int with_picture = WriteAfterVerdict(code, [&] {
    if (!options.picture_file.empty()) WriteFile(options.picture_file, session.DrawPicture(report));
  });
  return WriteAfterVerdict(with_picture, [&] {
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
