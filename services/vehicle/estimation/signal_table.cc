#include "services/vehicle/estimation/signal_table.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/vehicle/estimation/scan_check.h"

namespace giveway {
namespace {

constexpr double kLineMargin_m = 0.15;  // left between shell and line

bool IsFresh(SteadyTime heard, SteadyTime now) { return now - heard <= kSignalAgeLimit; }

// Metres along the path until it crosses the stop line, negative behind its start; empty if it does
// not cross it, or in the opposite direction.
std::optional<double> CrossingOf(const SignalState& state, const Path& path) {
  const Vec2 along = path.direction_world;
  const Vec2 travel = {Cos(state.travel_rad), Sin(state.travel_rad)};
  if (Dot(along, travel) < kCosSameWay) return std::nullopt;
  const Vec2 line = state.line_to_world - state.line_from_world;
  const Vec2 offset = state.line_from_world - path.from_world;
  const double slope = Cross(along, line);
  if (slope < 1e-9 && slope > -1e-9) return std::nullopt;
  const double on_line = Cross(offset, along) / slope;  // 0 at one end of the line, 1 at the other
  if (on_line < 0 || on_line > 1) return std::nullopt;
  return Cross(offset, line) / slope;
}

// Metres along the path until the shell is over the stop line; empty if that is not ahead, or the
// shell is over it already.
std::optional<double> DistanceToLine(const SignalState& state, const Approach& approach) {
  if (const auto crossing = CrossingOf(state, approach.path)) {
    const double distance = *crossing - approach.body_radius_m;
    if (distance >= 0 && distance <= approach.distance_to_goal_m) return distance;
  }
  for (const Leg& leg : approach.beyond) {
    const auto crossing = CrossingOf(state, leg.path);
    if (!crossing || *crossing < 0 || *crossing > leg.length_m) continue;
    const double distance = leg.from_m + *crossing - approach.body_radius_m;
    if (distance >= 0) return distance;
  }
  return std::nullopt;
}

double SquaredDistanceToLine(const SignalState& state, Vec2 point_world) {
  const Vec2 line = state.line_to_world - state.line_from_world;
  const Vec2 to = point_world - state.line_from_world;
  const double length_m2 = SquaredNorm(line);
  const double along = length_m2 > 0 ? std::clamp(Dot(to, line) / length_m2, 0.0, 1.0) : 0;
  return SquaredNorm(to - along * line);
}

}  // namespace

SignalTable::Head* SignalTable::Find(SignalId id) {
  for (Head& head : Heads()) {
    if (head.state.id == id) return &head;
  }
  return nullptr;
}

// Of a head that is not in the table yet. A scenario may have more heads than the table, each heard
// wherever the vehicle is: only those about it matter.
SignalTable::Head* SignalTable::PlaceFor(const SignalState& state, SteadyTime now, Vec2 own_world) {
  if (count_ < kMaxSignals) return &heads_[count_++];
  Head* farthest = nullptr;
  double most_m2 = SquaredDistanceToLine(state, own_world);
  for (Head& head : Heads()) {
    if (!IsFresh(head.heard, now)) return &head;
    const double away_m2 = SquaredDistanceToLine(head.state, own_world);
    if (away_m2 <= most_m2) continue;
    most_m2 = away_m2;
    farthest = &head;
  }
  return farthest;
}

bool SignalTable::Take(const SignalState& state, WorldEpoch epoch, SteadyTime now, Vec2 own_world) {
  if (state.epoch != epoch || !IsBelievable(state)) return false;
  Head* head = Find(state.id);
  if (head == nullptr) {
    head = PlaceFor(state, now, own_world);
    if (head == nullptr) return false;
    *head = {};
  }
  // A state far older than the last is of a head that restarted its count, not a late one.
  if (state.tick <= head->state.tick && IsFresh(head->heard, now)) return false;
  if (state.phase != SignalPhase::kYellow) head->weighed = head->clears = false;
  head->state = state;
  head->heard = now;
  return true;
}

std::optional<StopLine> SignalTable::MustStopAt(const Approach& approach, SteadyTime now) {
  std::optional<StopLine> nearest;
  for (Head& head : Heads()) {
    if (!IsFresh(head.heard, now)) {
      head.weighed = head.clears = false;
      continue;
    }
    const SignalPhase phase = head.state.phase;
    if (phase != SignalPhase::kRed && phase != SignalPhase::kYellow) continue;
    const auto distance = DistanceToLine(head.state, approach);
    if (!distance) continue;
    if (phase == SignalPhase::kYellow && !head.weighed) {
      head.weighed = true;
      head.clears = *distance < approach.stopping_m;
    }
    if (head.clears) continue;
    const double free_m = *distance - kLineMargin_m;
    if (!nearest || free_m < nearest->free_m) nearest = {free_m, head.state.id, head.state.tick};
  }
  return nearest;
}

void SignalTable::AddTo(StateHash* hash) const {
  for (std::size_t i = 0; i < count_; ++i) {
    const Head& head = heads_[i];
    hash->Add(head.state.id);
    hash->Add(head.state.tick);
    hash->Add(head.state.phase);
    hash->Add(head.heard.count());
    hash->Add(head.weighed);
    hash->Add(head.clears);
  }
}

}  // namespace giveway
