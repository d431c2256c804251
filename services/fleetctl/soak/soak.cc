#include "services/fleetctl/soak/soak.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <cstdio>
#include <filesystem>
#include <thread>

#include "services/config/faults/faults_file.h"
#include "services/config/impair.h"
#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/config/writing/scenario_edit.h"
#include "services/faults/hearing.h"
#include "services/faults/kind_table.h"
#include "services/faults/schedule_text.h"
#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/process/child_process.h"
#include "services/fleetctl/process/domain_lock.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/soak/soak_draw.h"
#include "services/fleetctl/soak/soak_json.h"
#include "services/fleetctl/soak/soak_page.h"
#include "services/fleetctl/soak/soak_session.h"
#include "services/fleetctl/soak/soak_verdict.h"
#include "services/fleetctl/stopwatch/stopwatch_limits.h"
#include "services/link/fastdds/library_release.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kWriting_s = 60;

// What is run, from files and flags; every process reads the scenario that is written here.
struct Prepared {
  std::string scenario_file;
  std::string faults_file;  // the concrete list
  std::string qos_file;
  Scenario scenario;
  std::vector<VehicleId> fleet;
  faults::Schedule schedule;
  std::vector<std::string> skipped;
  SoakPhases phases;
  std::uint32_t newcomers = 0;
};

// The world's faults need a world that takes them, the hearers' an impairment: always. An attacker
// is a program of the tests.
const char* WhyNot(const faults::Fault& fault) {
  switch (faults::ActorOf(fault.kind)) {
    case faults::Actor::kSupervisor:
      return ProcessFaults::WhyNot(fault);
    case faults::Actor::kAttacker:
      return "attackers are started by the tests alone";
    case faults::Actor::kHearer:
    case faults::Actor::kWorld:
      break;
  }
  return nullptr;
}

std::string InWords(const faults::Fault& fault) {
  return fmt::format("{}#{} ({} of {} at {:.1f} s)", fault.rule, fault.nth,
                     faults::ToString(fault.kind), faults::ToString(fault.target), fault.at_s);
}

// Refuses what cannot be carried out here, all at once; or leaves it out and says so.
void Sift(const SoakOptions& options, Prepared* prepared) {
  std::vector<Problem> problems;
  std::erase_if(prepared->schedule, [&](const faults::Fault& fault) {
    const char* const why = WhyNot(fault);
    if (why == nullptr) return false;
    if (options.skip_unsupported) {
      prepared->skipped.push_back(InWords(fault) + ": " + why);
    } else {
      problems.push_back({options.faults, 0, fault.rule, std::string(faults::ToString(fault.kind)),
                          fmt::format("cannot be carried out here: {}", why),
                          "take the rule out, or give --skip-unsupported"});
    }
    return true;
  });
  if (!problems.empty()) throw InputError(std::move(problems));
}

Scenario LoadAndCheck(const SoakOptions& options) {
  const Scenario scenario =
      LoadScenario(options.scenario, {options.seed, std::nullopt, std::nullopt});
  if (options.vehicles && scenario.spawns.empty()) {
    throw InputError({{options.scenario, 0, "", "",
                       "--vehicles was given, but the scenario names all of its vehicles",
                       "leave --vehicles out, or write spawn { ... } in the scenario"}});
  }
  return scenario;
}

Prepared Prepare(const SoakOptions& options) {
  Prepared prepared;
  const Scenario as_shipped = LoadAndCheck(options);
  const auto places = static_cast<std::uint32_t>(as_shipped.spawns.size());
  prepared.newcomers = options.vehicles.value_or(places);
  const std::size_t vehicles = as_shipped.vehicles.size() + prepared.newcomers;
  prepared.phases = PhasesOf(options.duration_s, vehicles);
  prepared.qos_file = ResolveQosFile(options.qos_file);
  RequireSoundQos(prepared.qos_file, DeploymentOf(as_shipped));

  const faults::Course course{options.seed, options.duration_s, prepared.phases.faults_from_s,
                              prepared.phases.end_s - prepared.phases.faults_until_s};
  prepared.fleet = SoakFleet(as_shipped, prepared.newcomers);
  prepared.schedule = LoadAndExpandFaults(options.faults, course, prepared.fleet).schedule;
  Sift(options, &prepared);

  CheckFolder(options.report_folder);
  const fs::path folder(options.report_folder);
  CheckFolder((folder / "logs").string());
  CheckFolder((folder / "impair").string());
  if (options.record) CheckFolder((folder / "recordings").string());
  // All begin together, so that everyone's clock of faults is the same.
  ScenarioEdit edit{.duration_s = 0.0};
  if (!as_shipped.spawns.empty()) edit.start_with = static_cast<std::uint32_t>(vehicles);
  prepared.scenario_file = (folder / "scenario.textproto").string();
  WriteFile(prepared.scenario_file, EditScenario(options.scenario, edit));
  prepared.faults_file = (folder / "faults.textproto").string();
  WriteFile(prepared.faults_file, faults::AsTextproto(prepared.schedule));
  prepared.scenario =
      LoadScenario(prepared.scenario_file, {options.seed, std::nullopt, std::nullopt});
  return prepared;
}

