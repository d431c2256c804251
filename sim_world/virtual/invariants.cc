#include "sim_world/virtual/invariants.h"

#include <algorithm>

#include "services/types/check.h"
#include "services/types/math/math.h"
#include "services/types/time.h"

namespace giveway::sim {
namespace {

constexpr std::uint32_t kUnknown = 0xffffffff;
// How far a vehicle may be from the pose it publishes, beyond the uncertainty it publishes.
constexpr double kPoseSlack_m = 0.1;
// Within this distance of where it stood it has not moved on.
constexpr double kOnePlace_m = 0.1;

bool Stands(const Observed& vehicle) { return Magnitude(vehicle.forward_m_s) < kStandstill_m_s; }

// Halts to give way, by its decision and by the truth.
bool Waits(const Observed& vehicle) {
  return vehicle.present && vehicle.lives && !vehicle.arrived && Stands(vehicle) &&
         IsGiveWay(vehicle.decision.rule);
}

}  // namespace

std::string_view Name(Invariant invariant) {
  constexpr std::array<std::string_view, kInvariantCount> kNames = {
      "contact", "stale_motion", "wait_cycle", "wait_bound", "all_halted", "order", "arrival",
      "pose",    "red_light",    "progress",   "clearance",  "claim",      "delay", "yielding"};
  return kNames[static_cast<std::size_t>(invariant)];
}

std::optional<Invariant> InvariantNamed(std::string_view name) {
  for (std::size_t i = 0; i < kInvariantCount; ++i) {
    const auto invariant = static_cast<Invariant>(i);
    if (Name(invariant) == name) return invariant;
  }
  return std::nullopt;
}

InvariantSet RequiredInvariants() {
  InvariantSet required;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(Invariant::kProgress); ++i) required.set(i);
  return required;
}

Invariants::Invariants(const Scenario& scenario, const InvariantLimits& limits)
    : limits_(limits),
      open_(!scenario.spawns.empty()),
      dt_s_(Seconds(scenario.tick_period)),
      wait_ticks_(TicksCovering(FromSeconds(limits.wait_s), scenario.tick_period)),
      watchdog_ticks_(scenario.watchdog_ticks),
      red_lights_(scenario),
      progress_(scenario, limits.wedge_s),
      clearance_(scenario, limits.clearance_m),
      claims_(scenario),
      yielding_(scenario) {
  GIVEWAY_CHECK(limits.key_age_ticks < kRememberedKeys, limits.key_age_ticks);
  for (const VehicleOptions& options : scenario.vehicles) tracks_.push_back(TrackOf(options));
  for (const auto& group : limits_.one_of) {
    for (const VehicleId vehicle : group) {
      const std::uint32_t index = IndexOf(vehicle);
      if (index != kUnknown) tracks_[index].shares_goal = true;
    }
  }
  for (const DueTime& due : limits_.due) {
    const std::uint32_t index = IndexOf(due.vehicle);
    if (index != kUnknown) tracks_[index].due_s = due.at_s;
  }
  first_.reserve(kKeptViolations);
}

Invariants::Track Invariants::TrackOf(const VehicleOptions& options) {
  return {.vehicle = options.id,
          .deceleration_m_s2 = options.profile.deceleration_m_s2,
          .acceleration_m_s2 = options.profile.acceleration_m_s2,
          .has_goal = HasGoal(options),
          .is_box = options.profile.shape == BodyShape::kBox,
          .last_world = options.start_world,
          .on_route = !HasGoal(options) && options.route.count > 0,
          .stands_world = options.start_world.position_world};
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
  clearance_.Admit(options);
}

void Invariants::Forget(VehicleId vehicle) {
  std::erase_if(tracks_, [vehicle](const Track& track) { return track.vehicle == vehicle; });
  red_lights_.Forget(vehicle);
  progress_.Forget(vehicle);
  clearance_.Forget(vehicle);
}

void Invariants::Report(Invariant invariant, Tick tick, VehicleId vehicle, VehicleId other) {
  ++counts_[static_cast<std::size_t>(invariant)];
  const std::uint32_t index = IndexOf(vehicle);
  const Rule rule = index == kUnknown ? Rule::kNotRunning : tracks_[index].rule;
  auto& kept = limits_.required.test(static_cast<std::size_t>(invariant)) ? first_ : noted_;
  if (kept.size() < kKeptViolations) kept.push_back({invariant, tick, vehicle, other, rule});
}

