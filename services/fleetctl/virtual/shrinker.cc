#include "services/fleetctl/virtual/shrinker.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "services/config/problem.h"
#include "services/config/writing/scenario_rounding.h"
#include "services/config/writing/scenario_write.h"

namespace giveway::fleetctl {
namespace {

constexpr double kAfterwards_s = 1;  // left to a run beyond the violation
constexpr double kSpare_s = 60;      // beyond the free-flow time, for vehicles that are to arrive

// A removed vehicle is neither crashed, paused nor expected.
void RemoveVehicles(std::size_t first, std::size_t count, VirtualCase* made) {
  auto& vehicles = made->scenario.vehicles;
  const auto begin = vehicles.begin() + static_cast<std::ptrdiff_t>(first);
  vehicles.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
  const auto is_gone = [&](VehicleId id) {
    return std::ranges::find(vehicles, id, &VehicleOptions::id) == vehicles.end();
  };
  std::erase_if(made->plan.faults, [&](const auto& fault) { return is_gone(fault.vehicle); });
  std::erase_if(made->plan.radio.blackouts, [&](const auto& blackout) {
    return blackout.vehicle != kNoVehicle && is_gone(blackout.vehicle);
  });
  std::erase_if(made->plan.schedule, [&](const faults::Fault& fault) {
    const auto from = fault.parameters.from.value_or(kNoVehicle);
    return (fault.target.vehicle != kNoVehicle && is_gone(fault.target.vehicle)) ||
           (from != kNoVehicle && is_gone(from));
  });
  std::erase_if(made->scenario.faults, [&](const auto& fault) {
    return fault.kind == FaultKind::kKill && is_gone(fault.vehicle);
  });
  std::erase_if(made->scenario.expect.arrived, is_gone);
  std::erase_if(made->scenario.expect.halted, is_gone);
}

// A signal head that was removed neither fails nor falls silent.
void RemoveSignal(std::size_t at, Scenario* scenario) {
  const auto removed = scenario->signals.begin() + static_cast<std::ptrdiff_t>(at);
  std::erase_if(scenario->faults, [&](const PlannedFault& fault) {
    return fault.kind != FaultKind::kKill && fault.signal == removed->id;
  });
  scenario->signals.erase(removed);
}

// Empty where a made scenario breaks a rule of those that are read, as by rounding.
std::optional<Scenario> AsRead(const Scenario& scenario) {
  try {
    return ReadBack(scenario);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

class Shrinker {
 public:
  Shrinker(VirtualCase failing, sim::Invariant broken, const ShrinkProgress& progress)
      : best_(std::move(failing)), broken_(broken), progress_(progress) {}

  // Any removal may make further ones possible.
  void Run() {
    as_file_ = TryAsFile();
    if (!as_file_) Try(best_);
    bool smaller = true;
    while (smaller && !stopped_) {
      smaller = LeaveOutVehicles();
      smaller = LeaveOutScheduled() || smaller;
      smaller = LeaveOut(&VirtualCase::plan, &sim::VirtualPlan::faults) || smaller;
      smaller = LeaveOut(&VirtualCase::scenario, &Scenario::faults) || smaller;
      smaller = LeaveOut(&VirtualCase::scenario, &Scenario::walls) || smaller;
      smaller = LeaveOut(&VirtualCase::scenario, &Scenario::obstacles) || smaller;
      smaller = LeaveOut(&VirtualCase::scenario, &Scenario::doors) || smaller;
      smaller = LeaveOutSignals() || smaller;
      smaller = CalmRadio() || smaller;
      smaller = CutTime() || smaller;
    }
  }
  Shrunk Result() const { return {best_, violation_, tries_, as_file_}; }

 private:
  // Keeps the candidate if the invariant breaks in it too.
  bool Try(const VirtualCase& candidate) {
    if (stopped_ || !progress_(best_, tries_)) {
      stopped_ = true;
      return false;
    }
    ++tries_;
    const sim::VirtualOutcome outcome = sim::RunVirtually(candidate.scenario, candidate.plan);
    const auto first = std::ranges::find(outcome.first, broken_, &sim::Violation::invariant);
    if (first == outcome.first.end()) return false;
    violation_ = *first;
    best_ = candidate;
    return true;
  }

  // As its file is read: in few digits and with the sensors' draws of seed 0, or with what it needs
  // of all digits and of the seed that it failed with.
  bool TryAsFile() {
    const std::uint32_t seed = best_.scenario.seed;
    for (const Scenario& scenario : {Rounded(best_.scenario), best_.scenario}) {
      const std::optional<Scenario> read = AsRead(scenario);
      if (!read) continue;
      VirtualCase candidate = best_;
      candidate.scenario = *read;
      candidate.scenario.seed = 0;
      if (Try(candidate)) return true;
      candidate.scenario.seed = seed;
      if (seed != 0 && Try(candidate)) return true;
    }
    return false;
  }

  // Halves first, then quarters, down to single ones (delta debugging, Zeller 1999).
  bool LeaveOutVehicles() {
    bool smaller = false;
    for (std::size_t size = best_.scenario.vehicles.size() / 2; size > 0; size /= 2) {
      for (std::size_t first = 0; first + size <= best_.scenario.vehicles.size();) {
        VirtualCase candidate = best_;
        RemoveVehicles(first, size, &candidate);
        const bool fails = !candidate.scenario.vehicles.empty() && Try(candidate);
        smaller = smaller || fails;
        if (!fails) first += size;
      }
    }
    return smaller;
  }

  // As for vehicles: a schedule has many faults, and most are unrelated. A rule's draws for one do
  // not depend on another.
  bool LeaveOutScheduled() {
    bool smaller = false;
    const std::size_t all = best_.plan.schedule.size();
    for (std::size_t size = std::bit_floor(std::max<std::size_t>(all, 1)); size > 0; size /= 2) {
      for (std::size_t first = 0; first + size <= best_.plan.schedule.size();) {
        VirtualCase candidate = best_;
        const auto begin = candidate.plan.schedule.begin() + static_cast<std::ptrdiff_t>(first);
        candidate.plan.schedule.erase(begin, begin + static_cast<std::ptrdiff_t>(size));
        const bool fails = Try(candidate);
        smaller = smaller || fails;
        if (!fails) first += size;
      }
    }
    return smaller;
  }

  template <typename Owner, typename Element>
  bool LeaveOut(Owner VirtualCase::*owner, std::vector<Element> Owner::*list) {
    bool smaller = false;
    for (std::size_t i = 0; i < ((best_.*owner).*list).size();) {
      VirtualCase candidate = best_;
      auto& elements = (candidate.*owner).*list;
      elements.erase(elements.begin() + static_cast<std::ptrdiff_t>(i));
      const bool fails = Try(candidate);
      smaller = smaller || fails;
      if (!fails) ++i;
    }
    return smaller;
  }

  bool LeaveOutSignals() {
    bool smaller = false;
    for (std::size_t i = 0; i < best_.scenario.signals.size();) {
      VirtualCase candidate = best_;
      RemoveSignal(i, &candidate.scenario);
      const bool fails = Try(candidate);
      smaller = smaller || fails;
      if (!fails) ++i;
    }
    return smaller;
  }

  template <typename Value>
  bool Reset(Value sim::RadioSettings::*setting) {
    if (best_.plan.radio.*setting == Value{}) return false;
    VirtualCase candidate = best_;
    candidate.plan.radio.*setting = Value{};
    return Try(candidate);
  }

  bool CalmRadio() {
    bool smaller = false;
    for (const auto setting : {&sim::RadioSettings::loss, &sim::RadioSettings::reorder,
                               &sim::RadioSettings::duplicate}) {
      smaller = Reset(setting) || smaller;
    }
    smaller = Reset(&sim::RadioSettings::jitter) || smaller;
    smaller = Reset(&sim::RadioSettings::delay) || smaller;
    smaller = Reset(&sim::RadioSettings::loops_back) || smaller;
    if (best_.plan.radio.burst.enter > 0) {
      VirtualCase candidate = best_;
      candidate.plan.radio.burst = {};
      smaller = Try(candidate) || smaller;
    }
    return smaller;
  }

  // A run that shows which vehicles do not arrive must leave the time to.
  bool CutTime() {
    double needed_s = Number(violation_.tick) * Seconds(best_.scenario.tick_period) + kAfterwards_s;
    if (broken_ == sim::Invariant::kArrival) {
      needed_s = kSpare_s;
      for (const VehicleOptions& options : best_.scenario.vehicles) {
        needed_s = std::max(needed_s, sim::FreeFlowSeconds(options) + kSpare_s);
      }
    }
    needed_s = std::ceil(needed_s);
    if (needed_s >= best_.scenario.duration_s) return false;
    VirtualCase candidate = best_;
    candidate.scenario.duration_s = needed_s;
    return Try(candidate);
  }

  VirtualCase best_;
  sim::Invariant broken_;
  const ShrinkProgress& progress_;
  sim::Violation violation_;
  std::uint32_t tries_ = 0;
  bool stopped_ = false;
  bool as_file_ = false;
};

}  // namespace

std::optional<Shrunk> Shrink(const VirtualCase& failing, const ShrinkProgress& progress,
                             std::optional<sim::Invariant> which) {
  VirtualCase judged = failing;
  if (which) judged.plan.also_required |= 1U << static_cast<unsigned>(*which);
  const sim::VirtualOutcome outcome = sim::RunVirtually(judged.scenario, judged.plan);
  const auto broken = std::ranges::find_if(outcome.first, [&](const sim::Violation& violation) {
    return !which || violation.invariant == *which;
  });
  if (broken == outcome.first.end()) return std::nullopt;
  Shrinker shrinker(judged, broken->invariant, progress);
  shrinker.Run();
  return shrinker.Result();
}

}  // namespace giveway::fleetctl
