#include "services/fleetctl/soak/verb/soak.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "services/config/faults/fault_sources.h"
#include "services/config/impair.h"
#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/config/text_file.h"
#include "services/config/writing/scenario_edit.h"
#include "services/faults/channel.h"
#include "services/faults/kind_table.h"
#include "services/faults/schedule_text.h"
#include "services/faults/unsupported.h"
#include "services/fleetctl/args/places.h"
#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/output/terminal_text.h"
#include "services/fleetctl/process/child_process.h"
#include "services/fleetctl/process/domain_lock.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/process/run_key.h"
#include "services/fleetctl/soak/host_faults/attackers.h"
#include "services/fleetctl/soak/host_faults/discovery_servers.h"
#include "services/fleetctl/soak/host_faults/private_shm.h"
#include "services/fleetctl/soak/host_faults/qos_orders.h"
#include "services/fleetctl/soak/soak_draw.h"
#include "services/fleetctl/soak/soak_json.h"
#include "services/fleetctl/soak/soak_page.h"
#include "services/fleetctl/soak/soak_session.h"
#include "services/fleetctl/soak/soak_verdict.h"
#include "services/fleetctl/soak/verb/fleet_set.h"
#include "services/fleetctl/soak/verb/folder_lock.h"
#include "services/fleetctl/soak/verb/soak_faults.h"
#include "services/fleetctl/soak/verb/soak_origin.h"
#include "services/fleetctl/soak/verb/soak_resume.h"
#include "services/fleetctl/soak/verb/soak_virtual.h"
#include "services/fleetctl/stopwatch/stopwatch_limits.h"
#include "services/runtime/state_writer.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kWriting_s = 60;

// What to run, from files and flags; every process reads the scenario that is written here.
struct Prepared {
  std::string scenario_file;
  std::string faults_file;  // the concrete list
  std::string worlds_file;  // of it, what the world carries out
  std::string logs_folder;
  std::string qos_file;
  Scenario scenario;
  std::vector<VehicleId> fleet;
  SoakFaults faults;
  faults::Schedule schedule;
  SkippedFaults skipped;
  SoakPhases phases;
  std::uint32_t newcomers = 0;
  std::optional<FolderLock> lock;
};

// The world injects its own faults, and the receivers' faults are impairments: both are always
// available.
std::string WhyNot(const faults::Fault& fault, const std::string& why_no_attacker,
                   bool has_discovery_servers) {
  const auto actor = faults::ActorOf(fault.kind);
  if (actor == faults::Actor::kAttacker) return why_no_attacker;
  const char* const why = actor == faults::Actor::kSupervisor
                              ? ProcessFaults::WhyNot(fault, has_discovery_servers)
                              : nullptr;
  return why == nullptr ? "" : why;
}

bool Records(const SoakOptions& options) { return options.record || options.ring_s > 0; }

std::string WhyNotOf(const faults::Incapable& incapable, const faults::Fault& fault) {
  const auto cannot = faults::UnsupportedIn({fault}, incapable);
  return cannot.empty() ? "" : cannot.front().reason;
}

std::string WhyNot(const SoakOptions& options, const Scenario& scenario,
                   const std::string& why_no_attacker, FleetSet* set, const faults::Fault& fault) {
  const std::string sensors = WhyNotOf(faults::IncapableWithSensorsOf(scenario), fault);
  if (!sensors.empty()) return sensors;
  if (std::string lacks = faults::WhyTargetLacks(fault, scenario); !lacks.empty()) return lacks;
  if (fault.kind == faults::Kind::kDiskFull && !options.in_virtual_time && !Records(options)) {
    return "the vehicles write no files without --record or --record-ring";
  }
  if (options.in_virtual_time) return WhyNotOf(faults::IncapableInVirtualTime(), fault);
  const std::string why = WhyNot(fault, why_no_attacker, options.discovery_servers > 0);
  return why.empty() ? set->WhyNot(fault) : why;
}