std::uint64_t Invariants::Broken() const {
  std::uint64_t broken = 0;
  for (std::size_t i = 0; i < kInvariantCount; ++i) {
    if (limits_.required.test(i)) broken += counts_[i];
  }
  return broken;
}

std::uint32_t Invariants::IndexOf(VehicleId vehicle) const {
  const auto found = std::ranges::lower_bound(tracks_, vehicle, {}, &Track::vehicle);
  if (found == tracks_.end() || found->vehicle != vehicle) return kUnknown;
  return static_cast<std::uint32_t>(found - tracks_.begin());
}

void Invariants::Observe(Tick tick, double time_s, std::span<const Observed> vehicles,
                         std::span<const WorldEvent> events, const Surroundings& around) {
  GIVEWAY_CHECK(vehicles.size() == tracks_.size());
  if (last_tick_ != kNoTick && tick != After(last_tick_, 1)) NoteGap(tick);
  last_tick_ = tick;
  for (std::size_t i = 0; i < vehicles.size(); ++i) tracks_[i].rule = vehicles[i].decision.rule;
  for (const WorldEvent& event : events) {
    if (event.kind == EventKind::kContact) JudgeContact(event, vehicles);
  }
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    const Observed& now = vehicles[i];
    Track& track = tracks_[i];
    track.keys[Number(tick) % kRememberedKeys] = now.order;
    track.places[Number(tick) % kRememberedKeys] = {now.present ? tick : kNoTick,
                                                    now.position_world};
    if (now.present) JudgeStaleness(tick, now, &track);
    if (now.present) JudgePose(tick, now, &track);
    track.last_speed_m_s = track.is_box ? now.rim_m_s : Magnitude(now.forward_m_s);
    track.last_world = {now.position_world, now.heading_rad};
  }
  for (std::size_t i = 0; i < vehicles.size(); ++i) JudgeOrder(tick, vehicles[i], &tracks_[i]);
  JudgeCircles(tick, vehicles);
  JudgeAllHalted(tick, vehicles);
  JudgeLightsAndProgress(tick, time_s, vehicles);
  JudgeStanding(tick, vehicles);
  if (limits_.counts_others || (limits_.required & ~RequiredInvariants()).any()) {
    JudgeBodies(tick, time_s, vehicles, around);
  }
}

void Invariants::NoteRestart() {
  for (Track& track : tracks_) {
    track.places = {};
    track.stale = false;
  }
}

void Invariants::NoteGap(Tick tick) {
  circle_ticks_ = 0;
  halted_ticks_ = 0;
  keys_known_at_ = Number(tick) + limits_.key_age_ticks;
  for (Track& track : tracks_) track.stale = false;  // it may have driven meanwhile
  if (tick > last_tick_) progress_.Skip(TicksBetween(last_tick_, tick) - 1);
}

// Of two that touch the one that was driving is at fault, of two that drove the faster. A box
// drives as fast as its faster wheel: its corners move too where it turns on the spot.
VehicleId Invariants::MoreAtFault(const WorldEvent& contact) const {
  const std::uint32_t a = IndexOf(contact.vehicle);
  const std::uint32_t b = IndexOf(contact.other);
  if (b == kUnknown) return contact.vehicle;
  if (a == kUnknown) return contact.other;
  const bool second = tracks_[b].last_speed_m_s > tracks_[a].last_speed_m_s;
  return second ? contact.other : contact.vehicle;
}

// In the last tick and since.
bool Invariants::Stood(const Track& track, const Observed& now) {
  const bool turned = track.is_box && track.last_world.heading_rad != now.heading_rad;
  return track.last_speed_m_s == 0 && !turned &&
         track.last_world.position_world == now.position_world;
}

// A disc that turns on the spot touches nothing, so in every contact a vehicle drove into the
// other, or a box turned a corner into it; or a moving obstacle, which stops on contact alone,
// drove into one that stood.
void Invariants::JudgeContact(const WorldEvent& event, std::span<const Observed> vehicles) {
  const VehicleId at_fault = MoreAtFault(event);
  const std::uint32_t index = IndexOf(at_fault);
  const bool with_obstacle = IndexOf(event.vehicle) == kUnknown || IndexOf(event.other) == kUnknown;
  if (with_obstacle && index != kUnknown && Stood(tracks_[index], vehicles[index])) return;
  Report(Invariant::kContact, event.tick, at_fault,
         at_fault == event.vehicle ? event.other : event.vehicle);
}

