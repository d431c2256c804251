// Carries out an operator's orders: tells what the vehicle runs with, and takes other profiles. A
// deadline is changed while it runs; anything else is fixed once the participant is made, so the
// vehicle halts, restarts itself and drives on.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/link/vehicle_link.h"
#include "services/qos/changes.h"
#include "services/types/admin.h"

namespace giveway {

class VehicleAdmin {
 public:
  // `in_use` is what the link was made with. In lockstep nothing that comes from outside the world
  // may change a run, so orders to apply are refused.
  VehicleAdmin(link::VehicleLink* link, const link::LinkOptions& options, VehicleId vehicle,
               QosProfiles in_use, bool lockstep);

  // Answers the order that made this process restart: it is in effect now.
  void AnswerResumed(std::uint64_t order);
  // Carries out the orders that have come. True if one takes a restart: those behind it are lost.
  bool Serve();
  // The order that a restart is for; where there is none, number 0 and the profiles in use.
  AdminOrder Pending() const;

 private:
  // True if it takes a restart.
  bool Apply(const AdminOrder& order);
  // False if the library would not have them while it runs.
  bool TakeNow(const std::vector<qos::Change>& changes);
  void Answer(std::uint64_t order, AnswerState state, const std::string& reason = "");

  link::VehicleLink& link_;
  const link::LinkOptions& options_;
  const VehicleId vehicle_;
  const bool lockstep_;
  QosProfiles in_use_;
  std::optional<AdminOrder> pending_;
};

}  // namespace giveway
