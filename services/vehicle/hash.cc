// What a brain knows of its world and its peers, as one number. What it remembers beside that, such
// as detours or where it waited, shows here as soon as it drives by it.
#include "services/vehicle/vehicle.h"

namespace giveway {

std::uint64_t Vehicle::Hash() const {
  StateHash hash;
  const VehicleState& state = *state_;
  hash.Add(VehicleState::kVersion);
  hash.Add(state.published.seq);
  hash.Add(state.world.epoch);
  hash.Add(state.world.tick);
  hash.Add(state.world.run_state);
  hash.Add(state.motion.wheels.left_rad_s);
  hash.Add(state.motion.wheels.right_rad_s);
  hash.Add(state.motion.counted.left_rad);
  hash.Add(state.motion.counted.right_rad);
  state.motion.odometry.AddTo(&hash);
  if (KeepsPose(options_.profile)) giveway::AddTo(state.motion.pose, &hash);
  hash.Add(state.route.arrived);
  hash.Add(state.waiting.order.waited_ticks);
  hash.Add(state.waiting.waited_ticks);
  hash.Add(state.movers.deaf);
  hash.Add(state.last.decision.mode);
  hash.Add(state.last.decision.rule);
  hash.Add(state.last.decision.peer);
  hash.Add(state.published.gives_way_to);
  state.sensed.ranges.AddTo(&hash);
  state.sensed.grid.AddTo(&hash);
  state.heard.peers.AddTo(&hash);
  state.heard.signals.AddTo(&hash);
  AddTo(state.sensed.objects, &hash);
  AddTo(state.heard.last_heard, &hash);
  return hash.Value();
}

}  // namespace giveway
