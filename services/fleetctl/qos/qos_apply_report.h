// The result of `fleetctl qos apply` as values, and its text and JSON. Pure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/qos/canary.h"
#include "services/qos/changes.h"
#include "services/qos/finding.h"
#include "services/types/admin.h"
#include "services/types/ids.h"

namespace giveway::fleetctl {

struct AppliedTo {
  VehicleId vehicle = kNoVehicle;
  std::string before;  // name of the profiles it ran with
  std::vector<qos::Change> changes;
  bool answered = false;
  bool in_effect = false;
  std::string refusal;        // the vehicle's message; or that it did not answer
  double seconds = 0;         // from the order to its answer
  std::uint32_t checked = 0;  // values of its endpoints that were to change
  std::uint32_t seen = 0;     // those that have changed
};

struct CanaryTrial {
  VehicleId vehicle = kNoVehicle;
  double seconds = 0;
  ServiceFigures canary;
  ServiceFigures rest;
  std::string worse;  // empty: promoted
};

enum class ApplyVerdict : std::uint8_t {
  kApplied,
  kNothingToDo,
  kDryRun,
  kRefused,        // by our checks or by a vehicle
  kRolledBack,     // the canary performed worse, and runs with its old profiles again
  kNotRolledBack,  // the canary performed worse, and did not confirm the rollback
  kNotSeen,        // a vehicle reports it in effect, but its endpoints differ
};

struct ApplyReport {
  std::string profile;
  std::vector<AppliedTo> vehicles;
  std::vector<std::string> order;  // in which they take it
  std::optional<CanaryTrial> trial;
  qos::Findings findings;  // why it was refused
  std::string remedy;      // of a refusal that is not a finding
  ApplyVerdict verdict = ApplyVerdict::kApplied;
};

// Whether the endpoints run with the changed values. `before` is what the process answered before
// the first of its orders: what it had other than its file said, code decides, as announcements in
// a large fleet, and so it does with the new one.
void HoldAgainstChanges(const AdminAnswer& before, const AdminAnswer& now, AppliedTo* applied);

// "vehicle 3"; for kNoVehicle "the world".
std::string NameOf(VehicleId process);
int ExitCode(ApplyVerdict verdict);
// The changes and their vehicles; vehicles with the same changes together.
std::string PlanText(const ApplyReport& report);
std::string LineOf(const AppliedTo& applied);
// Of a step that leads to an intermediate set.
std::string BetweenLine(const AppliedTo& applied);
std::string LineOf(const CanaryTrial& trial);
std::string LineOf(const ApplyReport& report);  // the verdict
std::string ToJson(const ApplyReport& report);

}  // namespace giveway::fleetctl
