#include "services/fleetctl/soak/soak_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "services/faults/kind_table.h"
#include "sim_world/virtual/invariants.h"

namespace giveway::fleetctl {
namespace {

using faults::Kind;
using faults::Target;
using std::chrono::milliseconds;

constexpr double kHealP99_s = 2;
constexpr Nanoseconds kLingers = std::chrono::seconds(10);
// A fault that started later than this, and had less than this part of its time, is not judged.
constexpr double kLate_s = 0.1;
constexpr double kMostOfIt = 0.9;
// Of a step of the brain, which normally takes a thousandth of that: a fifth of the usual tick.
constexpr double kMostStep_us = 10'000;
// Added to the promised time: writing and reading the log line.
constexpr Nanoseconds kNoticing = milliseconds(200);

// The stopwatch's fault for a silence.
std::optional<fleetctl::Fault> AsOfStopwatch(Kind kind) {
  switch (kind) {
    case Kind::kKill:
    case Kind::kRestart:
      return fleetctl::Fault::kKill;
    case Kind::kPause:
      return fleetctl::Fault::kPause;
    case Kind::kHang:
      return fleetctl::Fault::kHung;
    default:
      return std::nullopt;
  }
}

// The fault that may have caused what happened to the vehicle: the last that started before and had
// not been over for ten seconds, preferably of those that affect it or all vehicles.
std::optional<std::size_t> FaultBehind(std::span<const faults::Fault> schedule,
                                       std::span<const FaultCourse> courses, VehicleId vehicle,
                                       SteadyTime at) {
  std::optional<std::size_t> injected;
  std::optional<std::size_t> any;
  for (std::size_t i = 0; i < courses.size(); ++i) {
    const FaultCourse& course = courses[i];
    if (!course.began || *course.began > at) continue;
    if (course.ended && at > *course.ended + kLingers) continue;
    any = i;
    const faults::Target& target = schedule[i].target;
    const bool everyone = target.what != faults::Target::What::kVehicle;
    if (everyone || target.vehicle == vehicle) injected = i;
  }
  return injected ? injected : any;
}

bool IsSeparating(Kind kind) {
  return AsOfStopwatch(kind) || kind == Kind::kQosMismatch || kind == Kind::kOneWayCut ||
         kind == Kind::kPartition || kind == Kind::kFlapping;
}

// While it lasts the peer does not hear the target, or does nothing itself.
bool Separates(const faults::Fault& fault, VehicleId peer, VehicleId target) {
  const bool all = fault.target.what == Target::What::kAll;
  if (!all && fault.target.what != Target::What::kVehicle) return false;
  const bool at_peer = all || fault.target.vehicle == peer;
  const VehicleId from = fault.parameters.from.value_or(target);
  if (fault.kind == Kind::kOneWayCut) return at_peer && from == target;
  return IsSeparating(fault.kind) && (at_peer || fault.target.vehicle == target);
}

class SoakEvaluation {
 public:
  SoakEvaluation(const SoakEvidence& evidence, SoakResult* result)
      : from_(evidence), result_(*result) {}

  void Run() {
    CheckFaults();
    CheckInvariants();
    CheckEnds();
    CheckWorld();
    CheckHealing();
    CheckSlopes();
    CheckSlowLoops();
    CheckTiming();
    CheckAccounting();
    result_.ticks_judged = from_.seen.ticks_judged;
    result_.ticks_unseen = from_.seen.ticks_unseen;
    result_.near_misses = from_.seen.near_misses;
    result_.near_misses_counted = from_.seen.near_misses_counted;
    result_.near_misses_by_block = from_.seen.near_misses_by_block;
    result_.modes = from_.seen.modes;
    result_.modes_counted = from_.seen.modes_counted;
    result_.pauses = from_.seen.pauses;
    result_.kept_rings = from_.seen.kept_rings;
    std::ranges::stable_sort(result_.violations, {}, &SoakViolation::time_s);
    Conclude();
  }

 private:
  std::optional<std::size_t> Behind(VehicleId vehicle, double time_s) const {
    return FaultBehind(from_.schedule, from_.seen.courses, vehicle,
                       from_.seen.started_at + FromSeconds(time_s));
  }

  std::string FaultNameBehind(VehicleId vehicle, double time_s) const {
    const auto behind = Behind(vehicle, time_s);
    return behind ? NameOf(result_.faults[*behind]) : std::string();
  }

