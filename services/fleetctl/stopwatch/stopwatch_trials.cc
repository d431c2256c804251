#include "services/fleetctl/stopwatch/stopwatch_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <optional>
#include <stdexcept>

#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/stopwatch/stopwatch_plan.h"
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
struct Struck {
  VehicleId victim = kNobody;
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
        note(wave.strikes.size());
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
    victims_.clear();
    IsCut(task_.fault) ? WaitForCut(wave) : WaitUntilWell();
    fleet_.ForgetSaid();
    for (const Strike& strike : wave.strikes) victims_.push_back(strike.victim);
    std::vector<Struck> struck = IsCut(task_.fault) ? Planned(wave) : StrikeAll(wave);
    while (!IsAllTold(struck)) Turn();
    for (const Struck& one : struck) result_.trials.push_back(TrialOf(one));
    CountFalseAlarms(struck);
    if (!IsCut(task_.fault)) Heal();
  }

  void Turn() {
    fleet_.Turn();
    if (Interrupts::Count() > 0) throw Trouble("interrupted");
    if (const auto loss = fleet_.Loss(victims_)) throw Trouble(*loss);
  }

  void WaitUntil(SteadyTime when) {
    while (SteadyNow() < when) Turn();
  }

  void WaitUntilWell() {
    const SteadyTime limit = SteadyNow() + kUntilWell;
    for (;;) {
      const auto deaf = fleet_.WhoHears().FirstDeaf(task_.fleet);
      if (!deaf) return;
      if (SteadyNow() > limit) {
        throw Trouble(fmt::format("vehicle {} does not hear vehicle {} within {:.0f} s",
                                  Number(deaf->first), Number(deaf->second), Seconds(kUntilWell)));
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
    result_.too_soon = fleet_.WhoHears().FirstDeaf(task_.fleet).has_value();
    if (result_.too_soon) throw Trouble("a link was cut before all vehicles received each other");
  }

  bool Watches(VehicleId vehicle) const {
    return std::ranges::find(victims_, vehicle) == victims_.end();
  }

  Struck StruckAt(VehicleId victim, const std::function<SteadyTime(VehicleId)>& when) const {
    Struck struck{victim, {}};
    for (const VehicleId vehicle : task_.fleet) {
      if (Watches(vehicle)) struck.at[vehicle] = when(vehicle);
    }
    return struck;
  }

  std::vector<Struck> Planned(const Wave& wave) {
    std::vector<Struck> struck;
    for (const Strike& strike : wave.strikes) {
      struck.push_back(StruckAt(strike.victim, [&](VehicleId watcher) {
        return *fleet_.BlackoutsSince(watcher) + wave.begin + strike.after;
      }));
    }
    WaitUntil(BeginOf(wave.begin + kWaveSpread));
    return struck;
  }

  std::vector<Struck> StrikeAll(const Wave& wave) {
    std::vector<Struck> struck;
    const SteadyTime begin = SteadyNow() + kNoticing;
    for (const Strike& strike : wave.strikes) {
      WaitUntil(begin + strike.after);
      const SteadyTime at = StrikeNow(strike.victim);
      struck.push_back(StruckAt(strike.victim, [at](VehicleId) { return at; }));
    }
    return struck;
  }

  // The time before the signal is sent: the time of the system call counts as detection. A loop
  // that is to hang reports this itself.
  SteadyTime StrikeNow(VehicleId victim) {
    const std::map<Fault, int> signals = {{Fault::kKill, SIGKILL},
                                          {Fault::kPause, SIGSTOP},
                                          {Fault::kExit, SIGTERM},
                                          {Fault::kHung, SIGUSR2}};
    const SteadyTime now = SteadyNow();
    fleet_.Signal(victim, signals.at(task_.fault));
    if (task_.fault != Fault::kHung) return now;
    while (SteadyNow() < now + kUntilWell) {
      for (const Said& said : fleet_.Heard()) {
        if (said.by == victim && said.word.kind == WordKind::kHangs) return said.word.at;
      }
      Turn();
    }
    throw Trouble(
        fmt::format("vehicle {} does not hang, though it was signalled to", Number(victim)));
  }

  // The watcher's first report by that mechanism after the fault.
  std::optional<SteadyTime> SeenBy(VehicleId watcher, Mechanism mechanism, VehicleId victim,
                                   SteadyTime at) const {
    for (const Said& said : fleet_.Heard()) {
      if (said.by == watcher && said.word.about == victim && said.word.at >= at &&
          MechanismOf(said.word.kind) == mechanism) {
        return said.word.at;
      }
    }
    return std::nullopt;
  }

  // True when everything that must be seen has been seen, or is too late; and what must not be seen
  // had its time.
  bool IsAllTold(const std::vector<Struck>& struck) const {
    const SteadyTime now = SteadyNow();
    for (std::size_t i = 0; i < kMechanisms; ++i) {
      const auto mechanism = static_cast<Mechanism>(i);
      const Duty duty = DutyOf(task_.fault, mechanism, limits_);
      const Nanoseconds promised = PromisedWithin(mechanism, limits_);
      for (const Struck& one : struck) {
        for (const auto& [watcher, at] : one.at) {
          const bool waits_for_it = duty == Duty::kMust && now < at + promised + kLateStill &&
                                    !SeenBy(watcher, mechanism, one.victim, at);
          const bool gives_it_time = duty == Duty::kNone && now < at + promised + kNoticing;
          if (waits_for_it || gives_it_time) return false;
        }
      }
    }
    return true;
  }

  Trial TrialOf(const Struck& struck) const {
    Trial trial{task_.fault, static_cast<std::uint32_t>(struck.at.size()), {}};
    for (const auto& [watcher, at] : struck.at) {
      for (std::size_t i = 0; i < kMechanisms; ++i) {
        const auto mechanism = static_cast<Mechanism>(i);
        const auto seen = SeenBy(watcher, mechanism, struck.victim, at);
        if (!seen) continue;
        trial.sightings.push_back(
            {mechanism, *seen - at, monitor_.LongestPause(at - limits_.beacon_period, *seen)});
      }
    }
    return trial;
  }

  void CountFalseAlarms(const std::vector<Struck>& struck) {
    for (const Said& said : fleet_.Heard()) {
      if (!Watches(said.by) || !MechanismOf(said.word.kind)) continue;
      const auto victim = std::ranges::find(struck, said.word.about, &Struck::victim);
      const bool early = victim != struck.end() && said.word.at < victim->at.at(said.by);
      if (victim == struck.end() || early) ++result_.false_alarms;
    }
  }

  // A vehicle that was dropped by its peers, or left, returns as a new process: see PlanWaves.
  void Heal() {
    for (const VehicleId victim : victims_) {
      task_.fault == Fault::kHung ? fleet_.Signal(victim, SIGUSR2) : Revive(victim);
    }
    victims_.clear();
  }

  void Revive(VehicleId victim) {
    if (task_.fault == Fault::kPause) fleet_.Signal(victim, SIGKILL);
    const SteadyTime limit = SteadyNow() + kEnding;
    while (fleet_.IsRunning(victim)) {
      if (SteadyNow() > limit) {
        throw Trouble(
            fmt::format("vehicle {} did not end, though it was asked to", Number(victim)));
      }
      Turn();
    }
    fleet_.Restart(victim);
  }

  const StopwatchTask& task_;
  const Limits& limits_;
  const StallMonitor& monitor_;
  const std::vector<Wave> waves_;
  StopwatchFleet fleet_;
  std::vector<VehicleId> victims_;  // of the current wave
  StopwatchResult result_;
};

}  // namespace

StopwatchResult Conduct(const StopwatchTask& task, const FleetSpec& spec, const Limits& limits,
                        const StallMonitor& monitor, const std::function<void(std::size_t)>& note) {
  return Conductor(task, spec, limits, monitor).Run(note);
}

}  // namespace giveway::fleetctl
