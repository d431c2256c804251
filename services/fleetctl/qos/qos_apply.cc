#include "services/fleetctl/qos/qos_apply.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <optional>
#include <thread>
#include <utility>
#include <variant>

#include "services/config/problem.h"
#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/process/run_key.h"
#include "services/fleetctl/qos/admin_client.h"
#include "services/fleetctl/qos/canary_watch.h"
#include "services/fleetctl/qos/qos_apply_fleet.h"
#include "services/fleetctl/qos/qos_apply_report.h"
#include "services/fleetctl/qos/qos_in_child.h"
#include "services/qos/order_check.h"
#include "services/qos/rollout.h"
#include "services/qos/xml_tree.h"
#include "services/runtime/process.h"
#include "services/types/check.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::seconds;

// How often an order is given, and how long its answer and the answer to a question are waited for.
struct Patience {
  int given;
  seconds for_order;
  seconds for_answer;
};
// A restart takes about a second, on a busy machine more.
constexpr Patience kToApply{.given = 2, .for_order = seconds(20), .for_answer = seconds(5)};
// An order to go back may come while the process tries the set or restarts with it: it is refused
// then, or lost.
constexpr Patience kToGoBack{.given = 6, .for_order = seconds(5), .for_answer = seconds(2)};
constexpr auto kBetweenOrders = std::chrono::milliseconds(500);
constexpr auto kHearPatience = seconds(10);
constexpr auto kSeePatience = seconds(3);  // it reports five times a second