// Refuses all faults that cannot be injected here, in one error; or leaves them out and reports it.
void Sift(const SoakOptions& options, const Scenario& scenario, Prepared* prepared) {
  std::vector<Problem> problems;
  const std::string why_no_attacker = WhyNoAttacker(options.attacker, MayOpenPacketSocket());
  FleetSet set(prepared->qos_file);
  std::erase_if(prepared->schedule, [&](const faults::Fault& fault) {
    const std::string why = WhyNot(options, scenario, why_no_attacker, &set, fault);
    if (why.empty()) return false;
    if (options.skip_unsupported) {
      prepared->skipped.Add(fault, why);
    } else {
      problems.push_back({FileOf(prepared->faults.sources, fault.rule), 0, fault.rule,
                          std::string(faults::ToString(fault.kind)),
                          fmt::format("cannot be carried out here: {}", why),
                          "take the rule out, or give --skip-unsupported"});
    }
    return true;
  });
  if (!problems.empty()) throw InputError(std::move(problems));
}

// Before anything starts: a process that cannot read its set would only end again and again.
void RefuseUnsoundSets(const faults::Schedule& schedule) {
  std::set<std::string> names;
  for (const faults::Fault& fault : schedule) names.insert(fault.parameters.qos);
  names.erase("");
  names.erase(std::string(faults::kPatientReaders));
  for (const std::string& name : names) static_cast<void>(ReadSoundQos(ResolveQosFile(name)));
}

ScenarioWithFaults LoadAndCheck(const SoakOptions& options) {
  ScenarioWithFaults loaded =
      LoadScenarioWithFaults(options.scenario, {options.seed, std::nullopt, std::nullopt});
  RefuseVehiclesWithoutPlace(options.scenario, options.vehicles, loaded.scenario);
  return loaded;
}

// `ending`: of the file names. A world reads its list at every start: not what others carry out.
void WriteLists(const fs::path& folder, const std::string& ending, Prepared* prepared) {
  prepared->faults_file = (folder / ("faults" + ending + ".textproto")).string();
  WriteFile(prepared->faults_file, faults::AsTextproto(prepared->schedule));
  faults::Schedule worlds;
  std::ranges::copy_if(prepared->schedule, std::back_inserter(worlds),
                       [](const faults::Fault& fault) {
                         return faults::ActorOf(fault.kind) == faults::Actor::kWorld;
                       });
  prepared->worlds_file = (folder / ("faults_of_world" + ending + ".textproto")).string();
  WriteFile(prepared->worlds_file, faults::AsTextproto(worlds));
}

Prepared Prepare(const SoakOptions& options) {
  Prepared prepared;
  const auto [as_shipped, own_faults] = LoadAndCheck(options);
  const auto places = static_cast<std::uint32_t>(as_shipped.spawns.size());
  prepared.newcomers = options.vehicles.value_or(places);
  const std::size_t vehicles = as_shipped.vehicles.size() + prepared.newcomers;
  prepared.phases = PhasesOf(options.duration_s, vehicles);
  prepared.qos_file = ResolveQosFile(options.qos_file);
  static_cast<void>(ReadSoundQos(prepared.qos_file, DeploymentOf(as_shipped)));

  const faults::Course course{options.seed, options.duration_s, prepared.phases.faults_from_s,
                              prepared.phases.end_s - prepared.phases.faults_until_s};
  prepared.fleet = SoakFleet(as_shipped, prepared.newcomers);
  prepared.faults = FaultsOf(options, own_faults);
  prepared.schedule = ExpandFaults(prepared.faults.sources, course, prepared.fleet).schedule;
  Sift(options, as_shipped, &prepared);
  RefuseUnsoundSets(prepared.schedule);
  CheckFolder(options.report_folder);
  prepared.lock.emplace(options.report_folder, "--report");
  ForgetSoak(options.report_folder);

  const fs::path folder(options.report_folder);
  if (!options.in_virtual_time) {
    prepared.logs_folder = (folder / "logs").string();
    CheckFolder(prepared.logs_folder);
    CheckFolder((folder / "impair").string());
  }
  if (Records(options)) CheckFolder((folder / "recordings").string());
  // All start together, so that all vehicles have the same fault clock. The scenario's own faults
  // are in the concrete list.
  ScenarioEdit edit{.duration_s = 0.0, .keep_faults = false};
  if (!as_shipped.spawns.empty()) edit.start_with = static_cast<std::uint32_t>(vehicles);
  prepared.scenario_file = (folder / "scenario.textproto").string();
  WriteFile(prepared.scenario_file, EditScenario(options.scenario, edit));
  WriteLists(folder, "", &prepared);
  prepared.scenario =
      LoadScenario(prepared.scenario_file, {options.seed, std::nullopt, std::nullopt});
  return prepared;
}

