// A vehicle's place in the world: what the world said of it last, and asking for another one where
// the place is lost or the run is over.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "services/link/drive_link.h"
#include "services/runtime/clock.h"
#include "services/vehicle_node/asking.h"

namespace giveway {

enum class PlaceNews : std::uint8_t {
  kNone,       // nothing that the vehicle has to know
  kEntry,      // a newer word on the place it has
  kElsewhere,  // the world was restarted, or gives it another place
};

// Says in the log that the world refused the vehicle, and why.
void LogRefusal(const RosterEntry& entry);

class VehiclePlace {
 public:
  // A place that was assigned. One that `stays` outlives the world.
  VehiclePlace(link::DriveLink* link, const Clock* clock, const RosterEntry& entry, bool stays)
      : link_(*link), clock_(*clock), entry_(entry), stays_(stays) {}

  const RosterEntry& Entry() const { return entry_; }
  bool RunHasEnded() const { return entry_.run_state == RunState::kEnded; }
  bool IsRefused() const { return is_refused_; }
  // There is nothing left to drive for.
  bool IsOver() const { return is_refused_ || (RunHasEnded() && !stays_); }
  // The world's reason to let it wait, while it asks for another place; else null.
  const std::string* WaitsFor() const { return asking_ ? &asking_->WaitsFor() : nullptr; }

  // The world's newest word.
  PlaceNews Follow(const RosterEntry& entry);
  // Of an entry whose place is not taken: whether the run of this place has ended, nothing else.
  void FollowRun(const RosterEntry& entry);
  // Once a turn: a vehicle that stays asks the next world when the run is over, until it is
  // answered. So does one that has had no body for a while: `lacks_body`, see DriveLink.
  void KeepAsking(bool lacks_body);

 private:
  void LookForBody(bool lacks_body);

  link::DriveLink& link_;
  const Clock& clock_;
  RosterEntry entry_;
  const bool stays_;
  std::optional<Asking> asking_;  // for another place
  bool is_refused_ = false;
  std::optional<SteadyTime> without_body_since_;
};

}  // namespace giveway