  void AddViolation(double time_s, VehicleId vehicle, std::string invariant, std::string words,
                    VehicleId other = kNoVehicle) {
    Add({time_s, vehicle, other, std::move(invariant), std::move(words),
         FaultNameBehind(vehicle, time_s)});
  }

  // Of the fault itself.
  void AddViolation(std::size_t fault, std::string invariant, std::string words) {
    Add({StartOf(result_.faults[fault]), from_.schedule[fault].target.vehicle, kNoVehicle,
         std::move(invariant), std::move(words), NameOf(result_.faults[fault])});
  }

  void Add(SoakViolation violation) {
    ++result_.violations_counted;
    if (result_.violations.size() == kMostListed) return;
    result_.violations.push_back(std::move(violation));
  }

  std::vector<Expected> Promised(std::size_t fault) const {
    if (!from_.by_processes) return {};
    std::vector<Expected> expected = ExpectedOf(from_.schedule[fault], from_.limits);
    if (!expected.empty() && !SomePeerHears(fault)) expected.clear();
    return expected;
  }

  // False if at its start every peer was silenced or cut off itself: none can notice.
  bool SomePeerHears(std::size_t fault) const {
    const FaultCourse& course = from_.seen.courses[fault];
    if (from_.fleet.empty() || !course.began) return true;
    std::vector<std::size_t> others;
    for (const std::size_t i : separating_) {
      if (from_.schedule[i].at_s > from_.schedule[fault].at_s) break;
      if (i != fault && Lasts(i, *course.began)) others.push_back(i);
    }
    const VehicleId target = from_.schedule[fault].target.vehicle;
    return std::ranges::any_of(from_.fleet, [&](VehicleId peer) {
      return peer != target && std::ranges::none_of(others, [&](std::size_t i) {
               return Separates(from_.schedule[i], peer, target);
             });
    });
  }

  // Until what it concerned has recovered: a process that comes back must find its peers again.
  bool Lasts(std::size_t fault, SteadyTime at) const {
    const FaultCourse& course = from_.seen.courses[fault];
    if (!course.began || *course.began > at) return false;
    return !course.ended || !course.recovered || *course.recovered >= at;
  }

  void CheckFaults() {
    for (std::size_t i = 0; i < from_.schedule.size(); ++i) {
      if (IsSeparating(from_.schedule[i].kind)) separating_.push_back(i);
    }
    for (std::size_t i = 0; i < from_.schedule.size(); ++i) {
      promised_.push_back(Promised(i));
      result_.faults.push_back(FaultOf(i));
    }
    result_.faults_counted = result_.faults.size();
    result_.faults_observed =
        static_cast<std::uint64_t>(std::ranges::count(result_.faults, true, &SoakFault::observed));
    for (std::size_t i = 0; i < from_.schedule.size(); ++i) {
      EvaluateFault(i, result_.faults[i]);
    }
    std::uint32_t planned = 0;
    for (std::size_t i = 0; i < from_.schedule.size(); ++i) {
      const Kind kind = from_.schedule[i].kind;
      const bool restarts = kind == Kind::kRestart || kind == Kind::kQosMismatch;
      planned += restarts && from_.seen.courses[i].began ? 1 : 0;
    }
    result_.restarts_planned = planned;
    result_.restarts_unplanned = from_.seen.restarts;
  }

  SoakFault FaultOf(std::size_t number) const {
    const faults::Fault& fault = from_.schedule[number];
    const FaultCourse& course = from_.seen.courses[number];
    SoakFault entry{.rule = fault.rule,
                    .nth = fault.nth,
                    .at_s = fault.at_s,
                    .for_s = fault.for_s,
                    .kind = std::string(faults::ToString(fault.kind)),
                    .target = faults::ToString(fault.target),
                    .observed = !course.effect.empty(),
                    .observed_how = course.effect};
    if (!entry.observed) entry.observed_how = course.met_nothing;
    if (course.began) entry.observed_s = Seconds(*course.began - from_.seen.started_at);
    // One that took effect and was not undone.
    if (entry.observed && !course.failure.empty()) entry.observed_how += "; " + course.failure;
    // Other faults may also make peers hear less of the target, but not each time: nothing is
    // promised.
    for (const std::optional<SteadyTime>& noticed : course.noticed) {
      if (!noticed || !AsOfStopwatch(fault.kind)) continue;
      const double after_s = Seconds(*noticed - *course.began);
      if (!entry.noticed_after_s || after_s < *entry.noticed_after_s)
        entry.noticed_after_s = after_s;
    }
    for (const Expected& expected : promised_[number]) {
      const double within_s = Seconds(expected.within);
      entry.promised_s = std::min(entry.promised_s.value_or(within_s), within_s);
    }
    if (course.ended && course.recovered) {
      entry.recovered_after_s = Seconds(*course.recovered - *course.ended);
    }
    return entry;
  }

