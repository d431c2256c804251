#include "services/vehicle_node/world_time.h"

#include <algorithm>

namespace giveway {

bool WorldTime::Keep(Inputs* inputs, Nanoseconds tick_period) {
  for (const ReceivedBeacon& beacon : inputs->beacons) held_.push_back(beacon);
  if (!inputs->scan) return false;
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
