#include "services/vehicle/vehicle_state.h"

namespace giveway {

std::uint64_t HashOf(const VehicleState& state, const RobotModel& profile) {
  StateHash hash;
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
  if (KeepsPose(profile)) AddTo(state.motion.pose, &hash);
  hash.Add(state.route.arrived);
  hash.Add(state.waiting.order.waited_ticks);
  hash.Add(state.waiting.waited_ticks);
  hash.Add(state.movers.unidentified);
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
