// giveway-world: the shared simulated world as a process.
//
//   WorldLink::TakeJoins, TakeCommands -> Admission, Run::Advance -> WorldLink::Send...
//
// Waits for the roster, runs the scenario on absolute deadlines, and reports why it ended. With a
// checkpoint file it resumes, after a crash, from where it was. This file only wires; the loop is
// in world_loop.h.
#include <functional>
#include <utility>

#include "services/config/scenario_file.h"
#include "services/link/fastdds/library_release.h"
#include "services/node/admin_access.h"
#include "services/node/environment_check.h"
#include "services/node/qos_at_start.h"
#include "services/node/server_wait.h"
#include "services/node/service_main.h"
#include "services/node/service_run.h"
#include "services/node/start_inputs.h"
#include "services/runtime/identity.h"
#include "services/runtime/parallel_for.h"
#include "services/world_node/world_start.h"

namespace giveway {
namespace {

// What cannot be held is left out, and so is that of an earlier restart: the world then resumes
// from its checkpoint file, as after a crash.
NewFlags ToComeBack(const ServiceAdmin& admin, const WorldLoop& loop) {
  NewFlags flags = admin.ToComeBack();
  flags["--resume"] = "";
  flags["--go-on-from"] = "";
  HoldTextFor("--resume", "resume", ToBytes({SessionId{}, admin.Order(), std::nullopt}), &flags);
  HoldTextFor("--go-on-from", "run", loop.State(), &flags);
  return flags;
}

// From the link's first moment to its last.
LifeEnd Live(const ServiceFlags& flags, const Scenario& scenario,
             const sim::FaultSchedule& schedule, link::LinkOptions link_options,
             const StopSignal& stop, const std::function<void()>& settled) {
  HealthService<WorldHealth> health(flags);
  ParallelPool pool(flags.threads);
  WorldLoopOptions options = LoopOptionsOf(flags, scenario);
  options.parallel = pool.Function();
  options.schedule = schedule;
  const auto tell = [&](const std::string& why) {
    health.Now().waits_for = ShortText(why);
    health.Publish();
  };
  const auto servers = AwaitServers(link_options, stop, tell);
  if (!servers) return {};
  link_options.server_addresses = *servers;
  auth::AdminGate gate = AdminGateOf(flags);
  link::WorldLink link(link_options, ServiceOptionsOf(gate, scenario));
  PublishIdentity({kNoVehicle, link.ParticipantText()});
  ServiceAdmin admin(&link, link_options, ServiceDeployment(scenario), kNoVehicle, flags.lockstep,
                     std::move(gate));
  options.on_back = [&] {
    settled();
    if (flags.resume && flags.resume->order != 0) {
      admin.AnswerResumed(flags.resume->order, flags.rolled_back);
    }
  };
  WorldLoop loop(scenario, &link, &admin, &health, options);
  const WorldEnd end = loop.Drive(stop);
  if (end == WorldEnd::kRestarts) {
    return WithoutLostMemory({0, ToComeBack(admin, loop)}, link.SharedMemoryIsGone());
  }
  // To stop when asked to is no failure.
  return {end == WorldEnd::kPassed || stop.IsSet() ? 0 : 1, {}};
}

int Run(const ServiceFlags& flags, const StopSignal& stop) {
  InitLog("world", flags.log_format, flags.log_level);
  if (flags.try_qos.empty()) WarnOfEnvironment();
  const ScenarioWithFaults loaded = LoadForStart(flags, [&] {
    return LoadScenarioWithFaults(
        flags.scenario,
        {.seed = flags.seed, .behaviour = flags.behaviour, .duration_s = flags.duration_s});
  });
  const Scenario& scenario = loaded.scenario;
  // Each is for its own actor, and all must draw the same.
  if (loaded.faults && flags.faults.empty()) {
    LogWarning(
        "the scenario's `faults` are left out: fleetctl run and fleetctl soak carry them out");
  }
  const sim::FaultSchedule schedule =
      LoadForStart(flags, [&] { return LoadSchedule(flags, scenario); });
  const auto live = [&](const link::LinkOptions& options, const std::function<void()>& settled) {
    return Live(flags, scenario, schedule, options, stop, settled);
  };
  return RunService(flags, scenario, stop, live);
}

}  // namespace
}  // namespace giveway

int main(int argc, char** argv) {
  return giveway::ServiceMain(giveway::ParseWorldFlags(argc, argv, giveway::link::LibraryName()),
                              giveway::Run);
}
