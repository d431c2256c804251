// giveway-observer: shows a fleet that was started elsewhere. This file only wires: flags in, an
// exit code out.
#include <exception>
#include <optional>

#include "services/fleetctl/survey/local_fleets.h"
#include "services/health/health_server.h"
#include "services/link/fastdds/library_log.h"
#include "services/link/fastdds/library_release.h"
#include "services/node/environment_check.h"
#include "services/observer/observer_service.h"
#include "services/runtime/hang_signal.h"

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
  if (const int* exit_code = std::get_if<int>(&parsed)) {
    if (*exit_code != 0) WarnOfEnvironment();  // a flag that is missing may be a misspelt twin
    return *exit_code;
  }
  const auto& flags = std::get<ObserverFlags>(parsed);
  if (!flags.ask_health.empty()) {
    return AskHealth(flags.address, static_cast<std::uint16_t>(flags.port), flags.ask_health);
  }
  constexpr int kCouldNotRun = 2;
  constexpr int kInterfaceLost = 1;
  constexpr Nanoseconds kFlushTime = std::chrono::milliseconds(200);
  int exit_code = kCouldNotRun;
  try {
    InitLog("observer", flags.log_format, flags.log_level);
    WarnOfEnvironment();
    link::SetLibraryLog([](const std::string& line) { LogWarning(line); });
    const StopSignal stop;
    std::optional<HangSignal> hang;
    if (flags.hang_on_signal) hang.emplace();
    ObserverService service(flags);
    exit_code = service.Run(stop) ? 0 : kInterfaceLost;
  } catch (const std::exception& error) {
    LogError(error.what());
  }
  FlushLog(kFlushTime);
  return exit_code;
}
