#include "services/fleetctl/run/invariant_watch.h"

#include <algorithm>

#include "sim_world/virtual/virtual_run.h"

namespace giveway::fleetctl {
namespace {

// Samples of a world that ended may come late, but not after so many others.
constexpr std::size_t kPastEpochs = 16;

sim::InvariantLimits LimitsFromOutside(const Scenario& scenario) {
  sim::InvariantLimits limits = sim::LimitsFor(scenario, VehicleObservation::kHeldTicks, true);
  limits.stale_ticks = VehicleObservation::kHeldTicks;
  limits.arriving = scenario.expect.arrived;
  limits.counts_others = false;  // nor are they reported
  return limits;
}

}  // namespace

InvariantWatch::InvariantWatch(const Scenario& scenario)
    : scenario_(scenario), invariants_(scenario_, LimitsFromOutside(scenario_)) {
  for (const VehicleOptions& vehicle : scenario_.vehicles) {
    observations_.emplace(vehicle.id, VehicleObservation(vehicle));
  }
}

void InvariantWatch::Fold(const link::Observed& observed) {
  for (const RosterEntry& entry : observed.roster) Admit(entry);
  for (const Truth& truth : observed.truths) FoldTruth(truth);
  for (const WorldEvent& event : observed.events) FoldEvent(event);
  for (const ReceivedBeacon& received : observed.beacons) {
    const auto sight = observations_.find(received.beacon.vehicle);
    const bool sound = received.crc_valid && received.name_valid && sight != observations_.end();
    if (sound && IsOfThisWorld(received.beacon.world_epoch)) {
      sight->second.Take(received.beacon, newest_);
    }
  }
  for (const VehicleStatus& status : observed.statuses) {
    const auto sight = observations_.find(status.vehicle);
    if (sight != observations_.end() && IsOfThisWorld(status.epoch)) sight->second.Take(status);
  }
  if (Number(newest_) > kLagTicks) EvaluateUntil(Tick{Number(newest_) - kLagTicks});
}

// Only of an open fleet: the others are known from the start.
void InvariantWatch::Admit(const RosterEntry& entry) {
  if (!entry.accepted || entry.spawn == 0 || entry.spawn > scenario_.spawns.size()) return;
  const auto known = spawns_.find(entry.vehicle);
  if (known != spawns_.end() && known->second == entry.spawn) {
    observations_.at(entry.vehicle).Return();
    return;
  }
  VehicleOptions options = scenario_.spawns[entry.spawn - 1];
  options.id = entry.vehicle;
  invariants_.Admit(options);
  observations_.insert_or_assign(options.id, VehicleObservation(options));
  spawns_[entry.vehicle] = entry.spawn;
}

bool InvariantWatch::IsOfAPastWorld(WorldEpoch epoch) const {
  return std::ranges::find(past_epochs_, epoch) != past_epochs_.end();
}

// Which vehicles live is known from before: the world resumes with those.
void InvariantWatch::Follow(const Truth& first) {
  if (epoch_ != kNoEpoch) {
    EvaluateUntil(newest_);
    past_epochs_.push_back(epoch_);
    if (past_epochs_.size() > kPastEpochs) past_epochs_.pop_front();
    waits_at_s_ = first.time_s;
    invariants_.NoteRestart();
    for (auto& [vehicle, sight] : observations_) sight.Forget();
  }
  epoch_ = first.epoch;
  newest_ = next_ = last_ = kNoTick;
}

void InvariantWatch::FoldTruth(const Truth& truth) {
  if (!IsOfThisWorld(truth.epoch) && !IsOfAPastWorld(truth.epoch)) Follow(truth);
  if (!IsOfThisWorld(truth.epoch)) return;
  newest_ = std::max(newest_, truth.tick);
  if (next_ == kNoTick && truth.time_s > waits_at_s_ && truth.tick > judged_) {
    next_ = truth.tick;
    first_time_s_ = truth.time_s;
    first_ = truth.tick;
  }
  const auto sight = observations_.find(truth.vehicle);
  if (sight != observations_.end()) sight->second.Take(truth);
}

void InvariantWatch::FoldEvent(const WorldEvent& event) {
  if (!IsOfThisWorld(event.epoch)) return;
  if (event.kind == EventKind::kEnded) last_ = event.tick;
  // The scenario's judge counts contacts that the scenario expects.
  if (event.kind != EventKind::kContact || scenario_.expect.contacts == 0) {
    events_.push_back(event);
  }
}

void InvariantWatch::EvaluateUntil(Tick last) {
  if (last_ != kNoTick) last = std::min(last, last_);
  for (; next_ != kNoTick && next_ <= last; next_ = After(next_, 1)) {
    Evaluate(next_);
    judged_ = next_;
    ForgetGone();
  }
}

double InvariantWatch::TimeOf(Tick tick) const {
  return first_time_s_ + TicksBetween(first_, tick) * Seconds(scenario_.tick_period);
}

void InvariantWatch::Evaluate(Tick tick) {
  NoteComingsAndGoings(tick);
  if (!Observe(tick)) {
    ++ticks_unseen_;
    return;
  }
  ++ticks_judged_;
  invariants_.Observe(tick, TimeOf(tick), seen_, std::span(events_).first(noted_));
  events_.erase(events_.begin(), events_.begin() + static_cast<std::ptrdiff_t>(noted_));
  noted_ = 0;
}

void InvariantWatch::NoteComingsAndGoings(Tick tick) {
  for (; noted_ < events_.size() && events_[noted_].tick <= tick; ++noted_) {
    const WorldEvent& event = events_[noted_];
    const auto sight = observations_.find(event.vehicle);
    if (sight == observations_.end()) continue;
    const bool gone = event.kind == EventKind::kSilent || event.kind == EventKind::kLeft ||
                      event.kind == EventKind::kFaultDue;
    if (gone || event.kind == EventKind::kJoined) sight->second.SetLives(!gone);
  }
}

// In weeks thousands may come and go.
void InvariantWatch::ForgetGone() {
  std::erase_if(spawns_, [this](const auto& place) {
    if (!observations_.at(place.first).IsGone()) return false;
    observations_.erase(place.first);
    invariants_.Forget(place.first);
    return true;
  });
}

// False if something about one of them is not known.
bool InvariantWatch::Observe(Tick tick) {
  seen_.clear();
  bool whole = true;
  for (auto& [vehicle, sight] : observations_) {
    const std::optional<sim::Observed> seen = sight.At(tick);
    whole = whole && seen.has_value();
    if (seen) seen_.push_back(*seen);
  }
  return whole;
}

void InvariantWatch::Finish(bool came_to_its_end) {
  EvaluateUntil(newest_);
  // Truth is not repeated: if that of the last tick was lost, the last to arrive still drives.
  const bool saw_the_end = last_ == kNoTick || judged_ == last_;
  if (came_to_its_end && saw_the_end && ticks_judged_ > 0 && seen_.size() == observations_.size()) {
    invariants_.Finish(newest_, seen_);
  }
}

void InvariantWatch::AddTo(Report* report) const {
  report->ticks_judged = ticks_judged_;
  report->ticks_unseen = ticks_unseen_;
  if (ticks_judged_ == 0) return;
  std::string broken;
  for (std::size_t i = 0; i < sim::kInvariantCount; ++i) {
    if (!sim::RequiredInvariants().test(i)) continue;  // counted in virtual runs only
    const auto invariant = static_cast<sim::Invariant>(i);
    const std::uint32_t count = invariants_.Count(invariant);
    report->violations.push_back({std::string(sim::Name(invariant)), count});
    if (count > 0) broken += (broken.empty() ? "" : ", ") + std::string(sim::Name(invariant));
  }
  for (const sim::Violation& violation : invariants_.First()) {
    report->first_violations.push_back({std::string(sim::Name(violation.invariant)), violation.tick,
                                        violation.vehicle, violation.other});
  }
  if (broken.empty() || report->verdict != Verdict::kPassed) return;
  report->verdict = Verdict::kFailed;
  report->reason = "invariant_broken: " + broken;
}

}  // namespace giveway::fleetctl
