#include "services/vehicle/placing.h"

#include <cmath>

#include "services/types/math/math.h"
#include "services/vehicle/estimation/beacon_check.h"
#include "services/vehicle/estimation/injected_mutants.h"
#include "services/vehicle/situation/situation.h"
#include "services/vehicle/waiting.h"

namespace giveway {

void EnterWorld(WorldEpoch epoch, const Pose& world_from_body, const VehicleOptions& options,
                VehicleState* entering) {
  VehicleState& state = *entering;
  state.world.epoch = epoch;
  state.world.tick = kNoTick;
  state.world.run_state = RunState::kWaiting;
  state.motion.odometry = Odometry(world_from_body);
  Begin(options.profile, &state.motion.pose);
  state.motion.pose_tick = kNoTick;
  state.motion.wheels = {};
  state.route.waypoint = 0;
  state.progress.nearest_m = kFar_m;
  state.progress.no_progress_ticks = 0;
  state.progress.detour_tick = kNoTick;
  state.progress.away_tick = kNoTick;
  state.progress.stuck_ticks = 0;
  state.last.blocked_tick = kNoTick;
  state.movers.turned_tick = kNoTick;
  state.last.decided_tick = kNoTick;
  state.route.arrived = false;
  state.waiting.order.waited_ticks = 0;
  state.waiting.waited_ticks = 0;
  state.waiting.let_pass = false;
  state.movers.unidentified = false;
  state.sensed.ranges = {};
  state.sensed.grid = {};
  state.heard.signals.LeaveWorld();
  state.sensed.objects = {};
  state.sensed.doubt = {};
  state.heard.last_heard = {};
  state.heard.peers.LeaveWorld();
}

namespace {

// Resumes the interrupted task. The waiting time counts for this place, and the key is its own
// again.
void GoOn(TaskProgress task, const VehicleOptions& options, VehicleState* going_on) {
  VehicleState& state = *going_on;
  state.route.waypoint = OnRoute(options.route, task).waypoint;
  state.waiting.waited_ticks =
      task.waited_ticks <= Number(state.motion.pose_tick) ? task.waited_ticks : 0;
  state.waiting.waited_world = state.motion.odometry.WorldFromBody().position_world;
  state.waiting.order.waited_ticks = AgedTicks(state.waiting, options);
}

}  // namespace

std::optional<Handover> HandoverOf(const VehicleState& state) {
  if (state.world.epoch == kNoEpoch || state.motion.pose_tick == kNoTick) return std::nullopt;
  return Handover{.epoch = state.world.epoch,
                  .tick = state.motion.pose_tick,
                  .counted = state.motion.counted,
                  .world_from_body = state.motion.odometry.WorldFromBody(),
                  .covariance = PromisedCovariance(state.motion.odometry, state.motion.pose),
                  .task = {state.route.waypoint, state.waiting.waited_ticks}};
}

bool TakeOver(const Handover& handover, const VehicleOptions& options, VehicleState* taking) {
  if (!IsSound(handover)) return false;
  VehicleState& state = *taking;
  EnterWorld(handover.epoch, handover.world_from_body, options, &state);
  state.world.placed_in = handover.epoch;
  state.motion.odometry = Odometry(handover.world_from_body, handover.covariance);
  state.motion.pose_tick = handover.tick;
  state.motion.counted = handover.counted;
  GoOn(handover.task, options, &state);
  return true;
}

void TakeRoster(const RosterEntry& entry, const VehicleOptions& options, VehicleState* taking) {
  VehicleState& state = *taking;
  const Pose& pose = entry.start_world;
  // As a handover must be, for it becomes the own pose as well.
  const bool sound = std::isfinite(pose.position_world.x) && std::isfinite(pose.position_world.y) &&
                     Magnitude(pose.heading_rad) <= kPi && std::isfinite(entry.counted.left_rad) &&
                     std::isfinite(entry.counted.right_rad);
  if (!entry.accepted || entry.epoch == kNoEpoch || entry.epoch == state.world.placed_in || !sound)
    return;
  EnterWorld(entry.epoch, MutantActive(Mutant::kPlaceForgotten) ? options.start_world : pose,
             options, &state);
  state.world.placed_in = entry.epoch;
  state.motion.pose_tick = entry.tick;
  state.motion.counted = entry.counted;
  GoOn(MutantActive(Mutant::kRouteForgotten) ? TaskProgress{} : entry.task, options, &state);
}

}  // namespace giveway