  // The soak ended before it, or the operator ended the soak while its effects might still come, or
  // it was carried out so late that too little of it was left.
  bool WasCutOff(const faults::Fault& fault, const FaultCourse& course) const {
    if (!course.ended) return from_.seen.interrupted;
    if (course.cut_off) return true;
    const double late_s = Seconds(*course.began - from_.seen.started_at) - fault.at_s;
    const double lasted_s = Seconds(*course.ended - *course.began);
    if (late_s > kLate_s && lasted_s < kMostOfIt * fault.for_s) return true;
    const SteadyTime end = from_.seen.started_at + FromSeconds(from_.seen.lasted_s);
    return from_.seen.interrupted && *course.ended + kLingers > end;
  }

  void EvaluateFault(std::size_t number, const SoakFault& entry) {
    const FaultCourse& course = from_.seen.courses[number];
    if (!course.began || WasCutOff(from_.schedule[number], course)) return;
    if (!entry.observed && course.met_nothing.empty()) {
      AddViolation(number, "effect",
                   fmt::format("{} was ordered, and no effect of it was seen{}{}", NameOf(entry),
                               course.failure.empty() ? "" : ": ", course.failure));
    }
    if (course.not_undone) {
      AddViolation(number, "not_undone",
                   fmt::format("{} was not taken back: {}", NameOf(entry), course.failure));
    }
    for (const Expected& expected : promised_[number]) {
      EvaluateDetection(number, expected);
    }
  }

  void EvaluateDetection(std::size_t number, const Expected& expected) {
    const FaultCourse& course = from_.seen.courses[number];
    const auto& noticed = course.noticed[static_cast<std::size_t>(expected.mechanism)];
    const std::string name = NameOf(result_.faults[number]);
    const std::string_view mechanism = fleetctl::Name(expected.mechanism);
    const Nanoseconds paused =
        course.paused[static_cast<std::size_t>(expected.mechanism)].value_or(Nanoseconds{0});
    if (!noticed) {
      AddViolation(number, "detection",
                   fmt::format("no peer noticed {} by its {}", name, mechanism));
    } else if (*noticed > LatestReport(*course.began, expected) + paused) {
      AddViolation(
          number, "detection",
          fmt::format("{} was noticed by its {} after {:.3f} s, promised are {:.3f} s", name,
                      mechanism, Seconds(*noticed - *course.began), Seconds(expected.within)));
    }
  }

  void CheckInvariants() {
    for (const BrokenInvariant& broken : from_.seen.broken) {
      AddViolation(broken.time_s, broken.what.vehicle,
                   std::string(sim::Name(broken.what.invariant)),
                   fmt::format("tick {}", Number(broken.what.tick)), broken.what.other);
    }
    // Of those that were not listed only the number is known.
    result_.violations_counted += from_.seen.broken_counted - from_.seen.broken.size();
  }

  void CheckEnds() {
    for (const UnplannedEnd& end : from_.seen.ends) {
      const bool of_vehicle = end.member.kind == MemberKind::kVehicle;
      const VehicleId vehicle = of_vehicle ? VehicleId{end.member.number} : kNoVehicle;
      std::string words = fmt::format("{} ended: {}", NameOf(end.member), end.how);
      if (!end.last_lines.empty()) words += "; the last it said: " + end.last_lines.back();
      AddViolation(end.time_s, vehicle, "process_ended", std::move(words));
    }
    // Of those that were not listed only the number is known.
    result_.violations_counted +=
        from_.seen.restarts - std::min<std::uint64_t>(from_.seen.restarts, from_.seen.ends.size());
  }

