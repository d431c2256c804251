#include "sim_world/virtual/invariants.h"

#include <algorithm>

#include "services/types/check.h"
#include "services/types/math/math.h"
#include "sim_world/geometry/ticks.h"

namespace giveway::sim {
namespace {

constexpr std::uint32_t kUnknown = 0xffffffff;
// How far a vehicle may be from where it says: what it says of its own doubt, and a little.
constexpr double kPoseSigmas = 3;
constexpr double kPoseSlack_m = 0.1;

bool Stands(const Observed& vehicle) { return Magnitude(vehicle.forward_m_s) < kStandstill_m_s; }

// Halts to give way, by its own word and by the truth.
bool Waits(const Observed& vehicle) {
  return vehicle.present && vehicle.lives && !vehicle.arrived && Stands(vehicle) &&
         IsGiveWay(vehicle.decision.rule);
}

}  // namespace

std::string_view Name(Invariant invariant) {
  constexpr std::array<std::string_view, kInvariantCount> kNames = {
      "contact", "stale_motion", "wait_cycle", "wait_bound", "all_halted",
      "order",   "arrival",      "pose",       "red_light",  "progress"};
  return kNames[static_cast<std::size_t>(invariant)];
}

Invariants::Invariants(const Scenario& scenario, const InvariantLimits& limits)
    : limits_(limits),
      open_(!scenario.spawns.empty()),
      dt_s_(Seconds(scenario.tick_period)),
      wait_ticks_(TicksCovering(FromSeconds(limits.wait_s), scenario.tick_period)),
      watchdog_ticks_(scenario.watchdog_ticks),
      red_lights_(scenario),
      progress_(scenario, limits.wedge_s) {
  GIVEWAY_CHECK(limits.key_age_ticks < kRememberedKeys, limits.key_age_ticks);
  for (const VehicleOptions& options : scenario.vehicles) tracks_.push_back(TrackOf(options));
  first_.reserve(kKeptViolations);
}

Invariants::Track Invariants::TrackOf(const VehicleOptions& options) {
  return {.vehicle = options.id,
          .deceleration_m_s2 = options.profile.deceleration_m_s2,
          .acceleration_m_s2 = options.profile.acceleration_m_s2,
          .has_goal = HasGoal(options),
          .last_position_world = options.start_world.position_world};
}

void Invariants::Admit(const VehicleOptions& options) {
  const auto place = std::ranges::lower_bound(tracks_, options.id, {}, &Track::vehicle);
  if (place != tracks_.end() && place->vehicle == options.id) {
    *place = TrackOf(options);
  } else {
    tracks_.insert(place, TrackOf(options));
  }
  red_lights_.Admit(options);
  progress_.Admit(options);
}

void Invariants::Tell(Invariant invariant, Tick tick, VehicleId vehicle, VehicleId other) {
  ++counts_[static_cast<std::size_t>(invariant)];
  if (first_.size() < kKeptViolations) first_.push_back({invariant, tick, vehicle, other});
}

bool Invariants::Held() const {
  return std::ranges::all_of(counts_, [](std::uint32_t count) { return count == 0; });
}

std::uint32_t Invariants::IndexOf(VehicleId vehicle) const {
  const auto found = std::ranges::lower_bound(tracks_, vehicle, {}, &Track::vehicle);
  if (found == tracks_.end() || found->vehicle != vehicle) return kUnknown;
  return static_cast<std::uint32_t>(found - tracks_.begin());
}

void Invariants::Observe(Tick tick, double time_s, std::span<const Observed> vehicles,
                         std::span<const WorldEvent> events) {
  GIVEWAY_CHECK(vehicles.size() == tracks_.size());
  if (last_tick_ != kNoTick && tick != After(last_tick_, 1)) NoteGap(tick);
  last_tick_ = tick;
  for (const WorldEvent& event : events) {
    if (event.kind == EventKind::kContact) JudgeContact(event);
  }
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    const Observed& now = vehicles[i];
    Track& track = tracks_[i];
    track.keys[Number(tick) % kRememberedKeys] = now.order;
    track.places[Number(tick) % kRememberedKeys] = {now.present ? tick : kNoTick,
                                                    now.position_world};
    if (now.present) JudgeStaleness(tick, now, &track);
    if (now.present) JudgePose(tick, now, &track);
    JudgeWait(tick, now, &track);
    track.last_forward_m_s = now.forward_m_s;
    track.last_position_world = now.position_world;
  }
  for (std::size_t i = 0; i < vehicles.size(); ++i) JudgeOrder(tick, vehicles[i], &tracks_[i]);
  JudgeCircles(tick, vehicles);
  JudgeAllHalted(tick, vehicles);
  JudgeWays(tick, time_s, vehicles);
}

