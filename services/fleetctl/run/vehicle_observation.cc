#include "services/fleetctl/run/vehicle_observation.h"

#include <algorithm>

namespace giveway::fleetctl {
namespace {

Tick Before(Tick tick) { return Tick{Number(tick) - 1}; }

// The last element that is not after `tick`, and the next one; null if there is none.
template <typename T>
struct Around {
  const T* last = nullptr;
  const T* next = nullptr;
};

template <typename T>
Around<T> AroundOf(const std::deque<T>& list, Tick tick, Tick T::*when) {
  const auto after = std::ranges::upper_bound(list, tick, {}, when);
  return {after == list.begin() ? nullptr : &*(after - 1), after == list.end() ? nullptr : &*after};
}

// Removes all elements up to `tick` except the last of them.
template <typename T>
void DropBefore(std::deque<T>* list, Tick tick, Tick T::*when) {
  while (list->size() > 1 && (*list)[1].*when <= tick) list->pop_front();
}

}  // namespace

void VehicleObservation::Take(const Truth& truth) {
  if (truths_.empty() || truth.tick > truths_.back().tick) truths_.push_back(truth);
}

void VehicleObservation::Take(const Beacon& beacon, Tick now) {
  BeaconRecord received{beacon, beacon.tick, beacon.tick, false};
  if (!beacons_.empty()) {
    const BeaconRecord& last = beacons_.back();
    const bool same_life = last.beacon.boot_epoch == beacon.boot_epoch;
    if (same_life && beacon.seq <= last.beacon.seq) return;  // out of order, or twice
    received.follows = same_life && beacon.seq == last.beacon.seq + 1;
    if (received.answers <= last.answers) {
      received.at = std::max(now, last.at);
    } else {
      // What it published without a new scan, it published before this.
      for (auto it = beacons_.rbegin(); it != beacons_.rend() && it->at >= received.at; ++it) {
        it->at = Before(received.at);
      }
    }
  }
  beacons_.push_back(received);
}

void VehicleObservation::Take(const VehicleStatus& status) {
  if (decisions_.empty() || status.tick >= decisions_.back().tick) {
    decisions_.push_back({status.tick, status.decision});
  }
}

bool VehicleObservation::AddBody(Tick tick, sim::Observed* seen) const {
  const auto [truth, next] = AroundOf(truths_, tick, &Truth::tick);
  if (truth == nullptr) return true;  // it has not arrived yet
  if (truth->tick != tick) return !truth->present && (next == nullptr || !next->present);
  seen->present = truth->present;
  seen->arrived = truth->arrived;
  seen->position_world = truth->world_from_body.position_world;
  seen->heading_rad = truth->world_from_body.heading_rad;
  seen->forward_m_s = truth->forward_m_s;
  seen->rim_m_s = sim::RimSpeed(drive_, truth->wheels);
  return true;
}

// The scan its last command answers; the newest possible if the observer cannot know.
Tick VehicleObservation::Answered(const BeaconRecord& last, const BeaconRecord* next,
                                  Tick tick) const {
  if (next != nullptr && next->follows) return last.answers;
  return std::min(tick, lives_ ? tick : After(last.answers, kHeldTicks));
}

// Every change of decision has a status, so the newest one knows the peer; unless its rule differs
// from the beacon's, as when it was overtaken.
Decision VehicleObservation::DecisionOf(const Beacon& beacon) const {
  Decision decision{.mode = beacon.mode, .rule = beacon.rule};
  const StatedDecision* const status =
      AroundOf(decisions_, beacon.tick, &StatedDecision::tick).last;
  if (status != nullptr && status->decision.mode == beacon.mode &&
      status->decision.rule == beacon.rule) {
    decision.peer = status->decision.peer;
  }
  return decision;
}

bool VehicleObservation::AddDecision(Tick tick, sim::Observed* seen) const {
  const auto [last, next] = AroundOf(beacons_, tick, &BeaconRecord::at);
  if (last == nullptr) return true;  // nothing yet: it stands and publishes nothing
  const bool missed = next == nullptr || !next->follows;
  if (lives_ && missed && TicksBetween(last->at, tick) > kHeldTicks) return false;
  seen->answered = Answered(*last, next, tick);
  seen->decision = DecisionOf(last->beacon);
  seen->gives_way_to = last->beacon.gives_way_to;
  seen->order = last->beacon.order;
  seen->stated = last->beacon.tick;
  seen->stated_position_world = last->beacon.world_from_body.position_world;
  seen->stated_covariance = last->beacon.covariance;
  return true;
}

void VehicleObservation::ForgetBefore(Tick tick) {
  DropBefore(&truths_, tick, &Truth::tick);
  DropBefore(&beacons_, tick, &BeaconRecord::at);
  DropBefore(&decisions_, tick, &StatedDecision::tick);
}

void VehicleObservation::Forget() {
  truths_.clear();
  beacons_.clear();
  decisions_.clear();
}

void VehicleObservation::Return() {
  if (!IsTakenAway()) return;
  Forget();
  lives_ = true;
}

std::optional<sim::Observed> VehicleObservation::At(Tick tick) {
  sim::Observed seen{.vehicle = vehicle_, .lives = lives_};
  gone_ticks_ = !lives_ && (truths_.empty() || IsTakenAway()) ? gone_ticks_ + 1 : 0;
  const bool known = AddBody(tick, &seen) && (!seen.present || AddDecision(tick, &seen));
  // A beacon of this tick may answer an older scan, and is looked up in the statuses by that.
  constexpr std::uint32_t kKept = 64;
  if (Number(tick) > kKept) ForgetBefore(Tick{Number(tick) - kKept});
  return known ? std::optional(seen) : std::nullopt;
}

}  // namespace giveway::fleetctl