FleetSpec SpecOf(const SoakOptions& options, const Prepared& prepared, const DomainLock& lock) {
  const fs::path folder(options.report_folder);
  FleetSpec spec{.program_folder = ProgramFolder(),
                 .scenario_file = prepared.scenario_file,
                 .domain = lock.Domain(),
                 .qos_file = prepared.qos_file,
                 .lock_fd = lock.Fd(),
                 .hands_on_lines = true,
                 .names_newcomers = true,
                 .stagger = std::chrono::milliseconds(100)};
  spec.options.seed = options.seed;
  spec.options.interface = options.interface;
  spec.options.vehicles = prepared.newcomers;
  spec.options.logs_folder = (folder / "logs").string();
  if (options.record) spec.options.record_folder = (folder / "recordings").string();
  spec.extra_words[kTheWorld] = {"--checkpoint", (folder / "world.checkpoint").string(), "--faults",
                                 prepared.faults_file};
  for (const VehicleId vehicle : prepared.fleet) {
    spec.extra_words[MemberOf(vehicle)] = {"--stay", "--hang-on-signal", "--log-format", "json"};
  }
  return spec;
}

// In a file: hours of faults are longer than a command line may be.
std::string ImpairFlag(const fs::path& folder, VehicleId vehicle, const Impairment& impairment) {
  const fs::path file = folder / fmt::format("vehicle-{}.impair", Number(vehicle));
  WriteFile(file.string(), ImpairmentText(impairment) + "\n");
  return "@" + file.string();
}

FaultTools ToolsOf(const SoakOptions& options, const FleetSpec& spec, const Prepared& prepared) {
  FaultTools tools;
  tools.commands = MakeCommands(spec, prepared.scenario);
  tools.fleetctl = (spec.program_folder / "fleetctl").string();
  tools.domain = spec.domain;
  tools.interface = spec.options.interface;
  const fs::path folder = fs::path(options.report_folder) / "impair";
  tools.impairment_since = [&prepared, folder](VehicleId vehicle, double since_s) {
    const auto impaired = faults::ImpairmentOf(prepared.schedule, prepared.fleet, since_s);
    const auto found = impaired.find(vehicle);
    return found == impaired.end() ? std::string() : ImpairFlag(folder, vehicle, found->second);
  };
  for (MemberCommand& command : tools.commands) {
    if (command.member == kTheWorld) continue;
    const std::string impair = tools.impairment_since(VehicleId{command.member.number}, 0);
    if (!impair.empty()) SetFlag(&command.child.words, "--impair", impair);
  }
  return tools;
}

std::string CommandLine(const SoakOptions& options) {
  std::string line = fmt::format(
      "fleetctl soak {} --faults {} --duration {:g} --seed {} --report {}", options.scenario,
      options.faults, options.duration_s, options.seed, options.report_folder);
  if (options.vehicles) line += fmt::format(" --vehicles {}", *options.vehicles);
  if (!options.qos_file.empty()) line += " --qos " + options.qos_file;
  if (options.skip_unsupported) line += " --skip-unsupported";
  if (options.record) line += " --record";
  return line;
}

// "2.9.1" of "Fast DDS 2.9.1".
std::string WithoutName(std::string_view library) {
  return std::string(library.substr(library.rfind(' ') + 1));
}

SoakResult BlankResult(const SoakOptions& options, const Prepared& prepared, std::uint32_t domain) {
  SoakResult result;
  result.scenario = prepared.scenario.name;
  result.seed = options.seed;
  result.planned_s = options.duration_s;
  result.vehicles =
      static_cast<std::uint32_t>(prepared.scenario.vehicles.size()) + prepared.newcomers;
  result.domain = domain;
  result.faults_file = options.faults;
  result.qos_set = prepared.qos_file;
  result.skipped_faults = prepared.skipped;
  result.command = CommandLine(options);
  utsname system{};
  if (::uname(&system) == 0) result.versions.kernel = system.release;
  result.versions.fast_dds = WithoutName(link::LibraryName());
  result.versions.host_cores = std::thread::hardware_concurrency();
  return result;
}

const VehicleOptions& AnyVehicle(const Scenario& scenario) {
  return scenario.spawns.empty() ? scenario.vehicles.front() : scenario.spawns.front();
}

}  // namespace

int Soak(const SoakOptions& options) {
  const Prepared prepared = Prepare(options);
  const Interrupts interrupts;
  const DomainLock lock(options.domain);
  const FleetSpec spec = SpecOf(options, prepared, lock);
  SoakResult result = BlankResult(options, prepared, lock.Domain());
  const Limits limits = ReadLimits(prepared.qos_file, options.interface, result.vehicles + 1,
                                   AnyVehicle(prepared.scenario));
  std::fprintf(stderr, "%s on domain %u, %u vehicles, %zu faults planned, %zu left out\n",
               result.scenario.c_str(), lock.Domain(), result.vehicles, prepared.schedule.size(),
               prepared.skipped.size());
  SoakSession session(spec, prepared.scenario, prepared.schedule, prepared.phases,
                      ToolsOf(options, spec, prepared));
  const SoakSeen seen = session.Run();
  Judge({seen, prepared.schedule, limits,
         [&session](SteadyTime from, SteadyTime to) {
           return session.Stalls().LongestPause(from, to);
         }},
        &result);
  std::fputs((options.json ? ToJson(result) + "\n" : ToText(result)).c_str(), stdout);
  const bool told = std::fflush(stdout) == 0;
  Interrupts::AllowSeconds(kWriting_s);
  const int code = std::max(ExitCode(result.verdict), told ? 0 : 1);
  return WriteAfterVerdict(code, [&] { WriteSoakReport(result, options.report_folder); });
}

}  // namespace giveway::fleetctl
