// How a brain keeps its own pose: what it makes of fixes, how sure it is, and when it says that it
// is lost. The filter and the judgement of fixes are estimation/pose_keeping.h.
#include "services/vehicle/vehicle.h"

namespace giveway {

// Those of a world that has not placed it yet say nothing.
void Vehicle::TakeFix(const Inputs& inputs) {
  VehicleState& state = *state_;
  if (state.world.tick == kNoTick) return;
  const FixTaker taker{.vehicle = options_.id,
                       .epoch = state.world.epoch,
                       .tick = state.world.tick,
                       .tick_s = Seconds(options_.tick_period)};
  TakeWaiting(options_.profile, taker, &state.motion.odometry, &state.motion.pose);
  if (inputs.pose_fix) {
    Take(*inputs.pose_fix, options_.profile, taker, &state.motion.odometry, &state.motion.pose);
  }
}

void Vehicle::LookAtOwnPose(Situation* s) {
  VehicleState& state = *state_;
  s->world_from_body = state.motion.odometry.WorldFromBody();
  s->forward_world = state.motion.odometry.ForwardWorld();
  s->covariance = PromisedCovariance(state.motion.odometry, state.motion.pose);
  s->known_share = JudgeCertainty(options_.profile, s->covariance, &state.motion.pose);
  s->lost = state.motion.pose.lost;
}

}  // namespace giveway
