#include "services/fleetctl/stopwatch/stopwatch_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <optional>
#include <stdexcept>

#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/stopwatch/stopwatch_plan.h"
#include "services/runtime/hang_signal.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Nanoseconds kUntilWell = seconds(30);
constexpr Nanoseconds kLateStill = seconds(1);  // what is later than promised is reported as late
constexpr Nanoseconds kNoticing = milliseconds(200);  // to write and read a log line
constexpr Nanoseconds kEnding = seconds(3);           // of a process that was asked to

// Ends the trials of this fleet; what() says why.
class Trouble : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A target, and when it was faulted: for cuts by each watcher's own blackout clock.
struct InjectedFault {
  VehicleId target = kNoVehicle;
  std::map<VehicleId, SteadyTime> at;  // by watcher; empty until known
};

class Conductor {
 public:
  Conductor(const StopwatchTask& task, const FleetSpec& spec, const Limits& limits,
            const StallMonitor& monitor)
      : task_(task),
        limits_(limits),
        monitor_(monitor),
        waves_(PlanWaves(task.fault, task.trials, task.fleet, limits, task.seed)),
        fleet_(spec, Impairments()) {}

  StopwatchResult Run(const std::function<void(std::size_t)>& note) {
    try {
      for (const Wave& wave : waves_) {
        RunWave(wave);
        note(wave.injections.size());
      }
    } catch (const Trouble& trouble) {
      result_.problem = trouble.what();
    }
    return std::move(result_);
  }

 private:
  std::map<VehicleId, std::string> Impairments() const {
    std::map<VehicleId, std::string> rules;
    for (const VehicleId hearer : task_.fleet) {
      rules[hearer] = BlackoutsOf(hearer, task_.fault, waves_, task_.fleet);
    }
    return rules;
  }

  void RunWave(const Wave& wave) {
    targets_.clear();
    IsCut(task_.fault) ? WaitForCut(wave) : WaitUntilWell();
    fleet_.ForgetEvents();
    for (const FaultInjection& injection : wave.injections) targets_.push_back(injection.target);
    std::vector<InjectedFault> injected = IsCut(task_.fault) ? Planned(wave) : InjectAll(wave);
    while (!IsAllDetected(injected)) Turn();
    for (const InjectedFault& one : injected) result_.trials.push_back(TrialOf(one));
    CountFalseAlarms(injected);
    if (!IsCut(task_.fault)) Heal();
  }

  void Turn() {
    fleet_.Turn();
    if (Interrupts::Count() > 0) throw Trouble("interrupted");
    if (const auto loss = fleet_.Loss(targets_)) throw Trouble(*loss);
  }

  void WaitUntil(SteadyTime when) {
    while (SteadyNow() < when) Turn();
  }

  void WaitUntilWell() {
    const SteadyTime limit = SteadyNow() + kUntilWell;
    for (;;) {
      const auto unheard = fleet_.WhoHears().FirstUnheard(task_.fleet);
      if (!unheard) return;
      if (SteadyNow() > limit) {
        throw Trouble(fmt::format("vehicle {} does not hear vehicle {} within {:.0f} s",
                                  Number(unheard->first), Number(unheard->second),
                                  Seconds(kUntilWell)));
      }
      Turn();
    }
  }

  // By the clock of the vehicle that received the start signal last: a tick or two after the first.
  SteadyTime BeginOf(Nanoseconds since_start) const {
    SteadyTime latest{0};
    for (const VehicleId vehicle : task_.fleet) {
      latest = std::max(latest, fleet_.BlackoutsSince(vehicle).value_or(SteadyTime{0}));
    }
    return latest + since_start;
  }

  void WaitForCut(const Wave& wave) {
    const SteadyTime limit = SteadyNow() + kUntilWell;
    const auto counts = [this](VehicleId id) { return fleet_.BlackoutsSince(id).has_value(); };
    while (!std::ranges::all_of(task_.fleet, counts)) {
      if (SteadyNow() > limit) throw Trouble("not every vehicle received the start signal");
      Turn();
    }
    const SteadyTime ready = BeginOf(wave.begin) - 2 * kNoticing;
    WaitUntil(ready);
    result_.too_soon = fleet_.WhoHears().FirstUnheard(task_.fleet).has_value();
    if (result_.too_soon) throw Trouble("a link was cut before all vehicles received each other");
  }

  bool Watches(VehicleId vehicle) const {
    return std::ranges::find(targets_, vehicle) == targets_.end();
  }

  InjectedFault InjectedAt(VehicleId target,
                           const std::function<SteadyTime(VehicleId)>& when) const {
    InjectedFault injected{target, {}};
    for (const VehicleId vehicle : task_.fleet) {
      if (Watches(vehicle)) injected.at[vehicle] = when(vehicle);
    }
    return injected;
  }

  std::vector<InjectedFault> Planned(const Wave& wave) {
    std::vector<InjectedFault> injected;
    for (const FaultInjection& injection : wave.injections) {
      injected.push_back(InjectedAt(injection.target, [&](VehicleId watcher) {
        return *fleet_.BlackoutsSince(watcher) + wave.begin + injection.after;
      }));
    }
    WaitUntil(BeginOf(wave.begin + kWaveSpread));
    return injected;
  }

