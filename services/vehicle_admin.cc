#include "services/vehicle_admin.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "services/app/process.h"
#include "services/qos/check.h"
#include "services/qos/order_check.h"
#include "services/qos/xml_tree.h"
#include "services/types/check.h"

namespace giveway {
namespace {

// Why these profiles would not do; empty if they would. An operator has looked already: this is for
// the one that did not.
std::string WhatIsWrong(const QosProfiles& profiles, const QosProfiles& in_use,
                        std::uint32_t fleet_size) {
  qos::Findings findings = qos::Check({{profiles.name, profiles.text}}, {.vehicles = fleet_size});
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

VehicleAdmin::VehicleAdmin(link::VehicleLink* link, const link::LinkOptions& options,
                           VehicleId vehicle, QosProfiles in_use, bool lockstep)
    : link_(*link),
      options_(options),
      vehicle_(vehicle),
      lockstep_(lockstep),
      in_use_(std::move(in_use)) {}

AdminOrder VehicleAdmin::Pending() const {
  if (pending_) return *pending_;
  return {.vehicle = vehicle_, .number = 0, .kind = OrderKind::kApply, .profiles = in_use_};
}

void VehicleAdmin::AnswerResumed(std::uint64_t order) { Answer(order, AnswerState::kInEffect); }

bool VehicleAdmin::Serve() {
  for (const AdminOrder& order : link_.TakeOrders()) {
    if (order.vehicle != vehicle_) continue;
    if (order.kind == OrderKind::kTell) {
      Answer(order.number, AnswerState::kInEffect);
    } else if (lockstep_) {
      Answer(order.number, AnswerState::kRefused, "runs in lockstep, which nothing may disturb");
    } else if (Apply(order)) {
      return true;
    }
  }
  return false;
}

bool VehicleAdmin::Apply(const AdminOrder& order) {
  const std::string wrong = WhatIsWrong(order.profiles, in_use_, options_.fleet_size);
  if (!wrong.empty()) {
    app::LogWarning("refused the QoS of " + order.profiles.name + ": " + wrong);
    Answer(order.number, AnswerState::kRefused, wrong);
    return false;
  }
  const std::vector<qos::Change> changes = ChangesBetween(in_use_, order.profiles);
  if (qos::NeedsRestart(changes) || !TakeNow(changes)) {
    app::LogInfo("restarts itself with the QoS of " + order.profiles.name);
    Answer(order.number, AnswerState::kRestarting);
    pending_ = order;
    return true;
  }
  in_use_ = order.profiles;
  app::LogInfo("runs with the QoS of " + in_use_.name + " from now on");
  Answer(order.number, AnswerState::kInEffect);
  return false;
}

bool VehicleAdmin::TakeNow(const std::vector<qos::Change>& changes) {
  for (const qos::Change& change : changes) {
    if (link_.SetDeadline(change.profile, change.number)) continue;
    app::LogError("the library refused the deadline " + change.to + " of " + change.profile);
    return false;
  }
  return true;
}

void VehicleAdmin::Answer(std::uint64_t order, AnswerState state, const std::string& reason) {
  AdminAnswer answer{.vehicle = vehicle_,
                     .order = order,
                     .state = state,
                     .reason = reason,
                     .fleet_size = options_.fleet_size,
                     .interface = options_.interface,
                     .profiles = in_use_,
                     .live = {}};
  if (state == AnswerState::kInEffect) answer.live = link_.LiveQos();
  link_.SendAnswer(answer);
}

}  // namespace giveway
