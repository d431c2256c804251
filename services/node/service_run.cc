#include "services/node/service_run.h"

#include <unistd.h>

#include <cstdio>
#include <string>

#include "services/link/qos_trial.h"
#include "services/node/qos_at_start.h"
#include "services/node/service_main.h"

namespace giveway {
namespace {

constexpr unsigned kMostTrialSeconds = 10;

// Exit code 0, or 2 after the reason on stdout.
int TryQosAndEnd(const std::string& file, link::LinkOptions options) {
  alarm(kMostTrialSeconds);  // its parent may be gone, and the library may hang
  options.qos_file = file;
  try {
    link::TryQos(options);
    return 0;
  } catch (const std::exception& error) {
    std::puts(error.what());
    std::fflush(stdout);
    return 2;
  }
}

// The flags with which a process that cannot run with the profiles of an order comes back with
// those it had before.
NewFlags ToRollBack(const std::string& former_qos, const std::optional<Resumed>& resumed,
                    const std::string& why) {
  LogError("comes back with the QoS it had before: " + why);
  return {{"--qos", former_qos},
          {"--former-qos", ""},
          {"--rolled-back", why},
          {"--resume", resumed ? HoldText("resume", ToBytes(*resumed)) : ""}};
}

}  // namespace

int RunService(const ServiceFlags& flags, const Scenario& scenario, const StopSignal& stop,
               const std::function<std::optional<NewFlags>(int* exit_code)>& live) {
  if (!flags.try_qos.empty()) return TryQosAndEnd(flags.try_qos, LinkOptionsOf(flags, scenario));
  int exit_code = 0;
  std::optional<NewFlags> new_flags;
  try {
    RequireSoundQos(flags.qos, scenario);
    new_flags = live(&exit_code);
  } catch (const link::LinkError& error) {
    if (flags.former_qos.empty()) throw;
    new_flags = ToRollBack(flags.former_qos, flags.resume, error.what());
  }
  if (!new_flags) return exit_code;
  HoldSignalsBack();
  // A stop that came while the link was closed would be forgotten by a new process image.
  if (stop.IsSet()) return exit_code;
  FlushLog(kFlushLog);
  RestartWith(*new_flags);
}

}  // namespace giveway
