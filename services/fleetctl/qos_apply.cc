#include "services/fleetctl/qos_apply.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <optional>
#include <utility>
#include <variant>

#include "services/app/process.h"
#include "services/app/scenario_file.h"
#include "services/fleetctl/canary_watch.h"
#include "services/fleetctl/exit_codes.h"
#include "services/fleetctl/interrupts.h"
#include "services/fleetctl/orders.h"
#include "services/fleetctl/qos_apart.h"
#include "services/fleetctl/qos_apply_report.h"
#include "services/fleetctl/qos_files.h"
#include "services/qos/order_check.h"
#include "services/qos/rules.h"
#include "services/qos/xml_tree.h"
#include "services/types/check.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::seconds;

constexpr auto kFindPatience = seconds(10);
constexpr auto kTellPatience = seconds(5);
constexpr auto kApplyPatience = seconds(20);  // a restart takes about one, on a busy machine more
constexpr auto kHearPatience = seconds(10);

[[noreturn]] void Refuse(const std::string& file, const std::string& what,
                         const std::string& remedy) {
  throw app::InputError({{file, 0, "", "", what, remedy}});
}

QosProfiles ReadProfilesToApply(const std::string& argument) {
  const std::string path = ResolveQosFile(argument);
  auto read = ReadQosFile(path);
  if (const auto* finding = std::get_if<qos::Finding>(&read)) {
    Refuse(path, finding->values, finding->remedy);
  }
  std::string text = std::move(std::get<qos::ProfileFile>(read).bytes);
  if (text.size() > QosProfiles::kMostBytes) {
    Refuse(path,
           "has " + std::to_string(text.size()) + " bytes, an order carries " +
               std::to_string(QosProfiles::kMostBytes),
           "leave comments out");
  }
  return {std::filesystem::path(path).filename(), std::move(text)};
}

qos::XmlElement RootOf(const QosProfiles& profiles) {
  qos::XmlRead read = qos::ReadXml(profiles.text, profiles.name);
  if (!read.root) Refuse(profiles.name, "is no XML", "see fleetctl qos check");
  return std::move(*read.root);
}

// The profiles that a vehicle has endpoints of: what an order to it can change.
qos::ProfileSet OfAVehicle(qos::ProfileSet set) {
  std::erase_if(set.profiles, [](const qos::Profile& profile) {
    const std::string& name = profile.name;
    const bool reads = name == "fleet_beacon_reader" || name == "fleet_admin_reader" ||
                       (name.starts_with("world_") && name.ends_with("_reader"));
    const bool writes = name.starts_with("fleet_") && name.ends_with("_writer");
    return !reads && !writes;
  });
  return set;
}

class Applying {
 public:
  Applying(const QosApplyOptions& options, const link::LinkOptions& link, QosProfiles wanted)
      : options_(options), link_(link), orders_(link), wanted_(std::move(wanted)) {
    report_.profile = wanted_.name;
  }

  // Asks every vehicle what it runs with. 0, or the exit code if one does not answer.
  int Ask();
  ApplyReport Run();

 private:
  std::optional<ApplyVerdict> WhyNot();
  void CheckAgainstOld();
  void CheckAsOrder();
  bool ApplyTo(AppliedTo* applied);
  std::optional<ApplyVerdict> Try(AppliedTo* canary);
  // Whether it says that it runs with its old profiles.
  bool RollBack(VehicleId canary);
  const AdminAnswer& ToldBy(VehicleId vehicle) const { return told_.at(vehicle); }
  void Say(const std::string& text) const {
    if (!options_.json) std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
  }

  const QosApplyOptions& options_;
  const link::LinkOptions& link_;
  Orders orders_;
  const QosProfiles wanted_;
  std::map<VehicleId, AdminAnswer> told_;
  ApplyReport report_;
};

