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
  state_->order = {.speed_bucket = SpeedBucket(options.cruise_m_s), .vehicle = options.id};
  state_->placed_in = kNoEpoch;
}

// What was seen, heard and waited for belongs to the world before.
void Vehicle::EnterWorld(WorldEpoch epoch, const Pose& world_from_body) {
  VehicleState& state = *state_;
  state.epoch = epoch;
  state.tick = kNoTick;
  state.run_state = RunState::kWaiting;
  state.odometry = Odometry(world_from_body);
  Begin(options_.profile, &state.pose);
  state.reckoned = kNoTick;
  state.wheels = {};
  state.waypoint = 0;
  state.nearest_m = kNoGoal_m;
  state.aimless_ticks = 0;
  state.detour_tick = kNoTick;
  state.away_tick = kNoTick;
  state.caught_ticks = 0;
  state.blocked_tick = kNoTick;
  state.turned_tick = kNoTick;
  state.decided_tick = kNoTick;
  state.arrived = false;
  state.order.waited_ticks = 0;
  state.waited_ticks = 0;
  state.let_pass = false;
  state.deaf = false;
  state.ranges = {};
  state.grid = {};
  state.signals.LeaveWorld();
  state.objects = {};
  state.last_heard = {};
  state.peers.LeaveWorld();
}

// With the task that was begun. What it waited it waited here. The order by it is its own again.
void Vehicle::GoOn(TaskProgress task) {
  VehicleState& state = *state_;
  state.waypoint = OnRoute(options_.route, task).waypoint;
  state.waited_ticks = task.waited_ticks <= Number(state.reckoned) ? task.waited_ticks : 0;
  state.waited_world = state.odometry.WorldFromBody().position_world;
  state.order.waited_ticks = AgedTicks();
}

std::optional<Handover> Vehicle::HandOver() const {
  const VehicleState& state = *state_;
  if (state.epoch == kNoEpoch || state.reckoned == kNoTick) return std::nullopt;
  return Handover{.epoch = state.epoch,
                  .tick = state.reckoned,
                  .counted = state.counted,
                  .world_from_body = state.odometry.WorldFromBody(),
                  .covariance = PromisedCovariance(state.odometry, state.pose),
                  .task = {state.waypoint, state.waited_ticks}};
}

bool Vehicle::TakeOver(const Handover& handover) {
  if (!IsSound(handover)) return false;
  VehicleState& state = *state_;
  EnterWorld(handover.epoch, handover.world_from_body);
  state.placed_in = handover.epoch;
  state.odometry = Odometry(handover.world_from_body, handover.covariance);
  state.reckoned = handover.tick;
  state.counted = handover.counted;
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
  if (!entry.accepted || entry.epoch == kNoEpoch || entry.epoch == state.placed_in || !sound)
    return;
  EnterWorld(entry.epoch, Has(Defect::kPlaceForgotten) ? options_.start_world : pose);
  state.placed_in = entry.epoch;
  state.reckoned = entry.tick;
  state.counted = entry.counted;
  GoOn(Has(Defect::kRouteForgotten) ? TaskProgress{} : entry.task);
}

}  // namespace giveway
