#include "services/node/service_run.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include "services/link/fastdds/profile_file.h"
#include "services/link/qos_trial.h"
#include "services/node/service_main.h"
#include "services/node/start_inputs.h"
#include "services/qos/profile_set.h"
#include "services/qos/xml_tree.h"
#include "services/runtime/crash_fallback.h"

namespace giveway {
namespace {

constexpr unsigned kMostTrialSeconds = 10;
constexpr const char* kMemoryLost = "--memory-lost";

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
        crash_fallback_({kCrashSignals.begin(), kCrashSignals.end()},
                        {{"--qos", flags.former_qos},
                         {"--former-qos", ""},
                         {"--resume", resume_ ? resume_->Path() : ""}},
                        "--rolled-back", stop) {}

  NewFlags Because(const std::string& why) const { return crash_fallback_.Because(why); }

 private:
  const std::unique_ptr<HeldText> resume_;
  const CrashFallback crash_fallback_;
};

// What this process image was given and has not let go, and the next one is given others of.
void LetGoOfReplaced(const ServiceFlags& flags, const NewFlags& back) {
  if (back.contains("--former-qos")) LetGo(flags.former_qos);
  if (back.contains("--go-on-from")) LetGo(flags.go_on_from);
}

bool UsesSharedMemory(const ServiceFlags& flags, const QosProfiles& profiles) {
  if (flags.leaves_out_shared_memory) return false;
  const qos::XmlRead read = qos::ReadXml(profiles.text, profiles.name);
  return read.root && qos::UsesSharedMemory(qos::ReadProfiles(*read.root, profiles.name));
}

// The library makes new files in /dev/shm also while a process runs, when it finds one of its ports
// unhealthy. Where there is no space left, its first write ends the process by SIGBUS. The service
// then comes back over UDP alone, as after a crash: a vehicle joins again, and a world resumes from
// its checkpoint.
class FullMemory {
 public:
  FullMemory(const QosProfiles& in_use, const StopSignal& stop)
      : qos_(NameOf(in_use.name), in_use.text),
        crash_fallback_({SIGBUS},
                        {{"--leave-out", "shared_memory"},
                         {"--qos", qos_.Path()},
                         {"--former-qos", ""},
                         {"--rolled-back", ""},
                         {"--resume", ""},
                         {"--go-on-from", ""}},
                        kMemoryLost, stop) {}

 private:
  const HeldText qos_;
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
  if (!flags.memory_lost.empty()) {
    LogError("comes back over UDP alone, for its shared memory may be full: " + flags.memory_lost);
  }
  std::unique_ptr<FormerQos> former;
  std::unique_ptr<FullMemory> full_memory;  // once there is no former one: one fallback at a time
  if (!flags.former_qos.empty()) former = std::make_unique<FormerQos>(flags, stop);
  LifeEnd end;
  try {
    const link::LinkOptions options =
        LinkOptionsOf(flags, scenario, ReadProfilesAndKey(flags, scenario));
    const auto guard_memory = [&] {
      if (former || flags.lockstep || full_memory) return;
      if (!UsesSharedMemory(flags, options.qos)) return;
      full_memory = std::make_unique<FullMemory>(options.qos, stop);
    };
    const auto settled = [&] {
      former.reset();
      for (const std::string& held : {flags.former_qos, flags.go_on_from}) LetGo(held);
      guard_memory();
    };
    guard_memory();
    LetGo(flags.qos);
    end = live(options, settled);
    // It may have ended before it settled: what was held would stay open in each image to come.
    former.reset();
    if (end.back) LetGoOfReplaced(flags, *end.back);
  } catch (const std::exception& error) {
    if (!former) throw;
    end.back = former->Because(error.what());
  }
  if (!end.back) return end.exit_code;
  HoldSignalsBack();
  // A stop that came while the link was closed would be forgotten by a new process image.
  if (stop.IsSet()) return end.exit_code;
  FlushLog(kFlushLog);
  full_memory.reset();  // what it holds would stay open in each process image to come
  end.back->try_emplace(kMemoryLost, "");  // that was another restart
  RestartWith(*end.back);
}

}  // namespace giveway