FleetSpec SpecOf(const SoakOptions& options, const Prepared& prepared, const DomainLock& lock,
                 const RunKey& key) {
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
  spec.options.discovery_servers =
      FreeServerAddresses(options.discovery_servers, options.interface);
  spec.options.admin_key = key.File();
  spec.options.vehicles = prepared.newcomers;
  spec.options.logs_folder = prepared.logs_folder;
  if (Records(options)) spec.options.record_folder = (folder / "recordings").string();
  if (options.ring_s > 0) spec.options.record_ring = std::to_string(options.ring_s);
  spec.extra_words[kTheWorld] = {"--checkpoint", (folder / kCheckpointFile).string(), "--faults",
                                 prepared.worlds_file};
  for (const VehicleId vehicle : prepared.fleet) {
    spec.extra_words[MemberOf(vehicle)] = {"--stay", "--hang-on-signal", "--no-watchdog",
                                           "--log-format", "json"};
  }
  return spec;
}

// In a file: hours of faults exceed the length of a command line.
std::string ImpairFlag(const fs::path& folder, VehicleId vehicle, const Impairment& impairment) {
  const fs::path file = folder / fmt::format("vehicle-{}.impair", Number(vehicle));
  WriteFile(file.string(), ImpairmentText(impairment) + "\n");
  return "@" + file.string();
}

bool Has(const faults::Schedule& schedule, std::initializer_list<faults::Kind> kinds) {
  return std::ranges::any_of(schedule, [&](const faults::Fault& fault) {
    return std::ranges::find(kinds, fault.kind) != kinds.end();
  });
}

FaultTools ToolsOf(const SoakOptions& options, const FleetSpec& spec, const Prepared& prepared) {
  FaultTools tools;
  tools.commands = MakeCommands(spec, prepared.scenario);
  const auto servers = ServerCommands(spec.options.discovery_servers, spec.options.logs_folder);
  tools.fleetctl = (spec.program_folder / "fleetctl").string();
  tools.domain = spec.domain;
  tools.interface = spec.options.interface;
  tools.discovery_servers = ToText(spec.options.discovery_servers);
  tools.admin_key = spec.options.admin_key;
  tools.qos_file = spec.qos_file;
  tools.attacker = options.attacker;
  const fs::path folder = fs::path(options.report_folder) / "impair";
  if (Has(prepared.schedule, {faults::Kind::kQosApply})) {
    tools.patient_readers = (folder / "patient_readers.xml").string();
    WriteFile(tools.patient_readers,
              WithPatientReaders(ReadTextFile(spec.qos_file), spec.qos_file));
  }
  const bool steps_clocks = Has(prepared.schedule, {faults::Kind::kClockStep});
  const std::map<VehicleId, Impairment> heard =
      faults::ImpairmentWith(prepared.schedule, prepared.fleet, prepared.scenario.impairment);
  for (MemberCommand& command : tools.commands) {
    if (steps_clocks) {
      const fs::path file = folder / fmt::format("{}.clock", command.member.number);
      const auto [clock, is_new] = tools.clocks.emplace(command.member, SteppableClock(file));
      command.child.environment = clock->second.Environment();
    }
    if (command.member == kTheWorld) continue;
    const auto impaired = heard.find(VehicleId{command.member.number});
    if (impaired == heard.end() || impaired->second.rules.empty()) continue;
    SetFlag(&command.child.words, "--impair",
            ImpairFlag(folder, impaired->first, impaired->second));
  }
  tools.commands.insert(tools.commands.begin(), servers.begin(), servers.end());
  return tools;
}

void RefuseServersThatCannotStart(const SoakOptions& options) {
  if (options.discovery_servers == 0) return;
  const std::string why = WhyNoDiscoveryServers(options.interface);
  if (!why.empty()) throw StartError("--discovery-servers: " + why);
}

