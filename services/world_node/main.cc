// giveway-world: the shared simulated world as a process.
//
//   WorldLink::TakeJoins, TakeCommands -> Admission, Run::Advance -> WorldLink::Send...
//
// Waits for the roster, runs the scenario on absolute deadlines, and tells everyone why it ended.
// With a checkpoint file it goes on, after a crash, from where it was.
#include <functional>
#include <optional>
#include <variant>

#include "services/config/config_dir.h"
#include "services/config/scenario_file.h"
#include "services/config/text_file.h"
#include "services/health/health_service.h"
#include "services/link/fastdds/library_release.h"
#include "services/link/world_link.h"
#include "services/node/server_wait.h"
#include "services/node/service_admin.h"
#include "services/node/service_main.h"
#include "services/node/service_run.h"
#include "services/runtime/identity.h"
#include "services/runtime/parallel_for.h"
#include "services/runtime/process.h"
#include "services/runtime/restart.h"
#include "services/runtime/state_file.h"
#include "services/types/state_hash.h"
#include "services/world_node/world_loop.h"

namespace giveway {
namespace {

// Of everything that makes the scenario: the file as it is, and what the flags change in it.
std::uint64_t MarkOf(const ServiceFlags& flags, const Scenario& scenario) {
  StateHash hash;
  const auto file = ReadStateFile(ResolveScenario(flags.scenario));
  for (const char byte : file.value_or("")) hash.Add(static_cast<std::uint64_t>(byte));
  hash.Add(scenario.seed);
  hash.Add(scenario.duration_s);
  hash.Add(flags.behaviour.has_value());
  if (flags.behaviour) hash.Add(*flags.behaviour);
  return hash.Value();
}

// The state to go on from, or none; the log says which, and why.
std::optional<sim::FleetCheckpoint> ReadCheckpoint(const std::string& file, std::uint64_t mark) {
  const std::optional<std::string> bytes = ReadStateFile(file);
  if (!bytes) {
    LogInfo("no checkpoint in " + file + ": starts anew");
    return std::nullopt;
  }
  auto checkpoint = sim::FromBytes(*bytes);
  std::string fault;
  if (const std::string* why = std::get_if<std::string>(&checkpoint)) {
    fault = *why;
  } else if (std::get<sim::FleetCheckpoint>(checkpoint).scenario != mark) {
    fault = "it is of another scenario";
  }
  if (fault.empty()) return std::get<sim::FleetCheckpoint>(std::move(checkpoint));
  LogWarning("the checkpoint in " + file + " is of no use: " + fault + "; starts anew");
  return std::nullopt;
}

WorldLoopOptions LoopOptionsOf(const ServiceFlags& flags, const Scenario& scenario) {
  WorldLoopOptions options{.lockstep = flags.lockstep,
                           .checkpoint_file = flags.checkpoint,
                           .scenario_mark = MarkOf(flags, scenario),
                           .checkpoint = {},
                           .same_epoch = !flags.go_on_from.empty()};
  const std::string& file = options.same_epoch ? flags.go_on_from : flags.checkpoint;
  if (!file.empty()) options.checkpoint = ReadCheckpoint(file, options.scenario_mark);
  return options;
}

// From the link's first moment to its last; see service_run.h.
std::optional<NewFlags> LiveAsWorld(const ServiceFlags& flags, const Scenario& scenario,
                                    const StopSignal& stop, const std::function<void()>& settled,
                                    int* exit_code) {
  HealthService<WorldHealth> health(flags);
  ParallelPool pool(flags.threads);
  WorldLoopOptions options = LoopOptionsOf(flags, scenario);
  options.parallel = pool.Function();
  const link::LinkOptions link_options = LinkOptionsOf(flags, scenario);
  const auto tell = [&](const std::string& why) {
    health.Now().waits_for = ShortText(why);
    health.Tell();
  };
  if (!AwaitServers(link_options, stop, tell)) return {};
  link::WorldLink link(link_options);
  PublishIdentity({kNobody, link.ParticipantText()});
  ServiceAdmin admin(&link, link_options, kNobody, {NameOf(flags.qos), ReadBytes(flags.qos)},
                     flags.lockstep);
  LetGo(flags.qos);
  options.on_back = [&] {
    settled();
    if (flags.resume) admin.AnswerResumed(flags.resume->order, flags.rolled_back);
  };
  WorldLoop loop(scenario, &link, &admin, &health, options);
  const WorldEnd end = loop.Drive(stop);
  if (end == WorldEnd::kRestarts) {
    NewFlags back = admin.ToComeBack();
    back["--resume"] = HoldText("resume", ToBytes({SessionId{}, admin.Order(), std::nullopt}));
    back["--go-on-from"] = HoldText("run", loop.State());
    return back;
  }
  // To stop when asked to is no failure.
  *exit_code = end == WorldEnd::kPassed || stop.IsSet() ? 0 : 1;
  return {};
}

int RunWorld(const ServiceFlags& flags, const StopSignal& stop) {
  InitLog("world", flags.log_format, flags.log_level);
  const Scenario scenario = LoadScenario(
      flags.scenario,
      {.seed = flags.seed, .behaviour = flags.behaviour, .duration_s = flags.duration_s});
  return RunService(flags, scenario, stop,
                    [&](const std::function<void()>& settled, int* exit_code) {
                      return LiveAsWorld(flags, scenario, stop, settled, exit_code);
                    });
}

}  // namespace
}  // namespace giveway

int main(int argc, char** argv) {
  return giveway::ServiceMain(giveway::ParseWorldFlags(argc, argv, giveway::link::LibraryName()),
                              giveway::RunWorld);
}
