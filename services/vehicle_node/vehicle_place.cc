#include "services/vehicle_node/vehicle_place.h"

#include "services/runtime/process.h"

namespace giveway {
namespace {

// Its writer of ranges and that of the roster are found at different moments.
constexpr Nanoseconds kBodyPatience = std::chrono::seconds(4);

}  // namespace

void LogRefusal(const RosterEntry& entry) {
  LogError("the world refused this vehicle: " + entry.reason);
}

PlaceNews VehiclePlace::Follow(const RosterEntry& entry) {
  const bool of_ended_run = asking_ && RunHasEnded() && entry.epoch == entry_.epoch;
  if (of_ended_run || (asking_ && !asking_->IsFinal(entry))) return PlaceNews::kNone;
  if (!entry.accepted && entry.waiting) {
    // Its place is gone; its id stays if it can, since everything it says is named after it. So
    // does its session: a world keeps what a process claims, and hears only so many of its
    // sessions.
    LogWarning("lost its place: " + entry.reason);
    asking_.emplace(&link_, &clock_, entry_.vehicle, entry_.session);
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

void VehiclePlace::FollowRun(const RosterEntry& entry) {
  const bool of_this_place = entry.vehicle == entry_.vehicle && entry.epoch == entry_.epoch;
  if (of_this_place && entry.run_state == RunState::kEnded) entry_.run_state = entry.run_state;
}

// As the same session: the world may know it still.
void VehiclePlace::LookForBody(bool lacks_body) {
  if (!lacks_body || asking_ || RunHasEnded()) {
    without_body_since_.reset();
    return;
  }
  const SteadyTime now = clock_.Now();
  if (!without_body_since_) without_body_since_ = now;
  if (now - *without_body_since_ < kBodyPatience) return;
  LogWarning("has no body in the world: asks for its place again");
  asking_.emplace(&link_, &clock_, entry_.vehicle, entry_.session);
  without_body_since_.reset();
}

void VehiclePlace::KeepAsking(bool lacks_body) {
  LookForBody(lacks_body);
  if (stays_ && RunHasEnded() && !asking_) {
    LogInfo("the run has ended: waits for the next world");
    // As the same session: that world may know it from the request that is kept for later worlds.
    asking_.emplace(&link_, &clock_, entry_.vehicle, entry_.session);
  }
  if (asking_) asking_->AskAgainIfDue();
}

}  // namespace giveway
