// giveway-vehicle: one vehicle, one process, one participant. This file only wires; the control
// loop is in vehicle_loop.h.
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "services/config/scenario_file.h"
#include "services/link/fastdds/library_release.h"
#include "services/link/vehicle_link.h"
#include "services/node/admin_access.h"
#include "services/node/environment_check.h"
#include "services/node/qos_at_start.h"
#include "services/node/server_wait.h"
#include "services/node/service_main.h"
#include "services/node/start_inputs.h"
#include "services/runtime/hang_signal.h"
#include "services/runtime/identity.h"
#include "services/vehicle_node/vehicle_end.h"
#include "services/vehicle_node/vehicle_join.h"

namespace giveway {
namespace {

// One that comes back, as a vehicle that drives, does so without a recording rather than not at
// all.
void OpenRecorder(const ServiceFlags& flags, std::optional<Recorder>* recorder) {
  if (flags.record.empty()) return;
  try {
    recorder->emplace(flags.record, RecorderOptions{flags.record_split, flags.record_ring});
  } catch (const std::runtime_error& error) {
    if (!flags.resume) throw;
    LogError(std::string(error.what()) + "; drives on without a recording");
  }
}

// From joining to the end of the link.
LifeEnd Live(const ServiceFlags& flags, const Scenario& scenario, link::LinkOptions options,
             const StopSignal& stop, const std::function<void()>& settled) {
  VehicleHealthReporter health(flags);
  std::optional<Recorder> recorder;
  OpenRecorder(flags, &recorder);
  options.impairment = ImpairmentOf(flags, scenario);
  const auto servers =
      AwaitServers(options, stop, [&](const std::string& why) { health.OnStarting(why); });
  if (!servers) return {};
  options.server_addresses = *servers;
  auth::AdminGate gate = AdminGateOf(flags);
  link::VehicleLink link(options, ServiceOptionsOf(gate, scenario));
  PublishIdentity({kNoVehicle, link.ParticipantText()});
  SteadyClock clock;
  const Resumed resumed = flags.resume.value_or(Resumed{});
  const auto session = flags.resume ? std::optional(resumed.session) : std::nullopt;
  // One that has a place keeps it; one that waits for its first can start again at once.
  const auto starts_again = [&] { return !flags.resume && link.SharedMemoryIsGone(); };
  const auto over_udp = [] {
    LogError(kSharedMemoryDeleted);
    return WithoutLostMemory({0, NewFlags{}}, true);
  };
  // Before it asks for a place: the world may give one to a session that would not be there any
  // more.
  if (starts_again()) return over_udp();
  const auto [entry, interface_lost] = Join(
      {.link = &link, .clock = &clock, .health = &health, .scenario = &scenario},
      [&] { return stop.IsSet() || starts_again(); }, VehicleId{flags.id}, session);
  if (interface_lost) return {1, {}};
  if (!entry && starts_again()) return over_udp();
  if (!entry) return {};
  if (!entry->accepted) return {2, {}};
  PublishIdentity({entry->vehicle, link.ParticipantText()});
  SetLogVehicle(entry->vehicle);
  if (flags.id == 0) LogInfo("is vehicle " + std::to_string(Number(entry->vehicle)));
  link.Open(entry->vehicle, OptionsOf(scenario, *entry).profile, !scenario.signals.empty());
  ServiceAdmin admin(&link, options, ServiceDeployment(scenario), entry->vehicle, flags.lockstep,
                     std::move(gate), [&recorder] { return recorder && recorder->Keep(); });
  // With shared memory the library touches some of it only when samples go.
  const auto on_first_scan = [&] {
    settled();
    if (resumed.order != 0) admin.AnswerResumed(resumed.order, flags.rolled_back);
  };
  VehicleLoop loop({.link = &link,
                    .clock = &clock,
                    .health = &health,
                    .recorder = recorder ? &*recorder : nullptr,
                    .serve_orders = [&] { return admin.Serve(); },
                    .on_first_scan = on_first_scan},
                   scenario, *entry,
                   {.lockstep = flags.lockstep, .stays = flags.stay, .handover = resumed.handover});
  const DriveEnd end = loop.Drive([&] { return stop.IsSet(); });
  LogInfo(Describe(link.Counters()));
  if (const auto impaired = link.Impaired()) LogInfo(Describe(*impaired));
  return WithoutLostMemory(EndOf(end, loop, admin), link.SharedMemoryIsGone());
}

int Run(const ServiceFlags& flags, const StopSignal& stop) {
  const std::string name = flags.id == 0 ? "vehicle" : "vehicle " + std::to_string(flags.id);
  InitLog(name, flags.log_format, flags.log_level);
  if (flags.try_qos.empty()) WarnOfEnvironment();
  std::optional<HangSignal> hang;
  if (flags.hang_on_signal) hang.emplace();
  SetLogVehicle(VehicleId{flags.id});
  const Scenario scenario = LoadForStart(flags, [&] {
    return LoadScenario(
        flags.scenario,
        {.seed = flags.seed, .behaviour = flags.behaviour, .duration_s = flags.duration_s});
  });
  const auto live = [&](const link::LinkOptions& options, const std::function<void()>& settled) {
    return Live(flags, scenario, options, stop, settled);
  };
  return RunService(flags, scenario, stop, live);
}

}  // namespace
}  // namespace giveway

int main(int argc, char** argv) {
  return giveway::ServiceMain(giveway::ParseVehicleFlags(argc, argv, giveway::link::LibraryName()),
                              giveway::Run);
}
