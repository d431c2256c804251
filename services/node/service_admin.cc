#include "services/node/service_admin.h"

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include "services/qos/order_check.h"
#include "services/qos/profile_check.h"
#include "services/qos/xml_tree.h"
#include "services/runtime/process.h"
#include "services/types/check.h"

namespace giveway {
namespace {

// A participant takes a tenth of a second; a busy machine more.
constexpr Nanoseconds kTrialPatience = std::chrono::seconds(8);

// Why these profiles would not do; empty if they would. An operator has looked already: this is for
// the one that did not.
std::string WhatIsWrong(const QosProfiles& profiles, const QosProfiles& in_use,
                        const qos::Deployment& deployment) {
  qos::Findings findings = qos::Check({{profiles.name, profiles.text}}, deployment);
  const qos::XmlRead wanted = qos::ReadXml(profiles.text, profiles.name);
  const qos::XmlRead running = qos::ReadXml(in_use.text, in_use.name);
  if (wanted.root && running.root) {
    const qos::Findings beyond = qos::CheckOrder(*wanted.root, *running.root, profiles.name);
    findings.insert(findings.begin(), beyond.begin(), beyond.end());
  }
  const auto worst = std::ranges::find(findings, qos::Severity::kError, &qos::Finding::severity);
  if (worst == findings.end()) return "";
  return worst->place.file + ":" + std::to_string(worst->place.line) + ": " + worst->rule + ": " +
         worst->subject + " " + worst->values;
}

std::vector<qos::Change> ChangesBetween(const QosProfiles& from, const QosProfiles& to) {
  const qos::XmlRead before = qos::ReadXml(from.text, from.name);
  const qos::XmlRead after = qos::ReadXml(to.text, to.name);
  GIVEWAY_CHECK(before.root && after.root, from.name, to.name);
  return qos::Changes(*before.root, *after.root);
}

}  // namespace

ServiceAdmin::ServiceAdmin(link::AdminLink* link, const link::LinkOptions& options,
                           const qos::Deployment& deployment, VehicleId vehicle, bool lockstep,
                           auth::AdminGate gate, std::function<bool()> keep)
    : link_(*link),
      options_(options),
      deployment_(deployment),
      vehicle_(vehicle),
      lockstep_(lockstep),
      gate_(std::move(gate)),
      keep_(std::move(keep)),
      in_use_{NameOf(options.qos.name), options.qos.text} {}

void ServiceAdmin::AnswerResumed(std::uint64_t order, const std::string& rolled_back) {
  if (rolled_back.empty()) return Answer(order, AnswerState::kInEffect);
  Answer(order, AnswerState::kRefused, "came back with what it had: " + rolled_back);
}

bool ServiceAdmin::Serve() {
  if (trial_) return FinishTrial();
  if (pending_) return false;  // it is about to restart
  for (const AdminRequest& order : link_.TakeAdminRequests()) {
    if (order.vehicle != vehicle_ || !MayServe(order)) continue;
    if (order.kind == AdminRequestKind::kReportQos) {
      Answer(order.number, AnswerState::kInEffect);
    } else if (order.kind == AdminRequestKind::kKeepRing) {
      Keep(order);
    } else if (lockstep_) {
      Answer(order.number, AnswerState::kRefused, "runs in lockstep, which nothing may disturb");
    } else if (Apply(order)) {
      return true;
    }
  }
  return false;
}

// It is answered too: an operator with the wrong key, or a clock that is behind, must know.
bool ServiceAdmin::MayServe(const AdminRequest& order) {
  const std::string why = gate_.WhyNot(order);
  if (why.empty()) return true;
  if (refusal_lines_.Take(SteadyNow())) LogWarning("refused an order: " + why);
  if (refusal_answers_.Take(SteadyNow())) {
    link_.SendAnswer({.vehicle = vehicle_,
                      .order = order.number,
                      .state = AnswerState::kRefused,
                      .reason = why,
                      .interface = "",
                      .profiles = {}});
  }
  return false;
}

void ServiceAdmin::Keep(const AdminRequest& order) {
  if (keep_ && keep_()) return Answer(order.number, AnswerState::kInEffect);
  Answer(order.number, AnswerState::kRefused,
         "records no ring (--record-ring), or has kept as many as it may");
}

bool ServiceAdmin::Apply(const AdminRequest& order) {
  if (trial_) {
    Refuse(order, "it tries the profiles of another order");
    return false;
  }
  const std::string wrong = WhatIsWrong(order.profiles, in_use_, deployment_);
  if (!wrong.empty()) {
    Refuse(order, wrong);
    return false;
  }
  const std::vector<qos::Change> changes =
      qos::ChangesFor(vehicle_ == kNoVehicle ? qos::Role::kWorld : qos::Role::kVehicle,
                      ChangesBetween(in_use_, order.profiles));
  if (!qos::NeedsRestart(changes) && TakeNow(changes)) {
    in_use_ = order.profiles;
    LogInfo("runs with the QoS of " + in_use_.name + " from now on");
    Answer(order.number, AnswerState::kInEffect);
    return false;
  }
  try {
    trial_ = std::make_unique<ProgramTrial>(NewFlags{{"--resume", ""}, {"--former-qos", ""}},
                                            "--try-qos", order.profiles.name, order.profiles.text,
                                            kTrialPatience);
    pending_ = order;
  } catch (const std::system_error& error) {
    Refuse(order, error.what());
  }
  return false;
}

bool ServiceAdmin::FinishTrial() {
  const std::optional<std::string> result = trial_->Result();
  if (!result) return false;
  trial_.reset();
  if (!result->empty()) {
    Refuse(*pending_, "a participant with it cannot be made: " + *result);
    pending_.reset();
    return false;
  }
  LogInfo("restarts itself with the QoS of " + pending_->profiles.name);
  Answer(pending_->number, AnswerState::kRestarting);
  return true;
}

NewFlags ServiceAdmin::ToComeBack() const {
  const QosProfiles& next = IsTaken() ? pending_->profiles : in_use_;
  NewFlags flags{{"--former-qos", ""}, {"--rolled-back", ""}};
  if (HoldTextFor("--qos", next.name, next.text, &flags)) {
    HoldTextFor("--former-qos", in_use_.name, in_use_.text, &flags);
    return flags;
  }
  HoldAgain(options_.qos.name);  // of an earlier restart, and read since
  if (IsTaken()) flags["--rolled-back"] = "the new QoS cannot be held in memory";
  return flags;
}

void ServiceAdmin::Refuse(const AdminRequest& order, const std::string& why) {
  LogWarning("refused the QoS of " + order.profiles.name + ": " + why);
  Answer(order.number, AnswerState::kRefused, why);
}

bool ServiceAdmin::TakeNow(const std::vector<qos::Change>& changes) {
  for (const qos::Change& change : changes) {
    if (link_.SetDeadline(change.profile, change.number)) continue;
    LogError("the library refused the deadline " + change.to + " of " + change.profile);
    return false;
  }
  return true;
}

void ServiceAdmin::Answer(std::uint64_t order, AnswerState state, const std::string& reason) {
  AdminAnswer answer{.vehicle = vehicle_,
                     .order = order,
                     .state = state,
                     .reason = reason,
                     .fleet_size = options_.fleet_size,
                     .interface = options_.interface,
                     .profiles = in_use_,
                     .live = {}};
  if (state == AnswerState::kInEffect) answer.live = link_.LiveQos();
  answer = link::AsReceived(answer);
  gate_.Seal(&answer);
  link_.SendAnswer(answer);
}

}  // namespace giveway
