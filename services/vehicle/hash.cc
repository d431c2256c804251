// What a brain knows of its world and its peers, as one number. What it remembers beside that, such
// as detours or where it waited, shows here as soon as it drives by it.
#include "services/vehicle/vehicle.h"

namespace giveway {

std::uint64_t Vehicle::Hash() const {
  StateHash hash;
  const VehicleState& state = *state_;
  hash.Add(VehicleState::kVersion);
  hash.Add(state.seq);
  hash.Add(state.epoch);
  hash.Add(state.tick);
  hash.Add(state.run_state);
  hash.Add(state.wheels.left_rad_s);
  hash.Add(state.wheels.right_rad_s);
  hash.Add(state.counted.left_rad);
  hash.Add(state.counted.right_rad);
  state.odometry.AddTo(&hash);
  if (KeepsPose(options_.profile)) giveway::AddTo(state.pose, &hash);
  hash.Add(state.arrived);
  hash.Add(state.order.waited_ticks);
  hash.Add(state.waited_ticks);
  hash.Add(state.deaf);
  hash.Add(state.decision.mode);
  hash.Add(state.decision.rule);
  hash.Add(state.decision.peer);
  hash.Add(state.gives_way_to);
  state.ranges.AddTo(&hash);
  state.grid.AddTo(&hash);
  state.peers.AddTo(&hash);
  state.signals.AddTo(&hash);
  AddTo(state.objects, &hash);
  AddTo(state.last_heard, &hash);
  return hash.Value();
}

}  // namespace giveway
