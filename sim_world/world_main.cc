// giveway-world: the shared simulated world as a process.
//
//   WorldLink::TakeJoins, TakeCommands -> Admission, Run::Advance -> WorldLink::Send...
//
// Waits for the roster, runs the scenario on absolute deadlines, and tells everyone why it ended.
// With a checkpoint file it goes on, after a crash, from where it was.
#include <functional>
#include <optional>
#include <variant>

#include "services/app/health_service.h"
#include "services/app/identity.h"
#include "services/app/parallel_for.h"
#include "services/app/process.h"
#include "services/app/restart.h"
#include "services/app/scenario_file.h"
#include "services/app/state_file.h"
#include "services/app/text_file.h"
#include "services/link/library_release.h"
#include "services/link/world_link.h"
#include "services/server_wait.h"
#include "services/service_admin.h"
#include "services/service_main.h"
#include "services/service_run.h"
#include "services/types/state_hash.h"
#include "sim_world/world_loop.h"

namespace giveway {
namespace {

// Of everything that makes the scenario: the file as it is, and what the flags change in it.
std::uint64_t MarkOf(const app::ServiceFlags& flags, const Scenario& scenario) {
  StateHash hash;
  const auto file = app::ReadStateFile(app::ResolveScenario(flags.scenario));
  for (const char byte : file.value_or("")) hash.Add(static_cast<std::uint64_t>(byte));
  hash.Add(scenario.seed);
  hash.Add(scenario.duration_s);
  hash.Add(flags.behaviour.has_value());
  if (flags.behaviour) hash.Add(*flags.behaviour);
  return hash.Value();
}

// The state to go on from, or none; the log says which, and why.
std::optional<sim::FleetCheckpoint> ReadCheckpoint(const std::string& file, std::uint64_t mark) {
  const std::optional<std::string> bytes = app::ReadStateFile(file);
  if (!bytes) {
    app::LogInfo("no checkpoint in " + file + ": starts anew");
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
  app::LogWarning("the checkpoint in " + file + " is of no use: " + fault + "; starts anew");
  return std::nullopt;
}

WorldLoopOptions LoopOptionsOf(const app::ServiceFlags& flags, const Scenario& scenario) {
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
std::optional<app::NewFlags> LiveAsWorld(const app::ServiceFlags& flags, const Scenario& scenario,
                                         const app::StopSignal& stop,
                                         const std::function<void()>& settled, int* exit_code) {
  app::HealthService<app::WorldHealth> health(flags);
  app::ParallelPool pool(flags.threads);
  WorldLoopOptions options = LoopOptionsOf(flags, scenario);
  options.parallel = pool.Function();
  const link::LinkOptions link_options = LinkOptionsOf(flags, scenario);
  const auto tell = [&](const std::string& why) {
    health.Now().waits_for = app::ShortText(why);
    health.Tell();
  };
  if (!AwaitServers(link_options, stop, tell)) return {};
  link::WorldLink link(link_options);
  app::PublishIdentity({kNobody, link.ParticipantText()});
  ServiceAdmin admin(&link, link_options, kNobody,
                     {app::NameOf(flags.qos), app::ReadBytes(flags.qos)}, flags.lockstep);
  app::LetGo(flags.qos);
  options.on_back = [&] {
    settled();
    if (flags.resume) admin.AnswerResumed(flags.resume->order, flags.rolled_back);
  };
  WorldLoop loop(scenario, &link, &admin, &health, options);
  const WorldEnd end = loop.Drive(stop);
  if (end == WorldEnd::kRestarts) {
    app::NewFlags back = admin.ToComeBack();
    back["--resume"] =
        app::HoldText("resume", app::ToBytes({SessionId{}, admin.Order(), std::nullopt}));
    back["--go-on-from"] = app::HoldText("run", loop.State());
    return back;
  }
  // To stop when asked to is no failure.
  *exit_code = end == WorldEnd::kPassed || stop.IsSet() ? 0 : 1;
  return {};
}

int RunWorld(const app::ServiceFlags& flags, const app::StopSignal& stop) {
  app::InitLog("world", flags.log_format, flags.log_level);
  const Scenario scenario = app::LoadScenario(
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
  return giveway::ServiceMain(
      giveway::app::ParseWorldFlags(argc, argv, giveway::link::LibraryName()), giveway::RunWorld);
}
