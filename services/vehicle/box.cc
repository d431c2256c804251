#include "services/vehicle/box.h"

#include <algorithm>
#include <array>

namespace giveway {
namespace {

constexpr double kRoomToStand_m = 0.7;  // between two conflicts: a body and what it keeps clear of
// Who is farther from where the ways cross is not kept waiting by one that stops there now.
constexpr double kPeerNear_m = 3;
constexpr double kOwnNear_m = 8;

struct Stretches {
  std::array<const Stretch*, 64> of;  // the first `count`
  std::size_t count = 0;
};

Stretches StretchesAhead(std::span<const PeerView> views) {
  Stretches stretches;
  for (const PeerView& view : views) {
    if (!view.crossing || stretches.count == stretches.of.size()) continue;
    const Conflict& crossing = *view.crossing;
    if (crossing.peer.begin_m > kPeerNear_m || crossing.own.begin_m > kOwnNear_m) continue;
    stretches.of[stretches.count++] = &crossing.own;
  }
  return stretches;
}

// Where the box begins that a point of the own way lies in: back over every stretch that leaves no
// room to stand before the next.
double BoxBegin(const Stretches& stretches, double point_m) {
  double begin_m = point_m;
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t i = 0; i < stretches.count; ++i) {
      const Stretch& stretch = *stretches.of[i];
      if (stretch.begin_m >= begin_m || stretch.end_m < begin_m - kRoomToStand_m) continue;
      begin_m = stretch.begin_m;
      moved = true;
    }
  }
  return begin_m;
}

}  // namespace

void FindBoxes(std::span<PeerView> views, const Situation& s) {
  const bool cooperative = s.options.behaviour == Behaviour::kCooperative;
  const Stretches stretches = cooperative ? StretchesAhead(views) : Stretches{};
  for (PeerView& view : views) {
    if (!view.conflict) continue;
    view.box_begin_m = BoxBegin(stretches, view.conflict->own.begin_m);
  }
}

}  // namespace giveway
