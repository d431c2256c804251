#include "services/vehicle_node/world_time.h"

#include <algorithm>
#include <utility>

namespace giveway {
namespace {

template <typename Scan>
void TakeNewest(const Scan* came, std::optional<Scan>* held) {
  if (came != nullptr) *held = *came;
}

template <typename Scan>
void GiveUnlessNewer(const std::optional<Scan>& held, const Scan** to) {
  if (*to == nullptr && held) *to = &*held;
}

}  // namespace

void WorldTime::Held::Take(const Inputs& inputs) {
  TakeNewest(inputs.radar, &radar);
  TakeNewest(inputs.lidar, &lidar);
  TakeNewest(inputs.camera, &camera);
  if (inputs.pose_fix) pose_fix = inputs.pose_fix;
  TakeSignals(inputs.signals);
}

void WorldTime::Held::TakeSignals(std::span<const SignalState> newer) {
  for (const SignalState& state : newer) {
    const auto same = std::ranges::find(signals, state.id, &SignalState::id);
    if (same == signals.end()) {
      signals.push_back(state);
    } else {
      *same = state;
    }
  }
}

void WorldTime::Held::Give(Inputs* inputs) {
  GiveUnlessNewer(radar, &inputs->radar);
  GiveUnlessNewer(lidar, &inputs->lidar);
  GiveUnlessNewer(camera, &inputs->camera);
  if (!inputs->pose_fix) inputs->pose_fix = pose_fix;
  if (signals.empty()) return;
  TakeSignals(inputs->signals);
  inputs->signals = signals;
}

bool WorldTime::Keep(Inputs* inputs, Nanoseconds tick_period) {
  for (const ReceivedBeacon& beacon : inputs->beacons) held_.push_back(beacon);
  if (!inputs->scan) {
    sensed_.Take(*inputs);
    return false;
  }
  sensed_now_ = std::exchange(sensed_, {});
  sensed_now_.Give(inputs);
  inputs->now = Number(inputs->scan->tick) * tick_period;
  for (ReceivedBeacon& beacon : held_) {
    beacon.received = std::max(inputs->now, Number(After(beacon.beacon.tick, 1)) * tick_period);
  }
  now_.swap(held_);
  held_.clear();
  inputs->beacons = now_;
  inputs->events = {};
  return true;
}

}  // namespace giveway
