// giveway-observer: shows a fleet that was started elsewhere. This file only wires: flags in, an
// exit code out.
#include <exception>

#include "services/fleetctl/survey/local_fleets.h"
#include "services/health/health_server.h"
#include "services/link/fastdds/library_log.h"
#include "services/link/fastdds/library_release.h"
#include "services/observer/observer_service.h"

namespace {

giveway::OnlyFleet FindOnlyFleetHere() {
  using namespace giveway::fleetctl;
  const ChosenFleet chosen = ChooseFleet(LocalFleets(), OwnNetworkNamespace().value_or(0));
  if (!chosen.fleet) return {0, "", chosen.why};
  return {chosen.fleet->domain, chosen.fleet->interface, ""};
}

}  // namespace

int main(int argc, char** argv) {
  using namespace giveway;
  const auto parsed = ParseObserverFlags(argc, argv, link::LibraryName(), FindOnlyFleetHere);
  if (const int* exit_code = std::get_if<int>(&parsed)) return *exit_code;
  const auto& flags = std::get<ObserverFlags>(parsed);
  if (!flags.ask_health.empty()) {
    return AskHealth(flags.address, static_cast<std::uint16_t>(flags.port), flags.ask_health);
  }
  InitLog("observer", flags.log_format, flags.log_level);
  link::SetLibraryLog([](const std::string& line) { LogWarning(line); });
  constexpr int kCouldNotRun = 2;
  constexpr Nanoseconds kFlushTime = std::chrono::milliseconds(200);
  int exit_code = kCouldNotRun;
  try {
    const StopSignal stop;
    ObserverService service(flags);
    service.Run(stop);
    exit_code = 0;
  } catch (const std::exception& error) {
    LogError(error.what());
  }
  FlushLog(kFlushTime);
  return exit_code;
}