int Applying::Ask() {
  std::vector<VehicleId> targets;
  for (const std::uint32_t id : options_.to) targets.push_back(VehicleId{id});
  const std::vector<VehicleId> missing = orders_.Seek(targets, kFindPatience);
  int code = 0;
  for (const VehicleId vehicle : missing) code = SayNotReached(vehicle, options_.where.domain);
  if (code != 0) return code;
  const qos::XmlElement wanted = RootOf(wanted_);
  for (const VehicleId vehicle : targets) {
    auto answer = orders_.Give(TellOrder(vehicle), kTellPatience);
    if (!answer) return SayNoAnswer(vehicle);
    AppliedTo applied;
    applied.vehicle = vehicle;
    applied.before = answer->profiles.name;
    applied.changes = qos::Changes(RootOf(answer->profiles), wanted);
    report_.vehicles.push_back(std::move(applied));
    told_.emplace(vehicle, std::move(*answer));
  }
  // The canary goes first, whatever the order on the command line.
  std::ranges::stable_partition(report_.vehicles, [&](const AppliedTo& applied) {
    return applied.vehicle == VehicleId{options_.canary};
  });
  return 0;
}

// While some run with the old profiles and some with the new, and wherever the world keeps the old,
// each must still hear the other.
void Applying::CheckAgainstOld() {
  const qos::ProfileSet wanted = OfAVehicle(qos::ReadProfiles(RootOf(wanted_), wanted_.name));
  std::vector<std::string> seen;
  for (const auto& [vehicle, answer] : told_) {
    if (std::ranges::find(seen, answer.profiles.text) != seen.end()) continue;
    seen.push_back(answer.profiles.text);
    const qos::ProfileSet old =
        qos::ReadProfiles(RootOf(answer.profiles), "running " + answer.profiles.name);
    qos::CheckPairs(old, wanted, &report_.findings);
    qos::CheckPairs(wanted, old, &report_.findings);
  }
}

// The vehicles would refuse it, and this says it before any has changed.
void Applying::CheckAsOrder() {
  const qos::XmlElement wanted = RootOf(wanted_);
  std::vector<std::string> seen;
  for (const auto& [vehicle, answer] : told_) {
    if (std::ranges::find(seen, answer.profiles.text) != seen.end()) continue;
    seen.push_back(answer.profiles.text);
    std::ranges::move(qos::CheckOrder(wanted, RootOf(answer.profiles), wanted_.name),
                      std::back_inserter(report_.findings));
  }
}

std::optional<ApplyVerdict> Applying::WhyNot() {
  std::int64_t fleet_size = 1;
  for (const auto& [vehicle, answer] : told_) {
    fleet_size = std::max<std::int64_t>(fleet_size, answer.fleet_size);
  }
  report_.findings = qos::Check({{wanted_.name, wanted_.text}}, {.vehicles = fleet_size});
  CheckAsOrder();
  if (!options_.force) CheckAgainstOld();
  std::erase_if(report_.findings, [](const qos::Finding& finding) {
    return finding.severity != qos::Severity::kError;
  });
  if (!report_.findings.empty()) return ApplyVerdict::kRefused;
  const auto unchanged = [](const AppliedTo& applied) { return applied.changes.empty(); };
  if (std::ranges::all_of(report_.vehicles, unchanged)) return ApplyVerdict::kNothingToDo;
  const auto restarts = [](const AppliedTo& applied) { return qos::NeedsRestart(applied.changes); };
  if (!options_.restart && std::ranges::any_of(report_.vehicles, restarts)) {
    report_.remedy = "it takes restarts, and --no-restart forbids them";
    return ApplyVerdict::kRefused;
  }
  if (options_.dry_run) return ApplyVerdict::kDryRun;
  return {};
}

// Whether the endpoints run with what was changed.
void Hold(const AdminAnswer& answer, AppliedTo* applied) {
  for (const qos::Change& change : applied->changes) {
    for (const LiveValue& live : answer.live) {
      if (live.profile != change.profile || live.policy != change.what) continue;
      ++applied->checked;
      applied->seen += live.number == change.number ? 1 : 0;
    }
  }
}