  // The faults that a world carries out wait for its time.
  void CheckWorld() {
    const std::optional<double>& stood_from_s = from_.seen.world_stood_from_s;
    if (!stood_from_s) return;
    std::size_t missing = 0;
    for (std::size_t i = 0; i < from_.schedule.size(); ++i) {
      const bool of_world = faults::ActorOf(from_.schedule[i].kind) == faults::Actor::kWorld;
      missing += of_world && !from_.seen.courses[i].began ? 1 : 0;
    }
    AddViolation(*stood_from_s, kNoVehicle, "world_stood",
                 fmt::format("the world's time stood from {:.1f} s to the end; {} of the faults "
                             "that it carries out did not come",
                             *stood_from_s, missing));
  }

  void CheckHealing() {
    if (from_.seen.faults_outlasted_it) {
      AddViolation(from_.seen.lasted_s, kNoVehicle, "healing",
                   "was not seen: the soak ended before its last fault");
    }
    SoakHistogram healing{.name = "healing",
                          .budgets = {{0.99, FromSeconds(kHealP99_s).count()},
                                      {1.0, FromSeconds(kHealWithin_s).count()}}};
    for (const auto& [vehicle, healed_s] : from_.seen.healing) {
      if (healed_s) healing.histogram.Add(FromSeconds(*healed_s));
      if (healed_s && *healed_s <= kHealWithin_s) continue;
      AddViolation(from_.seen.lasted_s, vehicle, "healing",
                   healed_s ? fmt::format("drove {:.1f} s after the last fault, promised are {} s",
                                          *healed_s, kHealWithin_s)
                            : "did not drive again after the last fault");
    }
    for (const auto& [vehicle, silent_s] : from_.seen.silent_s) {
      if (silent_s <= kHealWithin_s) continue;
      AddViolation(
          from_.seen.lasted_s, vehicle, "silent",
          fmt::format("no status was received of it for {:.1f} s after the last fault", silent_s));
    }
    if (healing.histogram.Count() > 0) result_.histograms.push_back(std::move(healing));
    AddTimes("noticed", &SoakFault::noticed_after_s);
    AddTimes("recovered", &SoakFault::recovered_after_s);
  }

  void AddTimes(const char* name, std::optional<double> SoakFault::*member) {
    SoakHistogram times{.name = name};
    for (const SoakFault& fault : result_.faults) {
      if (fault.*member) times.histogram.Add(FromSeconds(*(fault.*member)));
    }
    if (times.histogram.Count() > 0) result_.histograms.push_back(std::move(times));
  }

  void CheckSlopes() {
    result_.slopes = from_.seen.slopes;
    result_.lives_too_short = from_.seen.lives_too_short;
    result_.supervisor_cpu_share = from_.seen.supervisor_cpu_share;
    for (const ResourceSlope& slope : result_.slopes) {
      if (!slope.leak) continue;
      AddViolation(
          from_.seen.lasted_s, kNoVehicle, "leak",
          fmt::format("{} life {}: {} grows by {:.0f} an hour (95 %: {:.0f} to {:.0f})",
                      slope.process, slope.life + 1, ToString(slope.kind), slope.slope.per_hour,
                      slope.slope.low_per_hour, slope.slope.high_per_hour));
    }
  }

  void CheckSlowLoops() {
    for (const auto& [vehicle, step_us] : from_.seen.step_p99_us) {
      if (step_us <= kMostStep_us) continue;
      AddViolation(
          from_.seen.lasted_s, vehicle, "slow_loop",
          fmt::format("a hundredth of its steps took {:.1f} ms of processor time and more, of a "
                      "tick at most {:.0f}",
                      step_us / 1000, kMostStep_us / 1000));
    }
  }

  void CheckTiming() {
    const FleetTiming& timing = from_.seen.timing;
    for (SoakHistogram& measured : timing.Histograms()) {
      result_.histograms.push_back(std::move(measured));
    }
    result_.narrowest_margin = timing.Narrowest();
    result_.budget_spent = timing.BudgetSpent();
    result_.budget_spent_by_block = timing.BudgetSpentByBlock();
    result_.block_s = timing.BlockLength_s();
    result_.timing_values_lost = timing.Missed();
    for (const auto& [vehicle, stale] : timing.Stale()) {
      AddViolation(
          stale.first_s, vehicle, "stale_decision",
          fmt::format("{} of its decisions used beacons older than they may be, the oldest of "
                      "{:.0f} ms",
                      stale.count, Milliseconds(stale.oldest)));
    }
  }

