#include "services/vehicle_node/vehicle_place.h"

#include "services/runtime/process.h"

namespace giveway {

void LogRefusal(const RosterEntry& entry) {
  LogError("the world refused this vehicle: " + entry.reason);
}

PlaceNews VehiclePlace::Follow(const RosterEntry& entry) {
  const bool of_ended_run = asking_ && RunHasEnded() && entry.epoch == entry_.epoch;
  if (of_ended_run || (asking_ && !asking_->IsFinal(entry))) return PlaceNews::kNone;
  if (!entry.accepted && entry.waiting) {
    // Its place is gone; its id stays if it can, since everything it says is named after it.
    LogWarning("lost its place: " + entry.reason);
    asking_.emplace(&link_, &clock_, entry_.vehicle);
    return PlaceNews::kNone;
  }
  if (!entry.accepted) {
    LogRefusal(entry);
    is_refused_ = true;
    return PlaceNews::kNone;
  }
  const bool elsewhere = asking_ || entry.epoch != entry_.epoch;
  entry_ = entry;
  asking_.reset();
  return elsewhere ? PlaceNews::kElsewhere : PlaceNews::kEntry;
}

void VehiclePlace::KeepAsking() {
  if (stays_ && RunHasEnded() && !asking_) {
    LogInfo("the run has ended: waits for the next world");
    // As the same session: that world may know it from the request that is kept for later worlds.
    asking_.emplace(&link_, &clock_, entry_.vehicle, entry_.session);
  }
  if (asking_) asking_->AskAgainIfDue();
}

}  // namespace giveway