bool Applying::ApplyTo(AppliedTo* applied) {
  const SteadyTime begun = app::SteadyNow();
  const auto answer = orders_.Give(ApplyOrder(applied->vehicle, wanted_), kApplyPatience);
  applied->seconds = Seconds(app::SteadyNow() - begun);
  applied->answered = answer.has_value();
  applied->in_effect = answer && answer->state == AnswerState::kInEffect;
  if (!answer) applied->refusal = "gave no answer; see its log";
  if (answer && !applied->in_effect) applied->refusal = "refuses it: " + answer->reason;
  if (applied->in_effect) Hold(*answer, applied);
  Say(LineOf(*applied));
  return applied->in_effect;
}

bool Applying::RollBack(VehicleId canary) {
  const auto answer =
      orders_.Give(ApplyOrder(canary, ToldBy(canary).profiles), kApplyPatience, true);
  return answer && answer->state == AnswerState::kInEffect;
}

std::optional<ApplyVerdict> Applying::Try(AppliedTo* canary) {
  CanaryWatch watch(link_);
  CanaryTrial trial;
  trial.vehicle = canary->vehicle;
  if (!ApplyTo(canary)) {
    // Refused: nothing was changed. Without an answer nobody knows.
    if (canary->answered) return ApplyVerdict::kRefused;
    trial.worse = canary->refusal;
  } else if (watch.WaitUntilItHears(canary->vehicle, kHearPatience)) {
    const auto both = watch.Watch(canary->vehicle, FromSeconds(options_.watch_s));
    trial.seconds = options_.watch_s;
    trial.canary = both.canary;
    trial.rest = both.rest;
    trial.worse = both.trouble.empty() ? WhyWorse(both.canary, both.rest) : both.trouble;
  } else {
    trial.worse = "it hears no beacon";
  }
  // An operator who stops the trial has not seen that it is good.
  if (Interrupts::Count() > 0) trial.worse = "interrupted";
  report_.trial = trial;
  Say(LineOf(trial));
  if (trial.worse.empty()) return {};
  return RollBack(canary->vehicle) ? ApplyVerdict::kRolledBack : ApplyVerdict::kNotRolledBack;
}

ApplyReport Applying::Run() {
  Say(PlanText(report_));
  if (const auto why_not = WhyNot()) {
    report_.verdict = *why_not;
    return report_;
  }
  for (AppliedTo& applied : report_.vehicles) {
    if (Number(applied.vehicle) == options_.canary) {
      if (const auto ends = Try(&applied)) {
        report_.verdict = *ends;
        return report_;
      }
    } else if (!ApplyTo(&applied)) {
      report_.verdict = ApplyVerdict::kRefused;
      report_.remedy = "the vehicles before it run with the new profiles, the rest with the old";
      return report_;
    }
  }
  const auto not_seen = [](const AppliedTo& applied) { return applied.seen < applied.checked; };
  if (std::ranges::any_of(report_.vehicles, not_seen)) report_.verdict = ApplyVerdict::kNotSeen;
  return report_;
}

}  // namespace

int RunQosApply(const QosApplyOptions& options) {
  if (!HasStdout()) return kCouldNotRun;
  QosProfiles wanted = ReadProfilesToApply(options.profile);
  link::LinkOptions link = LinkOptionsOf(options.where);
  // The library's own word, before this process touches it and before any vehicle depends on it.
  link::LinkOptions tried = link;
  tried.qos_file = ResolveQosFile(options.profile);
  ResolveQosApart(tried);
  const Interrupts interrupts;
  Applying applying(options, link, std::move(wanted));
  if (const int code = applying.Ask(); code != 0) return code;
  const ApplyReport report = applying.Run();
  const std::string last = options.json ? ToJson(report) : LineOf(report);
  const Told told = Tell(last);
  return told == Told::kFailed ? ExitCodeOf(told) : ExitCode(report.verdict);
}

}  // namespace giveway::fleetctl
