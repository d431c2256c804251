// Where a brain takes itself to be as it begins, in a world or in the next one: as the world says,
// or as the process before it knew.
#include <cmath>

#include "services/types/check.h"
#include "services/vehicle/estimation/beacon_check.h"
#include "services/vehicle/estimation/planted.h"
#include "services/vehicle/vehicle.h"

namespace giveway {

void Vehicle::Reseat(const VehicleOptions& options) {
  GIVEWAY_CHECK(options.id == options_.id, Number(options.id));
  options_ = options;
  cones_ = ConesOf(options.profile);
  state_->waiting.order = {.speed_bucket = SpeedBucket(options.cruise_m_s), .vehicle = options.id};
  state_->world.placed_in = kNoEpoch;
}

// What was seen, heard and waited for belongs to the world before.
void Vehicle::EnterWorld(WorldEpoch epoch, const Pose& world_from_body) {
  VehicleState& state = *state_;
  state.world.epoch = epoch;
  state.world.tick = kNoTick;
  state.world.run_state = RunState::kWaiting;
  state.motion.odometry = Odometry(world_from_body);
  Begin(options_.profile, &state.motion.pose);
  state.motion.reckoned = kNoTick;
  state.motion.wheels = {};
  state.route.waypoint = 0;
  state.progress.nearest_m = kNoGoal_m;
  state.progress.aimless_ticks = 0;
  state.progress.detour_tick = kNoTick;
  state.progress.away_tick = kNoTick;
  state.progress.caught_ticks = 0;
  state.last.blocked_tick = kNoTick;
  state.movers.turned_tick = kNoTick;
  state.last.decided_tick = kNoTick;
  state.route.arrived = false;
  state.waiting.order.waited_ticks = 0;
  state.waiting.waited_ticks = 0;
  state.waiting.let_pass = false;
  state.movers.deaf = false;
  state.sensed.ranges = {};
  state.sensed.grid = {};
  state.heard.signals.LeaveWorld();
  state.sensed.objects = {};
  state.heard.last_heard = {};
  state.heard.peers.LeaveWorld();
}

// With the task that was begun. What it waited it waited here. The order by it is its own again.
void Vehicle::GoOn(TaskProgress task) {
  VehicleState& state = *state_;
  state.route.waypoint = OnRoute(options_.route, task).waypoint;
  state.waiting.waited_ticks =
      task.waited_ticks <= Number(state.motion.reckoned) ? task.waited_ticks : 0;
  state.waiting.waited_world = state.motion.odometry.WorldFromBody().position_world;
  state.waiting.order.waited_ticks = AgedTicks();
}

std::optional<Handover> Vehicle::HandOver() const {
  const VehicleState& state = *state_;
  if (state.world.epoch == kNoEpoch || state.motion.reckoned == kNoTick) return std::nullopt;
  return Handover{.epoch = state.world.epoch,
                  .tick = state.motion.reckoned,
                  .counted = state.motion.counted,
                  .world_from_body = state.motion.odometry.WorldFromBody(),
                  .covariance = PromisedCovariance(state.motion.odometry, state.motion.pose),
                  .task = {state.route.waypoint, state.waiting.waited_ticks}};
}

bool Vehicle::TakeOver(const Handover& handover) {
  if (!IsSound(handover)) return false;
  VehicleState& state = *state_;
  EnterWorld(handover.epoch, handover.world_from_body);
  state.world.placed_in = handover.epoch;
  state.motion.odometry = Odometry(handover.world_from_body, handover.covariance);
  state.motion.reckoned = handover.tick;
  state.motion.counted = handover.counted;
  GoOn(handover.task);
  return true;
}

// Only the first entry of an epoch says something new: later ones are repeated, or tell of the run.
void Vehicle::TakeRoster(const RosterEntry& entry) {
  VehicleState& state = *state_;
  const Pose& pose = entry.start_world;
  const bool sound = std::isfinite(pose.position_world.x) && std::isfinite(pose.position_world.y) &&
                     std::isfinite(pose.heading_rad) && std::isfinite(entry.counted.left_rad) &&
                     std::isfinite(entry.counted.right_rad);
  if (!entry.accepted || entry.epoch == kNoEpoch || entry.epoch == state.world.placed_in || !sound)
    return;
  EnterWorld(entry.epoch, Has(Defect::kPlaceForgotten) ? options_.start_world : pose);
  state.world.placed_in = entry.epoch;
  state.motion.reckoned = entry.tick;
  state.motion.counted = entry.counted;
  GoOn(Has(Defect::kRouteForgotten) ? TaskProgress{} : entry.task);
}

}  // namespace giveway