void Invariants::NoteGap(Tick tick) {
  circle_ticks_ = 0;
  halted_ticks_ = 0;
  keys_known_at_ = Number(tick) + limits_.key_age_ticks;
}

// Of two that touch the one that was driving is at fault, of two that drove the faster.
VehicleId Invariants::MoreAtFault(const WorldEvent& contact) const {
  const std::uint32_t a = IndexOf(contact.vehicle);
  const std::uint32_t b = IndexOf(contact.other);
  if (b == kUnknown) return contact.vehicle;
  if (a == kUnknown) return contact.other;
  const bool second =
      Magnitude(tracks_[b].last_forward_m_s) > Magnitude(tracks_[a].last_forward_m_s);
  return second ? contact.other : contact.vehicle;
}

// A body that turns on the spot touches nothing, so every contact has someone who drove into it.
void Invariants::JudgeContact(const WorldEvent& event) {
  const VehicleId at_fault = MoreAtFault(event);
  Tell(Invariant::kContact, event.tick, at_fault,
       at_fault == event.vehicle ? event.other : event.vehicle);
}

// Data is stale where the vehicle says so, or where its last command is older than the world's
// watchdog allows. From then on it must brake: one tick for the command to arrive, then down by the
// deceleration every tick. Seen from outside it may be seen too early, and braking begins later.
void Invariants::JudgeStaleness(Tick tick, const Observed& now, Track* track) {
  const bool says_so = now.decision.rule == Rule::kRangesStale;
  const bool is_so =
      now.answered != kNoTick && TicksBetween(now.answered, tick) > watchdog_ticks_ + 1;
  if (!says_so && !is_so) {
    track->stale = false;
    track->stale_told = false;
    return;
  }
  const double speed = now.rim_m_s;
  if (!track->stale) track->stale_ticks = 0;
  track->stale = true;
  if (track->stale_ticks++ <= limits_.stale_ticks) {
    track->stale_limit_m_s = speed + track->acceleration_m_s2 * dt_s_;
    return;
  }
  if (speed > track->stale_limit_m_s + kStandstill_m_s && !track->stale_told) {
    track->stale_told = true;
    Tell(Invariant::kStaleMotion, tick, now.vehicle);
  }
  track->stale_limit_m_s = std::max(0.0, track->stale_limit_m_s - track->deceleration_m_s2 * dt_s_);
}

void Invariants::JudgeWait(Tick tick, const Observed& now, Track* track) {
  track->waited_ticks = Waits(now) ? track->waited_ticks + 1 : 0;
  if (track->waited_ticks == wait_ticks_ + 1) {
    Tell(Invariant::kWaitBound, tick, now.vehicle, now.decision.peer);
  }
}

// It went by the peer's key of a while ago and by its own, of now or as it was published before:
// one such pair of keys must put the peer first.
void Invariants::JudgeOrder(Tick tick, const Observed& now, Track* track) {
  const bool claims =
      Waits(now) && now.decision.rule == Rule::kGiveWay && Number(tick) >= keys_known_at_;
  const std::uint32_t peer = claims ? IndexOf(now.decision.peer) : kUnknown;
  if (peer == kUnknown) {
    track->order_told = false;
    return;
  }
  const std::uint32_t oldest =
      Number(tick) > limits_.key_age_ticks ? Number(tick) - limits_.key_age_ticks : 1;
  for (std::uint32_t of_peer = Number(tick); of_peer >= oldest; --of_peer) {
    const OrderKey& peers = tracks_[peer].keys[of_peer % kRememberedKeys];
    for (std::uint32_t own = Number(tick); own + 1 >= Number(tick) && own >= 1; --own) {
      if (ComesFirst(peers, tracks_[peer].vehicle, track->keys[own % kRememberedKeys],
                     now.vehicle)) {
        track->order_told = false;
        return;
      }
    }
  }
  if (!track->order_told) Tell(Invariant::kOrder, tick, now.vehicle, now.decision.peer);
  track->order_told = true;
}