[[noreturn]] void Refuse(const std::string& file, const std::string& what,
                         const std::string& remedy) {
  throw InputError({{file, 0, "", "", what, remedy}});
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

// What must be undone after a failed canary, or a set that a vehicle refuses.
struct Undo {
  VehicleId process = kNoVehicle;
  QosProfiles profiles;
};

class Applying {
 public:
  Applying(const QosApplyOptions& options, const link::LinkOptions& link, const std::string& key,
           QosProfiles wanted)
      : options_(options), link_(link), client_(link, key), wanted_(std::move(wanted)) {
    report_.profile = wanted_.name;
  }

  // Asks every process what it runs with. 0, or the exit code if one of the targets does not
  // answer.
  int Ask();
  ApplyReport Run();

 private:
  std::optional<ApplyVerdict> WhyNot();
  void CheckAsOrder();
  void CheckAsIs();
  void Plan();
  std::optional<AdminAnswer> Order(VehicleId process, const QosProfiles& profiles, bool insist);
  bool ApplyTo(AppliedTo* applied, const QosProfiles& profiles, bool between);
  std::optional<ApplyVerdict> Take(const qos::RolloutStep& step);
  std::optional<ApplyVerdict> Try(AppliedTo* canary);
  // Those that do not report that they run with their previous set.
  std::vector<VehicleId> RollBack();
  // What became of the others, for a report that one refuses or gave no answer.
  std::string AfterRollBack();
  qos::Role RoleOf(VehicleId process) const {
    return process == kNoVehicle ? qos::Role::kWorld : qos::Role::kVehicle;
  }
  QosProfiles Between() const { return {"between-" + wanted_.name, rollout_.between}; }
  void ShowText(const std::string& text) const {
    if (!options_.json) std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
  }

  const QosApplyOptions& options_;
  const link::LinkOptions& link_;
  AdminClient client_;
  const QosProfiles wanted_;
  std::map<VehicleId, AdminAnswer> answers_;  // by every vehicle that takes orders, targets or not
  qos::Rollout rollout_;                      // its processes are report_.vehicles
  std::vector<Undo> undo_;
  ApplyReport report_;
};

int Applying::Ask() {
  FleetAnswers fleet;
  const int code = AskFleet(options_, &client_, &fleet);
  for (const VehicleId vehicle : fleet.not_administrable) {
    ShowText(NameOf(vehicle) + " takes no orders, and keeps what it has\n");
  }
  if (code != 0) return code;
  answers_ = std::move(fleet.answers);
  for (const VehicleId process : fleet.targets) {
    const QosProfiles& before = answers_.at(process).profiles;
    AppliedTo applied;
    applied.vehicle = process;
    applied.before = before.name;
    applied.changes =
        qos::ChangesFor(RoleOf(process), qos::Changes(RootOf(before), RootOf(wanted_)));
    report_.vehicles.push_back(std::move(applied));
  }
  return 0;
}

// At every moment each must receive the peers it received before, whether it has changed or not.
void Applying::Plan() {
  std::vector<qos::RolloutProcess> processes;
  const auto add = [&](VehicleId process, bool moves) {
    const QosProfiles& profiles = answers_.at(process).profiles;
    processes.push_back({NameOf(process), RoleOf(process),
                         qos::ReadProfiles(RootOf(profiles), profiles.name), moves});
  };
  for (const AppliedTo& applied : report_.vehicles) add(applied.vehicle, true);
  for (const auto& [process, answer] : answers_) {
    // Clang 14 does not capture a structured binding.
    const VehicleId id = process;
    const auto is_it = [id](const AppliedTo& applied) { return applied.vehicle == id; };
    if (std::ranges::none_of(report_.vehicles, is_it)) add(id, false);
  }
  const QosProfiles& own = link_.qos;
  processes.push_back(
      {"this fleetctl", qos::Role::kOperator, qos::ReadProfiles(RootOf(own), own.name), false});
  const auto first = options_.canary == 0 ? std::nullopt : std::optional<std::size_t>(0);
  rollout_ = qos::PlanRollout(processes, wanted_.text, wanted_.name, first);
  if (!options_.force) return;
  rollout_ = {};
  for (std::size_t i = 0; i < report_.vehicles.size(); ++i) rollout_.steps.push_back({i, false});
}

// The processes would refuse it; this reports it before any has changed.
void Applying::CheckAsOrder() {
  const qos::XmlElement wanted = RootOf(wanted_);
  std::vector<std::string> seen;
  for (const AppliedTo& applied : report_.vehicles) {
    const QosProfiles& running = answers_.at(applied.vehicle).profiles;
    if (std::ranges::find(seen, running.text) != seen.end()) continue;
    seen.push_back(running.text);
    std::ranges::move(qos::CheckOrder(wanted, RootOf(running), wanted_.name),
                      std::back_inserter(report_.findings));
  }
}

void Applying::CheckAsIs() {
  std::int64_t fleet_size = 1;
  for (const auto& [process, answer] : answers_) {
    fleet_size = std::max<std::int64_t>(fleet_size, answer.fleet_size);
  }
  // Each process holds the order against its own tick, and nothing has changed before the first
  // does; how many share a host only they see.
  const qos::Deployment deployment{
      .vehicles = fleet_size, .vehicles_a_host = 1, .tick_ns = UnknownFleet().tick_ns};
  report_.findings = qos::Check({{wanted_.name, wanted_.text}}, deployment);
  if (!rollout_.between.empty()) {
    std::ranges::move(qos::Check({{Between().name, Between().text}}, deployment),
                      std::back_inserter(report_.findings));
  }
}

std::optional<ApplyVerdict> Applying::WhyNot() {
  CheckAsIs();
  CheckAsOrder();
  std::ranges::copy(rollout_.blocked, std::back_inserter(report_.findings));
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

// The answer that it is in effect, or refused; none of a process that does not answer at all. An
// order or its answer may be lost with a participant that ends, or is new: then what the process
// reports to run with says which, and the order is given again if need be. `insist`: it must go
// back, and is not left alone before it has.
std::optional<AdminAnswer> Applying::Order(VehicleId process, const QosProfiles& profiles,
                                           bool insist) {
  const Patience patience = insist ? kToGoBack : kToApply;
  std::optional<AdminAnswer> answer;
  for (int given = 0; given < patience.given; ++given) {
    answer = client_.Send(ApplyRequest(process, profiles), patience.for_order, insist);
    if (answer && !(insist && answer->state == AnswerState::kRefused)) return answer;
    if (answer) {
      std::this_thread::sleep_for(kBetweenOrders);
      continue;
    }
    auto report = client_.AskQos(process, patience.for_answer, insist);
    if (report && report->profiles.text == profiles.text) return report;
    if (!report && !insist) return std::nullopt;
  }
  return answer;
}

bool Applying::ApplyTo(AppliedTo* applied, const QosProfiles& profiles, bool between) {
  const SteadyTime begun = SteadyNow();
  AdminAnswer& current = answers_.at(applied->vehicle);
  const auto answer = Order(applied->vehicle, profiles, false);
  applied->seconds = Seconds(SteadyNow() - begun);
  applied->answered = answer.has_value();
  applied->in_effect = answer && answer->state == AnswerState::kInEffect;
  if (answer && !applied->in_effect) applied->refusal = "refuses it: " + answer->reason;
  if (!answer) {
    applied->refusal = "gave no answer; see its log";
    undo_.push_back({applied->vehicle, current.profiles});  // it may carry the order out still
  }
  if (applied->in_effect) {
    if (!between) HoldAgainstChanges(current, *answer, applied);
    undo_.push_back({applied->vehicle, std::exchange(current.profiles, profiles)});
  }
  ShowText(between && applied->in_effect ? BetweenLine(*applied) : LineOf(*applied));
  return applied->in_effect;
}

std::vector<VehicleId> Applying::RollBack() {
  std::vector<VehicleId> unsure;
  for (; !undo_.empty(); undo_.pop_back()) {
    const Undo& undo = undo_.back();
    const auto answer = Order(undo.process, undo.profiles, true);
    if (!answer || answer->state != AnswerState::kInEffect) unsure.push_back(undo.process);
  }
  return unsure;
}

std::string Applying::AfterRollBack() {
  const bool any = !undo_.empty();
  std::string names;
  for (const VehicleId process : RollBack()) {
    names += (names.empty() ? "" : ", ") + NameOf(process);
  }
  if (!names.empty())
    return names + " may run with the new profiles still: fleetctl qos show --live";
  return any ? "the processes before it run with what they had again" : "";
}

std::optional<ApplyVerdict> Applying::Try(AppliedTo* canary) {
  CanaryWatch watch(link_);
  watch.WaitUntilSeen(canary->vehicle, kSeePatience);
  CanaryTrial trial;
  trial.vehicle = canary->vehicle;
  if (!ApplyTo(canary, wanted_, false)) {
    if (canary->answered) {  // refused: nothing was changed in it
      report_.remedy = AfterRollBack();
      return ApplyVerdict::kRefused;
    }
    trial.worse = canary->refusal;
  } else if (watch.WaitUntilItHears(canary->vehicle, qos::NeedsRestart(canary->changes),
                                    kHearPatience)) {
    const auto both = watch.Watch(canary->vehicle, FromSeconds(options_.watch_s));
    trial.seconds = options_.watch_s;
    trial.canary = both.canary;
    trial.rest = both.rest;
    trial.worse = both.trouble.empty() ? WhyWorse(both.canary, both.rest) : both.trouble;
  } else {
    trial.worse = "it hears no beacon";
  }
  // An operator who stops the trial has not confirmed that it is good.
  if (Interrupts::Count() > 0) trial.worse = "interrupted";
  report_.trial = trial;
  ShowText(LineOf(trial));
  if (trial.worse.empty()) return {};
  return RollBack().empty() ? ApplyVerdict::kRolledBack : ApplyVerdict::kNotRolledBack;
}

std::optional<ApplyVerdict> Applying::Take(const qos::RolloutStep& step) {
  AppliedTo& applied = report_.vehicles[step.process];
  const bool is_canary = options_.canary != 0 && Number(applied.vehicle) == options_.canary;
  if (is_canary && !step.between) return Try(&applied);
  if (ApplyTo(&applied, step.between ? Between() : wanted_, step.between)) return {};
  report_.remedy = AfterRollBack();
  return ApplyVerdict::kRefused;
}

ApplyReport Applying::Run() {
  Plan();
  for (const qos::RolloutStep& step : rollout_.steps) {
    report_.order.push_back(NameOf(report_.vehicles[step.process].vehicle) +
                            (step.between ? " (between)" : ""));
  }
  ShowText(PlanText(report_));
  if (const auto why_not = WhyNot()) {
    report_.verdict = *why_not;
    return report_;
  }
  for (const qos::RolloutStep& step : rollout_.steps) {
    if (const auto ends = Take(step)) {
      report_.verdict = *ends;
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
  // The library's own resolution, before this process uses it and before any vehicle depends on it.
  link::LinkOptions tried = link;
  tried.qos = {ResolveQosFile(options.profile), wanted.text};
  // If the rules find errors the report lists them, and the library is not asked.
  if (qos::WhyRefused({wanted.name, wanted.text}, UnknownFleet()).empty()) ResolveQosInChild(tried);
  const Interrupts interrupts;
  const std::string key = KeyToOrderWith(options.where.admin_key, options.where.domain);
  Applying applying(options, link, key, std::move(wanted));
  if (const int code = applying.Ask(); code != 0) return code;
  const ApplyReport report = applying.Run();
  const std::string last = options.json ? ToJson(report) : LineOf(report);
  const WriteResult result = WriteStdout(last);
  return result == WriteResult::kFailed ? ExitCodeOf(result) : ExitCode(report.verdict);
}

}  // namespace giveway::fleetctl
