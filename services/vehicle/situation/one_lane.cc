#include "services/vehicle/situation/one_lane.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/vehicle/situation/claim.h"
#include "services/vehicle/situation/timing.h"

namespace giveway {
namespace {

// A disc that drives to a point.
struct MovingDisc {
  Path path;
  double path_m;  // to that point
  double body_radius_m;
  PoseCovariance covariance;
};

// The stretch of its path on which it is in the section.
Stretch Inside(const OneLane& lane, const MovingDisc& disc) {
  const Vec2 along = lane.to_world - lane.from_world;
  const double length_m = Norm(along);
  const double reach_m = lane.width_m / 2 + disc.body_radius_m + kOneLaneMargin_m +
                         kSigmas * SigmaPosition(disc.covariance);
  return StretchNearSegment(disc.path, {lane.from_world, (1 / length_m) * along}, length_m,
                            reach_m);
}

// True if a path of that length has its end, or any point before, in the section.
bool LeadsInto(const Stretch& inside, double path_m) {
  return inside.end_m > 0 && inside.begin_m <= path_m;
}

bool IsForward(const OneLane& lane, Vec2 direction_world) {
  return Dot(lane.to_world - lane.from_world, direction_world) > 0;
}

MovingDisc DiscOf(const CarriedPeer& view) {
  const Beacon& beacon = view.peer->beacon;
  const double path_m = Norm(view.path_world);
  const Vec2 direction_world =
      path_m > kAtTarget_m ? (1 / path_m) * view.path_world : view.forward_world;
  return {{view.position_world, direction_world}, path_m, beacon.body_radius_m, beacon.covariance};
}

void KeepNearest(const LaneAhead& found, LanesAhead* nearest) {
  if (nearest->count < nearest->of.size()) {
    nearest->of[nearest->count++] = found;
    return;
  }
  const auto begin = [](const LaneAhead& lane) { return lane.own.begin_m; };
  LaneAhead& farthest = *std::ranges::max_element(nearest->of, {}, begin);
  if (found.own.begin_m < farthest.own.begin_m) farthest = found;
}

}  // namespace

const OneLane* FindOneLane(Vec2 point_world, std::span<const OneLane> lanes) {
  const auto found = std::ranges::find_if(lanes, [&](const OneLane& lane) {
    const Vec2 along = lane.to_world - lane.from_world;
    const Vec2 offset = point_world - lane.from_world;
    const double share = std::clamp(Dot(offset, along) / SquaredNorm(along), 0.0, 1.0);
    return Norm(offset - share * along) <= lane.width_m / 2;
  });
  return found == lanes.end() ? nullptr : &*found;
}

LanesAhead FindLanesAhead(const OwnPose& pose, const OwnCourse& course,
                          const VehicleOptions& options) {
  LanesAhead nearest;
  if (course.arrived || pose.lost || options.behaviour != Behaviour::kCooperative) return nearest;
  const MovingDisc own = {course.path, course.distance_to_goal_m, options.profile.body_radius_m,
                          pose.covariance};
  for (const OneLane& lane : options.one_lanes) {
    const Stretch inside = Inside(lane, own);
    if (!LeadsInto(inside, own.path_m)) continue;
    KeepNearest({&lane, inside, IsForward(lane, own.path.direction_world)}, &nearest);
  }
  return nearest;
}

std::optional<Conflict> FindOneLaneConflict(const CarriedPeer& view, const OwnView& s) {
  if (s.lanes.count == 0) return std::nullopt;
  const MovingDisc peer = DiscOf(view);
  std::optional<Conflict> nearest;
  for (std::uint8_t i = 0; i < s.lanes.count; ++i) {
    const LaneAhead& ahead = s.lanes.of[i];
    if (IsForward(*ahead.lane, peer.path.direction_world) == ahead.forward) continue;
    if (nearest && nearest->own.begin_m <= ahead.own.begin_m) continue;
    const Stretch inside = Inside(*ahead.lane, peer);
    if (LeadsInto(inside, peer.path_m)) {
      nearest = Conflict{.own = ahead.own, .peer = inside, .one_lane = true, .lane = i};
    }
  }
  return nearest;
}

double SecondsOccupied(const Conflict& conflict, std::span<const PeerView> peers,
                       const OwnView& s) {
  const LaneAhead& ahead = s.lanes.of[conflict.lane];
  double occupied_s = 0;
  for (const PeerView& view : peers) {
    const MovingDisc peer = DiscOf(view);
    if (!view.fresh || IsForward(*ahead.lane, peer.path.direction_world) != ahead.forward) continue;
    const Stretch inside = Inside(*ahead.lane, peer);
    if (!LeadsInto(inside, 0)) continue;
    occupied_s = std::max(occupied_s, inside.end_m / FastestOf(view));
  }
  return occupied_s;
}

// What it drove moves its path by no more than that, and neither does a direction that says little.
bool MayMeetInOneLane(const Beacon& beacon, double moved_m, const OwnView& s) {
  if (s.lanes.count == 0) return false;
  const Vec2 from_world = beacon.world_from_body.position_world;
  const Vec2 path_world = beacon.toward_world - from_world;
  const double path_m = Norm(path_world);
  const double unsure_m = moved_m + 2 * kAtTarget_m;
  const Vec2 direction_world = path_m > 0 ? (1 / path_m) * path_world : Vec2{1, 0};
  const MovingDisc peer = {
      {from_world, direction_world}, path_m, beacon.body_radius_m + unsure_m, beacon.covariance};
  return std::ranges::any_of(s.lanes.All(), [&](const LaneAhead& ahead) {
    return LeadsInto(Inside(*ahead.lane, peer), path_m + unsure_m);
  });
}

}  // namespace giveway