// Judged by the truth of the tick it speaks of; of one too long ago nothing is known.
void Invariants::JudgePose(Tick tick, const Observed& now, Track* track) {
  const Place& place = track->places[Number(now.stated) % kRememberedKeys];
  if (now.stated == kNoTick || place.tick != now.stated) return;
  const double off_m = Norm(now.stated_position_world - place.position_world);
  const bool wrong = !(off_m <= kPoseSlack_m) &&
                     !(off_m <= kPoseSigmas * SigmaPosition(now.stated_covariance) + kPoseSlack_m);
  if (wrong && !track->pose_told) Tell(Invariant::kPose, tick, now.vehicle);
  track->pose_told = wrong;
}

// Everyone waits for at most one other, so a walk along the edges ends or meets itself.
void Invariants::JudgeCircles(Tick tick, std::span<const Observed> vehicles) {
  for (Track& track : tracks_) track.walk = 0;
  VehicleId found = kNobody;
  VehicleId found_next = kNobody;
  for (std::uint32_t start = 0; start < vehicles.size(); ++start) {
    const std::uint32_t walk = start + 1;
    for (std::uint32_t at = start; at != kUnknown && tracks_[at].walk == 0;) {
      if (!Waits(vehicles[at]) || vehicles[at].gives_way_to == kNobody) break;
      tracks_[at].walk = walk;
      const std::uint32_t next = IndexOf(vehicles[at].gives_way_to);
      if (next != kUnknown && tracks_[next].walk == walk) {
        found = vehicles[at].vehicle;
        found_next = vehicles[next].vehicle;
      }
      at = next;
    }
  }
  circle_ticks_ = found == kNobody ? 0 : circle_ticks_ + 1;
  if (circle_ticks_ == limits_.cycle_ticks + 1) {
    Tell(Invariant::kWaitCycle, tick, found, found_next);
  }
}

// A way is free where nobody has another reason to stand than to let someone else go. Who has
// arrived stands in nobody's way by right, but while it still rolls there is somebody to let go.
void Invariants::JudgeAllHalted(Tick tick, std::span<const Observed> vehicles) {
  bool anyone = false;
  bool all = true;
  VehicleId first = kNobody;
  for (const Observed& vehicle : vehicles) {
    if (!vehicle.present || !vehicle.lives) continue;
    if (vehicle.arrived) {
      all = all && Stands(vehicle);
      continue;
    }
    const bool lets_go =
        vehicle.decision.rule == Rule::kGiveWay || vehicle.decision.rule == Rule::kNotGranted;
    all = all && lets_go && Stands(vehicle);
    if (!anyone) first = vehicle.vehicle;
    anyone = true;
  }
  halted_ticks_ = anyone && all ? halted_ticks_ + 1 : 0;
  if (halted_ticks_ == limits_.halted_ticks + 1) Tell(Invariant::kAllHalted, tick, first);
}

void Invariants::JudgeWays(Tick tick, double time_s, std::span<const Observed> vehicles) {
  for (const std::uint32_t i : red_lights_.Observe(time_s, vehicles)) {
    Tell(Invariant::kRedLight, tick, vehicles[i].vehicle);
  }
  for (const std::uint32_t i : progress_.Observe(tick, time_s, red_lights_.AnyStops(), vehicles)) {
    Tell(Invariant::kProgress, tick, vehicles[i].vehicle, vehicles[i].decision.peer);
  }
}

bool Invariants::MustArrive(const Track& track) const {
  if (!track.has_goal) return false;
  return !limits_.arriving || std::ranges::binary_search(*limits_.arriving, track.vehicle);
}

void Invariants::Finish(Tick tick, std::span<const Observed> vehicles) {
  bool anyone = open_ || vehicles.empty();
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    const Observed& vehicle = vehicles[i];
    anyone = anyone || vehicle.lives || vehicle.arrived;
    if (!MustArrive(tracks_[i]) || !vehicle.present || !vehicle.lives || vehicle.arrived) continue;
    Tell(Invariant::kArrival, tick, vehicle.vehicle, vehicle.decision.peer);
  }
  if (!anyone) Tell(Invariant::kArrival, tick, vehicles.front().vehicle);
}

}  // namespace giveway::sim