SoakResult BlankResult(const SoakOptions& options, const Prepared& prepared, std::uint32_t domain) {
  SoakResult result;
  result.scenario = prepared.scenario.name;
  result.seed = options.seed;
  result.planned_s = options.duration_s;
  result.vehicles =
      static_cast<std::uint32_t>(prepared.scenario.vehicles.size()) + prepared.newcomers;
  result.domain = domain;
  result.virtual_time = options.in_virtual_time;
  result.faults_file = prepared.faults.name;
  result.qos_set = prepared.qos_file;
  result.skipped_faults = prepared.skipped.Lines();
  result.skipped_counted = prepared.skipped.Count();
  SoakOptions repeated = options;
  repeated.faults = prepared.faults.flag;
  result.command = CommandLine(repeated);
  result.versions = VersionsOf(ProgramFolder(), options.in_virtual_time);
  return result;
}

const VehicleOptions& AnyVehicle(const Scenario& scenario) {
  return scenario.spawns.empty() ? scenario.vehicles.front() : scenario.spawns.front();
}

// `finished`: there is nothing left to resume.
int Conclude(const SoakOptions& options, const SoakResult& result, bool finished) {
  const bool written = PrintAll(options.json ? ToJson(result) + "\n" : ForTerminal(ToText(result)));
  Interrupts::AllowSeconds(kWriting_s);
  const int code = std::max(ExitCode(result.verdict), written ? 0 : 1);
  return WriteAfterVerdict(code, [&] {
    WriteSoakReport(result, options.report_folder);
    if (finished) ForgetSoFar(options.report_folder);
  });
}

// As in `fleetctl virtual`: the seed moves every vehicle, wherever its place comes from.
Scenario VirtualScenario(const SoakOptions& options, const Prepared& prepared) {
  const Scenario as_written = LoadScenario(prepared.scenario_file, {0, std::nullopt, std::nullopt});
  Scenario scenario =
      WithPlacesFilled(as_written, static_cast<std::uint32_t>(prepared.fleet.size()));
  scenario.seed = options.seed;
  PerturbBySeed(&scenario);
  return scenario;
}

int SoakVirtually(const SoakOptions& options) {
  const Prepared prepared = Prepare(options);
  const Interrupts interrupts(Silence::kComputes);
  const Scenario scenario = VirtualScenario(options, prepared);
  SoakResult result = BlankResult(options, prepared, 0);
  const SoakSeen seen = RunSoakVirtually(scenario, prepared.schedule, prepared.phases);
  EvaluateSoak({seen, prepared.schedule, {}, false}, &result);
  return Conclude(options, result, true);
}

// `whole` is the soak of which this is the rest, if any.
int SoakProcesses(const SoakOptions& options, const Prepared& prepared, const SoakResult* whole) {
  std::optional<PrivateShm> shm;  // first: the threads and processes of the soak share it
  if (Has(prepared.schedule, {faults::Kind::kSharedMemoryGone, faults::Kind::kSharedMemoryLeftOver,
                              faults::Kind::kSharedMemorySmall})) {
    shm.emplace();
  }
  const Interrupts interrupts;
  const DomainLock lock(options.domain);
  const RunKey key(options.admin_key, lock.Domain());
  const FleetSpec spec = SpecOf(options, prepared, lock, key);
  const SoakResult blank = BlankResult(options, prepared, lock.Domain());
  const Limits limits = ReadLimits(prepared.qos_file, options.interface, blank.vehicles + 1,
                                   AnyVehicle(prepared.scenario));
  std::fprintf(stderr, "%s on domain %u, %u vehicles, %zu faults planned, %zu left out\n",
               blank.scenario.c_str(), lock.Domain(), blank.vehicles, prepared.schedule.size(),
               prepared.skipped.Count());
  FaultTools tools = ToolsOf(options, spec, prepared);
  tools.shm = shm ? &*shm : nullptr;
  SoakSession session(spec, prepared.scenario, prepared.schedule, prepared.phases, limits,
                      std::move(tools));
  const auto judged = [&](const SoakSeen& seen) {
    SoakResult result = blank;
    EvaluateSoak({seen, prepared.schedule, limits, true, prepared.fleet}, &result);
    return whole == nullptr ? result : Joined(*whole, result);
  };
  // A disk that stalls, or hours to write down, would be a pause of the supervisor, which is taken
  // for one of the machine.
  StateWriter<SoakSeen> saver([&](const SoakSeen& so_far) {
    return SaveSoFar(ToJson(judged(so_far)), options.report_folder);
  });
  const SoakSeen seen = session.Run([&saver](SoakSeen so_far) {
    const std::string why = saver.TakeOutcome().value_or("");
    if (!why.empty()) std::fprintf(stderr, "what was seen so far is not saved: %s\n", why.c_str());
    saver.Write(std::move(so_far));
    return UntilNextSave(saver.LastCost());
  });
  saver.Finish();
  const bool finished = whole == nullptr || seen.started;
  if (!finished) {
    std::fprintf(stderr, "the rest did not start: fleetctl soak --resume %s starts it once more\n",
                 options.report_folder.c_str());
  }
  return Conclude(options, judged(seen), finished);
}

