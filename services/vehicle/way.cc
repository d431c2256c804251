// Which way a vehicle is on: along its route, to its goal, or round a crowd.
#include <algorithm>
#include <array>

#include "services/vehicle/decision/detour.h"
#include "services/vehicle/estimation/planted.h"
#include "services/vehicle/situation/blocked.h"
#include "services/vehicle/situation/heard_places.h"
#include "services/vehicle/vehicle.h"

namespace giveway {
namespace {

// Driving about for so long without coming nearer, a vehicle looks for a way round.
constexpr double kPassedAtDistance_m = 1.2;
constexpr double kNoProgress_s = 6;
constexpr double kNoPatience_s = 15;
constexpr double kProgress_m = 0.1;
// In a queue, behind one that comes no further either, patience lasts so many times as long.
constexpr double kQueued_m = 1;
constexpr std::uint32_t kQueuePatience = 8;
constexpr std::uint32_t kDetourTicks = 10;  // a detour is looked for anew after so many
constexpr std::uint32_t kAwayTicks = 60;    // it drives away from what stopped it for so many
constexpr std::uint32_t kStuckTicks = 200;  // and may be stopped again, along a wall, for so many
// No farther than this from where it was, for so many ticks, it is caught.
constexpr double kCaughtWithin_m = 0.1;
constexpr std::uint32_t kCaughtTicks = 200;

// A waypoint that somebody stands on is passed at a distance, once it cannot be reached.
bool PassesWaypoint(const VehicleState& state, const Route& route, Vec2 position_world) {
  if (state.route.waypoint >= route.count) return false;
  const double away_m = Norm(route.waypoints_world[state.route.waypoint] - position_world);
  return away_m <= route.radius_m ||
         (state.progress.detour_tick != kNoTick && away_m <= kPassedAtDistance_m);
}

}  // namespace

// The straight way to the next waypoint or the goal; straight on without either.
void Vehicle::LookAhead(Situation* s) {
  VehicleState& state = *state_;
  const Route& route = options_.route;
  const Vec2 position = s->world_from_body.position_world;
  s->path = {position, s->forward_world};
  s->distance_to_goal_m = kNoGoal_m;
  for (std::uint32_t i = 0; i < route.count && PassesWaypoint(state, route, position); ++i) {
    ++state.route.waypoint;
    if (route.loop && state.route.waypoint == route.count) state.route.waypoint = 0;
    state.progress.nearest_m = kNoGoal_m;
    state.progress.aimless_ticks = 0;
  }
  const bool on_route = state.route.waypoint < route.count;
  if (!on_route && !options_.goal.set) return;
  const Vec2 way =
      (on_route ? route.waypoints_world[state.route.waypoint] : options_.goal.at_world) - position;
  s->distance_to_goal_m = Norm(way);
  s->stops_there = !on_route;
  if (s->distance_to_goal_m > 0) s->path.direction_world = (1 / s->distance_to_goal_m) * way;
  // Well inside the radius, so that the truth is inside too.
  if (!on_route && s->distance_to_goal_m <= options_.goal.radius_m / 2) state.route.arrived = true;
  // A fix may say that it was not there.
  const bool shown = options_.profile.pose_fix.Fitted();
  const double surely_m = s->distance_to_goal_m - SigmaPosition(s->covariance);
  if (!state.route.arrived || !shown || surely_m <= options_.goal.radius_m) return;
  state.route.arrived = false;
  state.progress.nearest_m = kNoGoal_m;
  state.progress.aimless_ticks = 0;
}

// Neither waiting for anybody nor in a queue, it gets no farther: caught between a few that stand
// in each other's way, or before something that it hears and cannot place. A queue that closes to a
// circle is none.
void Vehicle::NoteCaught(Situation* s, bool queues) {
  VehicleState& state = *state_;
  const Vec2 moved = s->world_from_body.position_world - state.progress.caught_world;
  if (!s->aimless || SquaredNorm(moved) > kCaughtWithin_m * kCaughtWithin_m) {
    state.progress.caught_world = s->world_from_body.position_world;
    state.progress.caught_ticks = 0;
    return;
  }
  if (queues && !IsBehind(state.last.blocked_by, options_.id, s->peers)) return;
  state.progress.caught_ticks += s->new_tick ? 1 : 0;
  if (state.progress.caught_ticks < kCaughtTicks) return;
  s->tries = static_cast<int>((state.progress.caught_ticks - kCaughtTicks) / kAwayTicks);
}

// Where steering round what stands leads nowhere, the way is looked up on a map of it.
void Vehicle::Detour(Situation* s) {
  VehicleState& state = *state_;
  if (s->distance_to_goal_m < state.progress.nearest_m - kProgress_m) {
    state.progress.nearest_m = s->distance_to_goal_m;
    state.progress.aimless_ticks = 0;
    state.progress.detour_tick = kNoTick;
  }
  if (IsGiveWay(state.last.decision.rule) || state.last.decision.rule == Rule::kSignal || s->lost)
    return;
  // Nor does it look for a way while it hears nothing. Where ultrasonics are exact this counts on:
  // what was recorded of them replays bit for bit.
  if (state.last.decision.rule == Rule::kRangesStale && Remembers(options_)) return;
  const bool queues = state.progress.caught_ticks < kCaughtTicks &&
                      std::ranges::any_of(s->peers, [](const PeerView& view) {
                        return view.leads && view.gap_m < kQueued_m;
                      });
  // Nor does it look about there more often, or it would end up across the lane.
  if (queues && Number(s->tick) % kQueuePatience != 0) return;
  state.progress.aimless_ticks += s->new_tick ? 1 : 0;
  if (s->distance_to_goal_m >= kNoGoal_m || state.route.arrived) return;
  if (Has(Defect::kPatienceDropped)) state.progress.aimless_ticks += 1000;
  const std::uint32_t away_ticks = state.progress.away_tick == kNoTick
                                       ? kStuckTicks + 1
                                       : TicksBetween(state.progress.away_tick, s->tick);
  s->aimless = Seconds(state.progress.aimless_ticks * options_.tick_period) >= kNoProgress_s ||
               away_ticks <= kStuckTicks;
  s->very_aimless = Seconds(state.progress.aimless_ticks * options_.tick_period) >= kNoPatience_s;
  NoteCaught(s, queues);
  if (!s->aimless) return;
  if (away_ticks <= kAwayTicks) s->away_rad = state.progress.away_rad;
  if (state.progress.detour_tick == kNoTick ||
      TicksBetween(state.progress.detour_tick, s->tick) >= kDetourTicks) {
    std::array<KeepOut, 64> discs;
    std::size_t count = 0;
    for (const PeerView& view : s->peers) {
      const double room_m = RoomBeside(view, *s);
      if (count == discs.size() || !view.standing) continue;
      discs[count++] = {view.position_world, room_m};
    }
    const auto turn =
        FirstTurn(s->world_from_body.position_world, Toward(*s), {discs.data(), count});
    state.progress.detour_tick = turn ? s->tick : kNoTick;
    if (turn) state.progress.detour_world = *turn;
  }
  if (state.progress.detour_tick != kNoTick) s->detour_world = state.progress.detour_world;
}

}  // namespace giveway
