#include "services/vehicle/own_path.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>

#include "services/types/time.h"
#include "services/vehicle/decision/detour.h"
#include "services/vehicle/estimation/injected_mutants.h"
#include "services/vehicle/situation/blocked.h"
#include "services/vehicle/situation/heard_places.h"
#include "services/vehicle/situation/one_lane.h"

namespace giveway {
namespace {

// So near it passes a waypoint that it cannot reach; and no nearer it must come to one in a
// one-lane section.
constexpr double kPassedAtDistance_m = 1.2;
constexpr double kLeastPassingRadius_m = 0.1;
// After kNoProgress_s of driving without progress, a vehicle plans a detour; after
// kProgressTimeout_s it does not stay in line any more.
constexpr double kNoProgress_s = 6;
constexpr double kProgressTimeout_s = 15;
constexpr double kProgress_m = 0.1;
// In a queue, behind a vehicle that makes no progress either, patience lasts this many times
// longer.
constexpr double kQueued_m = 1;
constexpr std::uint32_t kQueuePatience = 8;
constexpr Nanoseconds kDetourEvery = std::chrono::milliseconds(500);  // it is planned again
constexpr Nanoseconds kAway = std::chrono::seconds(3);  // it drives from what stopped it so long
constexpr Nanoseconds kStuckAgain =
    std::chrono::seconds(10);  // and may be stopped again, along a wall, for so long
// Moved no further than this, for so long, it is stuck.
constexpr double kStuckWithin_m = 0.1;
constexpr Nanoseconds kStuckAfter = std::chrono::seconds(10);

// How near it must come to a waypoint in a one-lane section, to turn into it with all of its
// body inside.
double PassingRadius(const OneLane& lane, const VehicleOptions& options) {
  const double beside_m = lane.width_m / 2 - options.profile.body_radius_m;
  return std::min(options.route.radius_m, std::max(beside_m, kLeastPassingRadius_m));
}

// A waypoint that is occupied is passed at a distance, once it cannot be reached. Not one in a
// one-lane section, nor from within one, which has no path around it.
bool PassesWaypoint(std::uint32_t waypoint, const VehicleOptions& options, bool detours,
                    Vec2 position_world) {
  if (waypoint >= options.route.count) return false;
  const Vec2 at_world = options.route.waypoints_world[waypoint];
  const double away_m = Norm(at_world - position_world);
  const OneLane* lane = FindOneLane(at_world, options.one_lanes);
  if (lane != nullptr) return away_m <= PassingRadius(*lane, options);
  if (away_m <= options.route.radius_m) return true;
  return detours && away_m <= kPassedAtDistance_m &&
         FindOneLane(position_world, options.one_lanes) == nullptr;
}

void Restart(GoalProgress* progress) {
  progress->nearest_m = kFar_m;
  progress->no_progress_ticks = 0;
}

void PassWaypoints(const VehicleOptions& options, Vec2 position_world, RouteProgress* route,
                   GoalProgress* progress) {
  const Route& of = options.route;
  const bool detours = progress->detour_tick != kNoTick;
  for (std::uint32_t i = 0; i < of.count; ++i) {
    if (!PassesWaypoint(route->waypoint, options, detours, position_world)) return;
    ++route->waypoint;
    if (of.loop && route->waypoint == of.count) route->waypoint = 0;
    Restart(progress);
  }
}

void NoteArrival(const OwnCourse& course, const OwnPose& pose, const VehicleOptions& options,
                 RouteProgress* route, GoalProgress* progress) {
  // Well inside the radius, so that the truth is inside too.
  if (course.stops_there && course.distance_to_goal_m <= options.goal.radius_m / 2) {
    route->arrived = true;
  }
  // It may have rolled on out of it, and a fix may say that it was not there.
  const double surely_m = course.distance_to_goal_m - SigmaPosition(pose.covariance);
  if (!route->arrived || surely_m <= options.goal.radius_m) return;
  route->arrived = false;
  Restart(progress);
}

// The waypoint of that number, or the goal behind the last; empty behind that.
std::optional<Vec2> PointOfRoute(std::uint32_t number, const VehicleOptions& options) {
  const Route& route = options.route;
  if (number < route.count) return route.waypoints_world[number];
  if (route.loop && route.count > 0) return route.waypoints_world[number % route.count];
  if (number == route.count && options.goal.set) return options.goal.at_world;
  return std::nullopt;
}

}  // namespace

OwnCourse UpdatePath(const OwnPose& pose, const VehicleOptions& options, RouteProgress* route,
                     GoalProgress* progress) {
  const Vec2 position = pose.world_from_body.position_world;
  PassWaypoints(options, position, route, progress);
  OwnCourse course{.path = {position, pose.forward_world}, .distance_to_goal_m = kFar_m};
  const bool on_route = route->waypoint < options.route.count;
  if (on_route || options.goal.set) {
    const Vec2 to =
        on_route ? options.route.waypoints_world[route->waypoint] : options.goal.at_world;
    const Vec2 displacement = to - position;
    course.distance_to_goal_m = Norm(displacement);
    course.stops_there = !on_route;
    if (course.distance_to_goal_m > 0) {
      course.path.direction_world = (1 / course.distance_to_goal_m) * displacement;
    }
    NoteArrival(course, pose, options, route, progress);
  }
  course.path_rad = route->bearing.Of(course.path.direction_world);
  course.arrived = route->arrived;
  course.lanes = FindLanesAhead(pose, course, options);
  return course;
}

LegsBeyond FindLegsBeyond(const OwnCourse& course, std::uint32_t waypoint,
                          const VehicleOptions& options, double reach_m) {
  LegsBeyond legs;
  if (waypoint >= options.route.count) return legs;
  Vec2 at = options.route.waypoints_world[waypoint];
  Vec2 direction_world = course.path.direction_world;
  double from_m = course.distance_to_goal_m;
  const double end_m = from_m + reach_m;
  while (legs.count < legs.of.size() && from_m < end_m) {
    const std::optional<Vec2> next = PointOfRoute(++waypoint, options);
    if (!next || *next == at) break;
    const double length_m = Norm(*next - at);
    const Path path{at, (1 / length_m) * (*next - at)};
    if (Dot(path.direction_world, direction_world) < kCosSameWay) break;
    legs.of[legs.count++] = {path, from_m, std::min(length_m, end_m - from_m)};
    at = *next;
    direction_world = path.direction_world;
    from_m += length_m;
  }
  return legs;
}

namespace {

// Neither waiting for a peer nor in a queue, it makes no progress: stuck between a few that block
// each other, or in front of something that it hears and cannot locate. A queue that closes to a
// ring does not count as one. Returns `escape_attempts` of Escape.
int NoteStuck(const OwnView& s, bool no_progress, bool in_line, GoalProgress* progress) {
  const Vec2 moved = s.world_from_body.position_world - progress->stuck_world;
  if (!no_progress || SquaredNorm(moved) > kStuckWithin_m * kStuckWithin_m) {
    progress->stuck_world = s.world_from_body.position_world;
    progress->stuck_ticks = 0;
    return -1;
  }
  if (in_line) return -1;
  progress->stuck_ticks += s.new_tick ? 1 : 0;
  const std::uint32_t after = TicksCovering(kStuckAfter, s.options.tick_period);
  if (progress->stuck_ticks < after) return -1;
  return static_cast<int>((progress->stuck_ticks - after) /
                          TicksCovering(kAway, s.options.tick_period));
}

// Where the path past all standing bodies leads first.
std::optional<Vec2> PathAround(const OwnView& s, std::span<const PeerView> peers) {
  std::array<KeepOut, 64> discs;
  std::size_t count = 0;
  for (const PeerView& view : peers) {
    const double room_m = RoomBeside(view, s);
    if (count == discs.size() || !view.standing) continue;
    discs[count++] = {view.position_world, room_m};
  }
  return FirstTurn(s.world_from_body.position_world, Toward(s), {discs.data(), count});
}

// Whether the last decision was to wait for what will let it drive: a peer, a light, the operator,
// its own sensors. Something that moves and has no beacon may be there for ever.
bool MakesItWait(Rule rule) {
  switch (rule) {
    case Rule::kGiveWay:
    case Rule::kNotGranted:
    case Rule::kPeerLost:
    case Rule::kSignal:
    case Rule::kNotRunning:
    case Rule::kLeaving:
    case Rule::kRangesStale:
      return true;
    default:
      return false;
  }
}

}  // namespace

Escape Detour(const OwnView& s, const PeersNow& near, const LastStep& last, GoalProgress* of) {
  GoalProgress& progress = *of;
  Escape escape;
  if (s.distance_to_goal_m < progress.nearest_m - kProgress_m) {
    progress.nearest_m = s.distance_to_goal_m;
    progress.no_progress_ticks = 0;
    progress.detour_tick = kNoTick;
  }
  if (MakesItWait(last.decision.rule) || s.lost) return escape;
  const auto ticks = [&s](Nanoseconds time) { return TicksCovering(time, s.options.tick_period); };
  const bool queues = progress.stuck_ticks < ticks(kStuckAfter) &&
                      std::ranges::any_of(near.peers, [](const PeerView& view) {
                        return view.leads && view.gap_m < kQueued_m;
                      });
  // Nor does it look about there more often, or it would end up across the lane.
  if (queues && Number(s.tick) % kQueuePatience != 0) return escape;
  progress.no_progress_ticks += s.new_tick ? 1 : 0;
  if (s.distance_to_goal_m >= kFar_m || s.arrived) return escape;
  if (MutantActive(Mutant::kPatienceDropped)) progress.no_progress_ticks += 1000;
  const std::uint32_t away_ticks = progress.away_tick == kNoTick
                                       ? ticks(kStuckAgain) + 1
                                       : TicksBetween(progress.away_tick, s.tick);
  const double no_progress_s = Seconds(progress.no_progress_ticks * s.options.tick_period);
  const bool no_progress = no_progress_s >= kNoProgress_s || away_ticks <= ticks(kStuckAgain);
  escape.no_progress = no_progress;
  escape.long_no_progress = no_progress_s >= kProgressTimeout_s;
  const bool in_line = queues && !IsBehind(last.blocked_by, s.options.id, near.peers);
  escape.escape_attempts = NoteStuck(s, no_progress, in_line, &progress);
  if (!no_progress) return escape;
  if (away_ticks <= ticks(kAway)) escape.away_rad = progress.away_rad;
  if (progress.detour_tick == kNoTick ||
      TicksBetween(progress.detour_tick, s.tick) >= ticks(kDetourEvery)) {
    const std::optional<Vec2> turn = PathAround(s, near.peers);
    progress.detour_tick = turn ? s.tick : kNoTick;
    if (turn) progress.detour_world = *turn;
  }
  if (progress.detour_tick != kNoTick) escape.detour_world = progress.detour_world;
  return escape;
}

}  // namespace giveway
