#include "services/vehicle/situation/box.h"

#include <algorithm>
#include <array>

#include "services/vehicle/estimation/conflict.h"

namespace giveway {
namespace {

constexpr double kRoomToStand_m = 0.7;  // between two conflicts: a body and what it keeps clear of
// A peer further from the crossing than this is not made to wait by a vehicle stopping there now.
constexpr double kPeerNear_m = 3;
constexpr double kOwnNear_m = 8;

// The conflicts of a vehicle that concern it now.
struct Crossings {
  std::array<const PeerView*, 64> of;  // the first `count`
  std::size_t count = 0;
  // No stretch of the own path starts before the one or ends after the other.
  double first_begin_m = kFar_m;
  double last_end_m = -kFar_m;

  std::span<const PeerView* const> All() const { return {of.data(), count}; }
};

Crossings CrossingsAhead(std::span<const PeerView> views) {
  Crossings crossings;
  for (const PeerView& view : views) {
    if (!view.crossing || crossings.count == crossings.of.size()) continue;
    const Conflict& crossing = *view.crossing;
    if (crossing.peer.begin_m > kPeerNear_m || crossing.own.begin_m > kOwnNear_m) continue;
    crossings.of[crossings.count++] = &view;
    crossings.first_begin_m = std::min(crossings.first_begin_m, crossing.own.begin_m);
    crossings.last_end_m = std::max(crossings.last_end_m, crossing.own.end_m);
  }
  return crossings;
}

// Where the box starts that contains a point of the own path: back over every stretch that leaves
// too little space to stand before the next.
double BoxBegin(const Crossings& crossings, double point_m) {
  const bool alone =
      point_m <= crossings.first_begin_m || point_m - kRoomToStand_m > crossings.last_end_m;
  if (alone) return point_m;
  double begin_m = point_m;
  for (bool moved = true; moved;) {
    moved = false;
    for (const PeerView* view : crossings.All()) {
      const Stretch& stretch = view->crossing->own;
      if (stretch.begin_m >= begin_m || stretch.end_m < begin_m - kRoomToStand_m) continue;
      begin_m = stretch.begin_m;
      moved = true;
    }
  }
  return begin_m;
}

double AlongOwnPath(const CarriedPeer& view, const OwnView& s) {
  return Dot(view.offset_world, s.path.direction_world);
}

// Length of own lane needed by this vehicle and all vehicles queued up to the place `along_m`, one
// behind the other.
double QueueLength(double along_m, std::span<const PeerView> views, const OwnView& s) {
  constexpr double kMoreThanClear_m = 0.01;  // so that rounding does not call it blocked again
  double length_m = 0;
  for (const PeerView& view : views) {
    if (!view.leads || AlongOwnPath(view, s) > along_m) continue;
    length_m += s.options.profile.body_radius_m + view.peer->beacon.body_radius_m + kClearance_m +
                kMoreThanClear_m;
  }
  return length_m;
}

// Where a leader that intends to drive on may nevertheless stop: before the next crossing.
double NextStop(double from_m, const Crossings& crossings) {
  double next_m = kFar_m;
  for (const PeerView* view : crossings.All()) {
    const double begin_m = view->crossing->own.begin_m;
    if (!view->crossing->across || begin_m <= from_m) continue;
    next_m = std::min(next_m, begin_m);
  }
  return next_m;
}

// How far along the own path the leader gets if it has to stop.
double LeaderStops(const RelatedPeer& leader, const Crossings& crossings, const OwnView& s) {
  const double along_m = AlongOwnPath(leader, s);
  if (leader.standing) return along_m;
  const double stops_m = along_m + StoppingDistanceOf(leader, s);
  const Beacon& beacon = leader.peer->beacon;
  const bool goes_on = beacon.gives_way_to == kNoVehicle && !IsGiveWay(beacon.rule);
  return goes_on ? NextStop(stops_m, crossings) : stops_m;
}

// How far this vehicle gets if the peer stays or stops on its path; huge if the peer does not block
// it. Up to a claim it is measured along the heading, which is the path unless the vehicle steers
// round something.
double StopsBehind(const RelatedPeer& view, std::span<const PeerView> views,
                   const Crossings& crossings, const OwnView& s) {
  if (!view.fresh) return kFar_m;
  if (!view.leads) return view.standing ? view.free_m : kFar_m;
  return LeaderStops(view, crossings, s) - QueueLength(AlongOwnPath(view, s), views, s);
}

// Where the box starts that contains a point; huge if none does, or if the vehicle is already
// inside. Parallel or opposing paths are no crossings.
double BoxRound(double point_m, const PeerView& but, const Crossings& crossings) {
  double begin_m = kFar_m;
  for (const PeerView* view : crossings.All()) {
    const Conflict& crossing = *view->crossing;
    if (view == &but || !crossing.across || view->box_begin_m <= 0) continue;
    if (crossing.own.begin_m < point_m && point_m < crossing.own.end_m) {
      begin_m = std::min(begin_m, view->box_begin_m);
    }
  }
  return begin_m;
}

std::optional<BlockedBox> NearestBlocked(std::span<const PeerView> views,
                                         const Crossings& crossings, const OwnView& s) {
  if (crossings.count == 0) return std::nullopt;
  std::optional<BlockedBox> nearest;
  for (const PeerView& view : views) {
    const double stops_m = StopsBehind(view, views, crossings, s);
    if (stops_m > kOwnNear_m) continue;
    const double begin_m = BoxRound(stops_m, view, crossings);
    if (begin_m >= (nearest ? nearest->begin_m : kFar_m)) continue;
    nearest = {begin_m, view.peer->id, view.peer->beacon.tick};
  }
  return nearest;
}

}  // namespace

Boxes FindBoxes(PeerViews<RelatedPeer> related, const OwnView& s) {
  const std::span<PeerView> views = related.ToMakeTheNextPart();
  const bool cooperative = s.options.behaviour == Behaviour::kCooperative;
  const Crossings crossings = cooperative ? CrossingsAhead(views) : Crossings{};
  for (PeerView& view : views) {
    view.box_begin_m = view.crossing ? BoxBegin(crossings, view.crossing->own.begin_m) : 0;
  }
  return {views, NearestBlocked(views, crossings, s)};
}

}  // namespace giveway
