#include "services/fleetctl/stopwatch/stopwatch_table.h"

#include <fmt/format.h>

#include <numeric>

namespace giveway::fleetctl {
namespace {

constexpr std::array<std::string_view, kFaults> kFaultNames = {"kill", "pause", "exit",
                                                               "hung", "cut",   "one_way"};
constexpr std::array<std::string_view, kMechanisms> kMechanismNames = {
    "beacon_age", "deadline", "liveliness", "lease", "good_bye"};

constexpr std::string_view kOnceATick =
    "the peer looks once a beacon period, half a period later where its scan is late";

// A control loop that awaits a scan gives up half a period after it was due (vehicle_loop.cc).
Nanoseconds LongestTick(const Limits& limits) { return limits.beacon_period * 3 / 2; }

std::optional<Nanoseconds> LimitOf(Mechanism mechanism, const Limits& limits) {
  switch (mechanism) {
    case Mechanism::kBeaconAge:
      return limits.beacon_age;
    case Mechanism::kDeadline:
      return limits.deadline;
    case Mechanism::kLiveliness:
      return limits.liveliness;
    case Mechanism::kLease:
      return limits.lease;
    case Mechanism::kLeaveNotice:
      return LongestTick(limits);
  }
  return std::nullopt;
}

std::string_view LimitName(Mechanism mechanism) {
  switch (mechanism) {
    case Mechanism::kBeaconAge:
      return "the scenario's beacon_age_limit_ms";
    case Mechanism::kDeadline:
      return "deadline of the profile fleet_beacon_reader";
    case Mechanism::kLiveliness:
      return "liveliness lease of the profile fleet_beacon_reader";
    case Mechanism::kLease:
      return "lease of the profile giveway_participant";
    case Mechanism::kLeaveNotice:
      return "a vehicle that is asked to stop looks as often as its peers do, then says so";
  }
  return "";
}

std::string_view DutyLabel(Duty duty) {
  switch (duty) {
    case Duty::kNone:
      return "none";
    case Duty::kMust:
      return "must see";
    case Duty::kIfManual:
      return "if manual";
    case Duty::kMay:
      return "may see";
  }
  return "";
}

}  // namespace

std::string_view Name(Fault fault) { return kFaultNames[static_cast<std::size_t>(fault)]; }
std::string_view Name(Mechanism mechanism) {
  return kMechanismNames[static_cast<std::size_t>(mechanism)];
}

std::optional<Fault> FaultNamed(std::string_view name) {
  for (std::size_t i = 0; i < kFaults; ++i) {
    if (kFaultNames[i] == name) return static_cast<Fault>(i);
  }
  return std::nullopt;
}

Duty DutyOf(Fault fault, Mechanism mechanism, const Limits& limits) {
  const Duty duty = kDuties[static_cast<std::size_t>(fault)][static_cast<std::size_t>(mechanism)];
  if (!LimitOf(mechanism, limits)) return Duty::kNone;
  if (duty != Duty::kIfManual) return duty;
  return limits.asserted == LivelinessKind::kAutomatic ? Duty::kNone : Duty::kMust;
}

std::vector<Term> Promise(Mechanism mechanism, const Limits& limits) {
  const std::optional<Nanoseconds> limit = LimitOf(mechanism, limits);
  if (!limit) return {};
  std::vector<Term> terms{{*limit, LimitName(mechanism)}, {LongestTick(limits), kOnceATick}};
  if (mechanism == Mechanism::kBeaconAge) {
    terms.push_back({LongestTick(limits),
                     "a beacon's age counts from the peer's tick after the one it was sent in"});
  }
  // Measured: half of a fleet of eight faulted together, 10 ms for each in the worst case.
  constexpr Nanoseconds kDropsOthersFirst = std::chrono::milliseconds(50);
  if (mechanism == Mechanism::kLease) {
    terms.push_back(
        {kDropsOthersFirst, "one thread of the library drops who fell silent together one by one"});
  }
  return terms;
}

Nanoseconds PromisedWithin(Mechanism mechanism, const Limits& limits) {
  const std::vector<Term> terms = Promise(mechanism, limits);
  return std::accumulate(terms.begin(), terms.end(), Nanoseconds{0},
                         [](Nanoseconds sum, const Term& term) { return sum + term.time; });
}

std::string TableText(const Limits& limits) {
  std::string text = "Which mechanism must see which fault:\n\n           ";
  for (const std::string_view name : kMechanismNames) text += fmt::format("{:<12}", name);
  for (std::size_t fault = 0; fault < kFaults; ++fault) {
    text += fmt::format("\n  {:<9}", kFaultNames[fault]);
    for (const Duty duty : kDuties[fault]) text += fmt::format("{:<12}", DutyLabel(duty));
  }
  text += R"(

if manual: must, where the writer's liveliness is MANUAL; none where it is AUTOMATIC, for then the
library asserts it, whatever the loop does.

Promised, each with the longest pause of the machine until then on top:
)";
  for (std::size_t i = 0; i < kMechanisms; ++i) {
    const auto mechanism = static_cast<Mechanism>(i);
    const std::vector<Term> terms = Promise(mechanism, limits);
    if (terms.empty()) {
      text += fmt::format("\n  {:<12} off in this profile", Name(mechanism));
      continue;
    }
    text += fmt::format("\n  {:<12} {:.0f} ms", Name(mechanism),
                        Milliseconds(PromisedWithin(mechanism, limits)));
    for (const Term& term : terms) {
      text += fmt::format("\n     {:>7.0f} ms  {}", Milliseconds(term.time), term.reason);
    }
  }
  return text + "\n";
}

}  // namespace giveway::fleetctl