// The arguments of the rest: files of the folder, and figures observed so far.
SoakOptions OptionsOfRest(const SoakOptions& asked, const SoakResult& so_far) {
  const fs::path folder(asked.resume);
  SoakOptions options = asked;
  options.report_folder = asked.resume;
  options.scenario = (folder / "scenario.textproto").string();
  options.faults = (folder / "faults.textproto").string();
  options.seed = static_cast<std::uint32_t>(so_far.seed);
  options.qos_file = so_far.qos_set;
  options.duration_s = std::max(kLeastSoak_s, so_far.planned_s - so_far.ran_s);
  return options;
}

// The set of the fleet before, which may be asked for again, as by an environment that still has
// it.
void RefuseAnotherSet(const SoakOptions& asked, const SoakResult& so_far) {
  if (asked.qos_file.empty() || ResolveQosFile(asked.qos_file) == so_far.qos_set) return;
  throw InputError({{.file = asked.resume,
                     .field = "--qos",
                     .value = asked.qos_file,
                     .message = "the soak runs with " + so_far.qos_set,
                     .remedy = "leave --qos and GIVEWAY_QOS out"}});
}

void NoteRecordings(const SoakOptions& options, const fs::path& folder) {
  if (Records(options)) {
    CheckFolder(folder.string());
  } else if (fs::exists(folder)) {
    std::fprintf(
        stderr,
        "the fleet before recorded, and this one does not: --record or --record-ring are to "
        "be given again\n");
  }
}

int Resume(const SoakOptions& asked) {
  static_cast<void>(LoadSoFar(asked.resume));  // else a lock is left in any folder
  Prepared prepared;
  prepared.lock.emplace(asked.resume, "--resume");
  const SoakResult so_far = LoadSoFar(asked.resume);
  RefuseAnotherSet(asked, so_far);
  const SoakOptions options = OptionsOfRest(asked, so_far);
  const fs::path folder(options.report_folder);
  prepared.scenario_file = options.scenario;
  prepared.qos_file = options.qos_file;
  prepared.scenario = LoadAndCheck(options).scenario;
  const auto named = static_cast<std::uint32_t>(prepared.scenario.vehicles.size());
  prepared.newcomers = so_far.vehicles - std::min(so_far.vehicles, named);
  prepared.phases = PhasesOf(options.duration_s, so_far.vehicles);
  prepared.fleet = SoakFleet(prepared.scenario, prepared.newcomers);
  const faults::Course course{options.seed, so_far.planned_s, 0, 0};
  prepared.faults = FaultsOf(options, std::nullopt);
  const faults::Schedule whole =
      ExpandFaults(prepared.faults.sources, course, prepared.fleet).schedule;
  prepared.schedule = RestOf(whole, so_far, prepared.phases.faults_from_s, &prepared.skipped);
  Sift(options, prepared.scenario, &prepared);
  const std::string rest = fmt::format("rest-{}", so_far.resumed_at_s.size() + 1);
  prepared.logs_folder = (folder / "logs" / rest).string();  // those of the fleet before stay
  CheckFolder(prepared.logs_folder);
  NoteRecordings(options, folder / "recordings");
  WriteLists(folder, "." + rest, &prepared);
  // A new fleet: the old world's times and places are no longer valid.
  fs::remove(folder / kCheckpointFile);
  std::fprintf(stderr, "resuming at %.0f of %.0f s\n", so_far.ran_s, so_far.planned_s);
  return SoakProcesses(options, prepared, &so_far);
}

}  // namespace

int Soak(const SoakOptions& options) {
  if (options.in_virtual_time) return SoakVirtually(options);
  RefuseServersThatCannotStart(options);
  if (!options.resume.empty()) return Resume(options);
  return SoakProcesses(options, Prepare(options), nullptr);
}

}  // namespace giveway::fleetctl