// Data is stale if the vehicle reports so, or if its last command is older than the world's
// watchdog allows. From then on it must brake: one tick for the command to arrive, then by the
// deceleration every tick. An outside observer may see the stale data too early, and braking starts
// later.
void Invariants::JudgeStaleness(Tick tick, const Observed& now, Track* track) {
  const bool says_so = now.decision.rule == Rule::kRangesStale;
  const bool is_so =
      now.answered != kNoTick && TicksBetween(now.answered, tick) > watchdog_ticks_ + 1;
  if (!says_so && !is_so) {
    track->stale = false;
    track->stale_reported = false;
    return;
  }
  const double speed = now.rim_m_s;
  if (!track->stale) track->stale_ticks = 0;
  track->stale = true;
  if (track->stale_ticks++ <= limits_.stale_ticks) {
    track->stale_limit_m_s = speed + track->acceleration_m_s2 * dt_s_;
    return;
  }
  if (speed > track->stale_limit_m_s + kStandstill_m_s && !track->stale_reported) {
    track->stale_reported = true;
    Report(Invariant::kStaleMotion, tick, now.vehicle);
  }
  track->stale_limit_m_s = std::max(0.0, track->stale_limit_m_s - track->deceleration_m_s2 * dt_s_);
}

// By its position, which neither a rule's name nor a little turning changes.
void Invariants::JudgeStanding(Tick tick, std::span<const Observed> vehicles) {
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    const Observed& now = vehicles[i];
    Track& track = tracks_[i];
    const bool waits = Waits(now);
    const bool wants = MustArrive(track) || track.on_route;
    const bool may = !now.present || now.arrived || track.shares_goal ||
                     (!waits && (!wants || progress_.Excused(i)));
    const bool left =
        SquaredNorm(now.position_world - track.stands_world) > kOnePlace_m * kOnePlace_m;
    if (may || left) {
      track.stands_world = now.position_world;
      track.stood_ticks = 0;
    } else if (++track.stood_ticks == wait_ticks_ + 1) {
      Report(Invariant::kWaitBound, tick, now.vehicle, now.decision.peer);
    }
  }
}

// It may have used an earlier key of the peer, and its own current key or an earlier published one:
// one such pair of keys must give the peer priority.
void Invariants::JudgeOrder(Tick tick, const Observed& now, Track* track) {
  const bool claims =
      Waits(now) && now.decision.rule == Rule::kGiveWay && Number(tick) >= keys_known_at_;
  const std::uint32_t peer = claims ? IndexOf(now.decision.peer) : kUnknown;
  if (peer == kUnknown) {
    track->order_reported = false;
    return;
  }
  const std::uint32_t oldest =
      Number(tick) > limits_.key_age_ticks ? Number(tick) - limits_.key_age_ticks : 1;
  for (std::uint32_t of_peer = Number(tick); of_peer >= oldest; --of_peer) {
    const PriorityKey& peers = tracks_[peer].keys[of_peer % kRememberedKeys];
    for (std::uint32_t own = Number(tick); own + 1 >= Number(tick) && own >= 1; --own) {
      if (HasPriority(peers, tracks_[peer].vehicle, track->keys[own % kRememberedKeys],
                      now.vehicle)) {
        track->order_reported = false;
        return;
      }
    }
  }
  if (!track->order_reported) Report(Invariant::kOrder, tick, now.vehicle, now.decision.peer);
  track->order_reported = true;
}

// Judged by the truth of the tick it refers to; of one too long ago nothing is known.
void Invariants::JudgePose(Tick tick, const Observed& now, Track* track) {
  const Place& place = track->places[Number(now.stated) % kRememberedKeys];
  if (now.stated == kNoTick || place.tick != now.stated) return;
  const double off_m = Norm(now.stated_position_world - place.position_world);
  const bool wrong = !(off_m <= kPoseSlack_m) &&
                     !(off_m <= kPoseSigmas * SigmaPosition(now.stated_covariance) + kPoseSlack_m);
  if (wrong && !track->pose_reported) Report(Invariant::kPose, tick, now.vehicle);
  track->pose_reported = wrong;
}