  std::vector<InjectedFault> InjectAll(const Wave& wave) {
    std::vector<InjectedFault> injected;
    const SteadyTime begin = SteadyNow() + kNoticing;
    for (const FaultInjection& injection : wave.injections) {
      WaitUntil(begin + injection.after);
      const SteadyTime at = InjectNow(injection.target);
      injected.push_back(InjectedAt(injection.target, [at](VehicleId) { return at; }));
    }
    return injected;
  }

  // The time before the signal is sent: the time of the system call counts as detection. A loop
  // that is to hang reports the time itself.
  SteadyTime InjectNow(VehicleId target) {
    const std::map<Fault, int> signals = {{Fault::kKill, SIGKILL},
                                          {Fault::kPause, SIGSTOP},
                                          {Fault::kExit, SIGTERM},
                                          {Fault::kHung, HangSignal::kHang}};
    const SteadyTime now = SteadyNow();
    fleet_.Signal(target, signals.at(task_.fault));
    if (task_.fault != Fault::kHung) return now;
    while (SteadyNow() < now + kUntilWell) {
      for (const VehicleLogEvent& logged : fleet_.Heard()) {
        if (logged.by == target && logged.event.kind == LogEventKind::kHangs)
          return logged.event.at;
      }
      Turn();
    }
    throw Trouble(
        fmt::format("vehicle {} does not hang, though it was signalled to", Number(target)));
  }

  // The watcher's first report by that mechanism after the fault.
  std::optional<SteadyTime> SeenBy(VehicleId watcher, Mechanism mechanism, VehicleId target,
                                   SteadyTime at) const {
    for (const VehicleLogEvent& logged : fleet_.Heard()) {
      if (logged.by == watcher && logged.event.about == target && logged.event.at >= at &&
          MechanismOf(logged.event.kind) == mechanism) {
        return logged.event.at;
      }
    }
    return std::nullopt;
  }

  // True when everything that must be seen has been seen, or is too late; and what must not be seen
  // had its time.
  bool IsAllDetected(const std::vector<InjectedFault>& injected) const {
    const SteadyTime now = SteadyNow();
    for (std::size_t i = 0; i < kMechanisms; ++i) {
      const auto mechanism = static_cast<Mechanism>(i);
      const Duty duty = DutyOf(task_.fault, mechanism, limits_);
      const Nanoseconds promised = PromisedWithin(mechanism, limits_);
      for (const InjectedFault& one : injected) {
        for (const auto& [watcher, at] : one.at) {
          const bool waits_for_it = duty == Duty::kMust && now < at + promised + kLateStill &&
                                    !SeenBy(watcher, mechanism, one.target, at);
          const bool gives_it_time = duty == Duty::kNone && now < at + promised + kNoticing;
          if (waits_for_it || gives_it_time) return false;
        }
      }
    }
    return true;
  }

  Trial TrialOf(const InjectedFault& injected) const {
    Trial trial{task_.fault, static_cast<std::uint32_t>(injected.at.size()), {}};
    for (const auto& [watcher, at] : injected.at) {
      for (std::size_t i = 0; i < kMechanisms; ++i) {
        const auto mechanism = static_cast<Mechanism>(i);
        const auto seen = SeenBy(watcher, mechanism, injected.target, at);
        if (!seen) continue;
        trial.sightings.push_back(
            {mechanism, *seen - at, monitor_.LongestPause(at - limits_.beacon_period, *seen)});
      }
    }
    return trial;
  }

  void CountFalseAlarms(const std::vector<InjectedFault>& injected) {
    for (const VehicleLogEvent& logged : fleet_.Heard()) {
      if (!Watches(logged.by) || !MechanismOf(logged.event.kind)) continue;
      const auto target = std::ranges::find(injected, logged.event.about, &InjectedFault::target);
      const bool early = target != injected.end() && logged.event.at < target->at.at(logged.by);
      if (target == injected.end() || early) ++result_.false_alarms;
    }
  }

  // A vehicle that was dropped by its peers, or left, returns as a new process: see PlanWaves.
  void Heal() {
    for (const VehicleId target : targets_) {
      task_.fault == Fault::kHung ? fleet_.Signal(target, HangSignal::kResume) : Revive(target);
    }
    targets_.clear();
  }

  void Revive(VehicleId target) {
    if (task_.fault == Fault::kPause) fleet_.Signal(target, SIGKILL);
    const SteadyTime limit = SteadyNow() + kEnding;
    while (fleet_.IsRunning(target)) {
      if (SteadyNow() > limit) {
        throw Trouble(
            fmt::format("vehicle {} did not end, though it was asked to", Number(target)));
      }
      Turn();
    }
    fleet_.Restart(target);
  }

  const StopwatchTask& task_;
  const Limits& limits_;
  const StallMonitor& monitor_;
  const std::vector<Wave> waves_;
  StopwatchFleet fleet_;
  std::vector<VehicleId> targets_;  // of the current wave
  StopwatchResult result_;
};

}  // namespace

StopwatchResult Conduct(const StopwatchTask& task, const FleetSpec& spec, const Limits& limits,
                        const StallMonitor& monitor, const std::function<void(std::size_t)>& note) {
  return Conductor(task, spec, limits, monitor).Run(note);
}

}  // namespace giveway::fleetctl
