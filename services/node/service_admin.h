// Carries out an operator's orders to a vehicle or a world: reports what it runs with, and takes
// other profiles. A deadline is changed while it runs; anything else is fixed once the participant
// is made, so the service restarts itself. Before it does, a second process tries the profiles: the
// library may refuse them, hang on them or end the process.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/auth/admin_gate.h"
#include "services/link/admin_link.h"
#include "services/link/fastdds/link_options.h"
#include "services/qos/changes.h"
#include "services/qos/deployment.h"
#include "services/runtime/line_budget.h"
#include "services/runtime/program_trial.h"
#include "services/runtime/restart.h"
#include "services/types/admin.h"

namespace giveway {

class ServiceAdmin {
 public:
  // The link was made with `options`, for a fleet of `deployment`; `vehicle` is kNoVehicle for a
  // world. In lockstep nothing that comes from outside the world may change a run, so orders to
  // apply are refused.
  // `gate` says which orders are carried out at all. `keep` has the recording's ring kept: false
  // where there is none, or it is kept often enough.
  ServiceAdmin(link::AdminLink* link, const link::LinkOptions& options,
               const qos::Deployment& deployment, VehicleId vehicle, bool lockstep,
               auth::AdminGate gate, std::function<bool()> keep = {});

  // Answers the order that made this process restart: it is in effect now; or not, where
  // `rolled_back` says why the process came back with what it had.
  void AnswerResumed(std::uint64_t order, const std::string& rolled_back);
  // Carries out the orders that have come; never waits. True if one takes a restart: those behind
  // it are lost.
  bool Serve();
  // The flags with which this process comes back with the profiles of the order that a restart is
  // for, and can go back to those it has now. Where no order takes one, or the new ones cannot be
  // held: with those it has.
  NewFlags ToComeBack() const;
  // Of the order that a restart is for; 0 where none takes one.
  std::uint64_t Order() const { return IsTaken() ? pending_->number : 0; }

 private:
  bool IsTaken() const { return pending_ && !trial_; }
  // False where it may not be carried out, which is logged now and then.
  bool MayServe(const AdminRequest& order);
  // True if it takes a restart.
  bool Apply(const AdminRequest& order);
  bool FinishTrial();
  // False if the library would not have them while it runs.
  bool TakeNow(const std::vector<qos::Change>& changes);
  void Keep(const AdminRequest& order);
  void Refuse(const AdminRequest& order, const std::string& why);
  void Answer(std::uint64_t order, AnswerState state, const std::string& reason = "");

  link::AdminLink& link_;
  const link::LinkOptions& options_;
  const qos::Deployment deployment_;
  const VehicleId vehicle_;
  const bool lockstep_;
  auth::AdminGate gate_;
  LineBudget refusal_lines_{2};
  LineBudget refusal_answers_{8};  // an intruder may ask as often as it likes
  const std::function<bool()> keep_;
  QosProfiles in_use_;
  std::optional<AdminRequest> pending_;
  std::unique_ptr<ProgramTrial> trial_;  // of pending_
};

}  // namespace giveway