  // A row contains only final counts: no excuse is needed.
  void CheckAccounting() {
    for (const PairAccount& pair : from_.seen.accounting.Pairs()) {
      result_.accounting.push_back({.writer = fmt::format("vehicle {}", Number(pair.writer)),
                                    .reader = fmt::format("vehicle {}", Number(pair.reader)),
                                    .topic = "fleet/beacon",
                                    .sent = pair.sums.sent,
                                    .accepted = pair.sums.accepted,
                                    .not_heard = pair.sums.not_heard,
                                    .refused = pair.sums.refused,
                                    .superseded = pair.sums.superseded,
                                    .lost = pair.sums.lost});
      if (pair.differing == 0) continue;
      AddViolation(from_.seen.lasted_s, pair.reader, "accounting",
                   fmt::format("{} beacons of vehicle {} are not accounted for at vehicle {}",
                               pair.differing, Number(pair.writer), Number(pair.reader)),
                   pair.writer);
    }
    if (result_.accounting.size() > kMostListed) {
      std::stable_partition(result_.accounting.begin(), result_.accounting.end(),
                            [](const AccountingRow& row) {
                              return row.Difference() != 0;  // those that must be listed
                            });
    }
    for (const VehicleId reader : from_.seen.accounting.WithoutAccount()) {
      AddViolation(from_.seen.lasted_s, reader, "accounting",
                   "it reports no account of the beacons it accepted");
    }
    for (const auto& [reader, beacons] : from_.seen.accounting.DepartedDiffering()) {
      AddViolation(from_.seen.lasted_s, reader, "accounting",
                   fmt::format("{} beacons of those that left are not accounted for at vehicle {}",
                               beacons, Number(reader)));
    }
  }

  void Conclude() {
    result_.ran_s = from_.seen.lasted_s;
    if (!from_.seen.started) {
      result_.verdict = from_.seen.interrupted ? SoakVerdict::kInterrupted : SoakVerdict::kNotRun;
      result_.reasons.emplace_back(from_.seen.interrupted ? "interrupted before the fleet drove"
                                                          : "not all vehicles drove within 60 s");
      return;
    }
    std::map<std::string, std::uint64_t> by_kind;
    for (const SoakViolation& broken : result_.violations) ++by_kind[broken.invariant];
    for (const auto& [kind, count] : by_kind) {
      result_.reasons.push_back(fmt::format("{}: {}", kind, count));
    }
    if (result_.pauses.share > kMostPausedShare) {
      result_.verdict = SoakVerdict::kNotRun;
      result_.reasons.insert(result_.reasons.begin(), kTooBusy);
    } else if (result_.violations_counted > 0) {
      result_.verdict = SoakVerdict::kFailed;
    } else {
      result_.verdict = from_.seen.interrupted ? SoakVerdict::kInterrupted : SoakVerdict::kPassed;
    }
  }

  const SoakEvidence& from_;
  SoakResult& result_;
  std::vector<std::vector<Expected>> promised_;  // of each fault: what must report it
  std::vector<std::size_t> separating_;          // the faults that do
};

}  // namespace

std::vector<Expected> ExpectedOf(const faults::Fault& fault, const Limits& limits) {
  std::vector<Expected> expected;
  const auto as = AsOfStopwatch(fault.kind);
  if (!as || fault.target.what != Target::What::kVehicle) return expected;
  for (const Mechanism mechanism : {Mechanism::kDeadline, Mechanism::kLiveliness}) {
    const Nanoseconds within = PromisedWithin(mechanism, limits);
    const bool lasts = fault.for_s <= 0 || FromSeconds(fault.for_s) > within + kNoticing;
    if (lasts && DutyOf(*as, mechanism, limits) == Duty::kMust) {
      expected.push_back({mechanism, within});
    }
  }
  return expected;
}

SteadyTime LatestReport(SteadyTime began, const Expected& expected) {
  return began + expected.within + kNoticing;
}

void EvaluateSoak(const SoakEvidence& evidence, SoakResult* result) {
  SoakEvaluation(evidence, result).Run();
}

}  // namespace giveway::fleetctl
