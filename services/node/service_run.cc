#include "services/node/service_run.h"

#include <unistd.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include "services/link/fastdds/profile_file.h"
#include "services/link/qos_trial.h"
#include "services/node/qos_at_start.h"
#include "services/node/service_main.h"
#include "services/runtime/crash_fallback.h"

namespace giveway {
namespace {

constexpr unsigned kMostTrialSeconds = 10;

// Exit code 0, or 2 after the reason on stdout.
int TryQosAndEnd(const ServiceFlags& flags, const Scenario& scenario) {
  alarm(kMostTrialSeconds);  // its parent may be gone, and the library may hang
  try {
    link::TryQos(LinkOptionsOf(flags, scenario, link::ReadProfileFile(flags.try_qos)));
    return 0;
  } catch (const std::exception& error) {
    std::puts(error.what());
    std::fflush(stdout);
    return 2;
  }
}

// A process that cannot run with the profiles of an order comes back with those it had before.
class FormerQos {
 public:
  FormerQos(const ServiceFlags& flags, const StopSignal& stop)
      : resume_(flags.resume ? std::make_unique<HeldText>("resume", ToBytes(*flags.resume))
                             : nullptr),
        crash_fallback_({{"--qos", flags.former_qos},
                         {"--former-qos", ""},
                         {"--resume", resume_ ? resume_->Path() : ""}},
                        "--rolled-back", stop) {}

  NewFlags Because(const std::string& why) const { return crash_fallback_.Because(why); }

 private:
  const std::unique_ptr<HeldText> resume_;
  const CrashFallback crash_fallback_;
};

}  // namespace

LifeEnd WithoutLostMemory(LifeEnd end, bool shared_memory_is_gone) {
  if (end.back && shared_memory_is_gone) (*end.back)["--leave-out"] = "shared_memory";
  return end;
}

int RunService(const ServiceFlags& flags, const Scenario& scenario, const StopSignal& stop,
               const Live& live) {
  if (!flags.try_qos.empty()) return TryQosAndEnd(flags, scenario);
  if (!flags.rolled_back.empty()) {
    LogError("comes back with the QoS it had before: " + flags.rolled_back);
  }
  std::unique_ptr<FormerQos> former;
  if (!flags.former_qos.empty()) former = std::make_unique<FormerQos>(flags, stop);
  const auto settled = [&] {
    former.reset();
    for (const std::string& held : {flags.former_qos, flags.go_on_from}) LetGo(held);
  };
  LifeEnd end;
  try {
    const link::LinkOptions options =
        LinkOptionsOf(flags, scenario, ReadSoundQos(flags.qos, scenario));
    LetGo(flags.qos);
    end = live(options, settled);
  } catch (const std::exception& error) {
    if (!former) throw;
    end.back = former->Because(error.what());
  }
  if (!end.back) return end.exit_code;
  HoldSignalsBack();
  // A stop that came while the link was closed would be forgotten by a new process image.
  if (stop.IsSet()) return end.exit_code;
  FlushLog(kFlushLog);
  RestartWith(*end.back);
}

}  // namespace giveway