// Every vehicle waits for at most one other, so a walk along the edges ends or runs into a cycle.
void Invariants::JudgeCircles(Tick tick, std::span<const Observed> vehicles) {
  for (Track& track : tracks_) track.walk = 0;
  VehicleId found = kNoVehicle;
  VehicleId found_next = kNoVehicle;
  for (std::uint32_t start = 0; start < vehicles.size(); ++start) {
    const std::uint32_t walk = start + 1;
    for (std::uint32_t at = start; at != kUnknown && tracks_[at].walk == 0;) {
      if (!Waits(vehicles[at]) || vehicles[at].gives_way_to == kNoVehicle) break;
      tracks_[at].walk = walk;
      const std::uint32_t next = IndexOf(vehicles[at].gives_way_to);
      if (next != kUnknown && tracks_[next].walk == walk) {
        found = vehicles[at].vehicle;
        found_next = vehicles[next].vehicle;
      }
      at = next;
    }
  }
  circle_ticks_ = found == kNoVehicle ? 0 : circle_ticks_ + 1;
  if (circle_ticks_ == limits_.cycle_ticks + 1) {
    Report(Invariant::kWaitCycle, tick, found, found_next);
  }
}

// Broken only if every vehicle stands to give way and none for another reason. An arrived vehicle
// may stand, but while it still rolls there is one to give way to.
void Invariants::JudgeAllHalted(Tick tick, std::span<const Observed> vehicles) {
  bool anyone = false;
  bool all = true;
  VehicleId first = kNoVehicle;
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
  if (halted_ticks_ == limits_.halted_ticks + 1) Report(Invariant::kAllHalted, tick, first);
}

void Invariants::JudgeLightsAndProgress(Tick tick, double time_s,
                                        std::span<const Observed> vehicles) {
  for (const std::uint32_t i : red_lights_.Observe(time_s, vehicles)) {
    Report(Invariant::kRedLight, tick, vehicles[i].vehicle);
  }
  for (const std::uint32_t i : progress_.Observe(tick, time_s, red_lights_.AnyStops(), vehicles)) {
    if (tracks_[i].shares_goal) continue;
    Report(Invariant::kProgress, tick, vehicles[i].vehicle, vehicles[i].decision.peer);
  }
}

void Invariants::JudgeBodies(Tick tick, double time_s, std::span<const Observed> vehicles,
                             const Surroundings& around) {
  for (const TooNear& near : clearance_.Observe(vehicles, around)) {
    Report(Invariant::kClearance, tick, vehicles[near.vehicle].vehicle, near.other);
  }
  for (const std::uint32_t i : claims_.Observe(tick, vehicles)) {
    Report(Invariant::kClaim, tick, vehicles[i].vehicle);
  }
  for (const std::uint32_t i : yielding_.Observe(vehicles)) {
    Report(Invariant::kYielding, tick, vehicles[i].vehicle, vehicles[i].decision.peer);
  }
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    Track& track = tracks_[i];
    if (track.due_s <= 0 || time_s <= track.due_s) continue;
    track.due_s = 0;
    const Observed& now = vehicles[i];
    if (now.arrived || !now.present || !now.lives || !MustArrive(track)) continue;
    Report(Invariant::kDelay, tick, now.vehicle, now.decision.peer);
  }
}

bool Invariants::MustArrive(const Track& track) const {
  if (!track.has_goal || track.shares_goal) return false;
  return !limits_.arriving || std::ranges::binary_search(*limits_.arriving, track.vehicle);
}

// Is live, or stands in its goal.
bool Invariants::IsAnyOf(const std::vector<VehicleId>& group, std::span<const Observed> vehicles,
                         bool arrived) const {
  return std::ranges::any_of(vehicles, [&](const Observed& vehicle) {
    const bool counts = arrived ? vehicle.arrived && Stands(vehicle) : vehicle.lives;
    return counts && vehicle.present && std::ranges::binary_search(group, vehicle.vehicle);
  });
}

void Invariants::Finish(Tick tick, std::span<const Observed> vehicles) {
  bool anyone = open_ || vehicles.empty();
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    const Observed& vehicle = vehicles[i];
    anyone = anyone || vehicle.lives || vehicle.arrived;
    if (!MustArrive(tracks_[i]) || !vehicle.present || !vehicle.lives) continue;
    if (vehicle.arrived && Stands(vehicle)) continue;
    Report(Invariant::kArrival, tick, vehicle.vehicle, vehicle.decision.peer);
  }
  for (const auto& group : limits_.one_of) {
    if (IsAnyOf(group, vehicles, true) || !IsAnyOf(group, vehicles, false)) continue;
    Report(Invariant::kArrival, tick, group.front(), group.back());
  }
  if (!anyone) Report(Invariant::kArrival, tick, vehicles.front().vehicle);
}

}  // namespace giveway::sim
