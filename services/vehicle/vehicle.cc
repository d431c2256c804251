#include "services/vehicle/vehicle.h"

#include <algorithm>
#include <new>
#include <type_traits>

#include "services/types/check.h"
#include "services/types/math/math.h"
#include "services/vehicle/decision/decide.h"
#include "services/vehicle/estimation/beacon_check.h"
#include "services/vehicle/estimation/lost_ticks.h"
#include "services/vehicle/estimation/planted.h"
#include "services/vehicle/estimation/scan_check.h"
#include "services/vehicle/evidence.h"
#include "services/vehicle/situation/blocked.h"
#include "services/vehicle/situation/box.h"
#include "services/vehicle/situation/echo_trust.h"
#include "services/vehicle/situation/echoes.h"
#include "services/vehicle/situation/encounter.h"
#include "services/vehicle/situation/heard_places.h"
#include "services/vehicle/situation/look.h"

namespace giveway {
namespace {

static_assert(std::is_trivially_copyable_v<VehicleState>);

constexpr std::uint32_t kBlockedTicks = 20;  // what was in the way is still, for so long
// What the wheels do and what the encoders say of it are wrong independently of each other.
double WheelError(const VehicleProfile& profile) {
  return Sqrt(profile.wheel_slip * profile.wheel_slip +
              profile.encoder_noise * profile.encoder_noise);
}

// What a step adds to the variance of where things are that lie half a metre off: of the own place
// and of the heading.
double VarianceOfPlaces(const PoseCovariance& added) {
  constexpr double kLever_m = 0.5;
  return added.xx_m2 + added.yy_m2 + kLever_m * kLever_m * added.hh_rad2;
}

}  // namespace

Vehicle::Vehicle(const VehicleOptions& options, std::uint32_t boot_epoch)
    : options_(options),
      cones_(ConesOf(options.profile)),
      state_(std::make_unique_for_overwrite<VehicleState>()),
      views_(std::make_unique_for_overwrite<std::array<PeerView, kMaxPeers>>()) {
  GIVEWAY_CHECK(options.id != kNobody);
  GIVEWAY_CHECK(boot_epoch != 0);
  state_->boot_epoch = boot_epoch;
  state_->odometry = Odometry(options.start_world);
  Begin(options.profile, &state_->pose);
  state_->order = {.speed_bucket = SpeedBucket(options.cruise_m_s), .vehicle = options.id};
}

// Dead reckoning: the encoders give the constant wheel speeds since the last tick, or what they
// counted since the pose was true that the vehicle was told.
void Vehicle::TakeScan(const RangeScan& scan, SteadyTime now) {
  VehicleState& state = *state_;
  if (!IsBelievable(scan, options_)) {  // as if none had come: the ranges grow old, and it halts
    ++state.scans_refused;
    return;
  }
  // A world that has not said where the vehicle stands in it, or one that is gone.
  if (state.placed_in != kNoEpoch && scan.epoch != state.placed_in) return;
  if (scan.epoch != state.epoch) EnterWorld(scan.epoch, options_.start_world);
  // Out of order: older than known. The scan of the very tick it was placed at is still to be seen.
  if (scan.tick < state.reckoned || (state.tick != kNoTick && scan.tick == state.tick)) return;
  const std::uint32_t ticks =
      state.reckoned == kNoTick ? 1 : TicksBetween(state.reckoned, scan.tick);
  const double dt_s = Seconds(ticks * options_.tick_period);
  const VehicleProfile& profile = options_.profile;
  const Vec2 from_world = state.odometry.WorldFromBody().position_world;
  const Vec2 forward_world = state.odometry.ForwardWorld();
  const double from_rad = state.odometry.WorldFromBody().heading_rad;
  const WayGone gone = ticks > 1 ? WayOfLostTicks(state.counted, scan, options_, dt_s)
                                 : WayGone{.wheels = scan.wheels};
  const PoseCovariance added = Roll(profile,
                                    {.wheels = gone.wheels,
                                     .dt_s = dt_s,
                                     .wheel_error = WheelError(profile),
                                     .guessed_m = gone.guessed_m,
                                     .tick = scan.tick},
                                    &state.odometry, &state.pose);
  if (Remembers(options_)) {
    const Pose& after = state.odometry.WorldFromBody();
    const Vec2 way = after.position_world - from_world;
    state.grid.Move({Dot(forward_world, way), Cross(forward_world, way)},
                    after.heading_rad - from_rad, VarianceOfPlaces(added));
  }
  state.tick = scan.tick;
  state.reckoned = scan.tick;
  state.counted = scan.counted;
  state.run_state = scan.run_state;
  state.wheels = scan.wheels;
  if (HasImperfectSonar(options_)) {
    const Twist twist = TwistFromWheels(profile.drive, scan.wheels);
    const double turned_rad = twist.turn_rad_s * dt_s;
    const OwnWay moved{twist.forward_m_s * dt_s, turned_rad < 0 ? -turned_rad : turned_rad};
    state.ranges.TakeImperfect(scan, now, options_.tick_period, moved);
  } else {
    state.ranges.Take(scan, now, options_.tick_period);
  }
}

void Vehicle::TakePeers(const Inputs& inputs) {
  VehicleState& state = *state_;
  const Self self{options_.id, state.epoch, state.tick,
                  state.odometry.WorldFromBody().position_world};
  state.peers.Advance(inputs.now, state.tick);
  refused_count_ = 0;
  fates_.clear();
  for (std::uint32_t i = 0; i < inputs.beacons.size(); ++i) {
    const std::uint32_t accepted = state.beacons.accepted;
    const BeaconRefusal why =
        state.peers.Take(inputs.beacons[i], self, options_, &state.beacons, &state.trust);
    fates_.push_back(why != BeaconRefusal::kNone          ? BeaconFate::kRefused
                     : state.beacons.accepted != accepted ? BeaconFate::kAccepted
                                                          : BeaconFate::kNotHeard);
    if (why == BeaconRefusal::kNone || refused_count_ == refused_.size()) continue;
    refused_[refused_count_++] = {i, why};
  }
  for (const QosEvent& event : inputs.events) state.peers.Note(event, &state.qos);
}

void Vehicle::TakeSignalsAndObjects(const Inputs& inputs) {
  VehicleState& state = *state_;
  for (const SignalState& signal : inputs.signals) {
    state.signals_refused += state.signals.Take(signal, state.epoch, inputs.now) ? 0 : 1;
  }
  const Observer observer{state.epoch, state.tick, state.odometry.WorldFromBody(), SpeedMps()};
  state.scans_refused += TakeObjects(inputs, observer, &state.objects);
}

Situation Vehicle::Look(const Inputs& inputs) {
  VehicleState& state = *state_;
  const Twist twist = TwistFromWheels(options_.profile.drive, state.wheels);
  HearEchoes(state.ranges, state.tick, options_, &echoes_);
  Situation s{.options = options_,
              .ranges = state.ranges,
              .echoes = echoes_,
              .cones = cones_,
              .objects = state.objects};
  s.now = inputs.now;
  s.tick = state.tick;
  s.new_tick = state.tick != state.decided_tick;
  s.run_state = state.run_state;
  s.leaving = inputs.leaving;
  s.halting = inputs.halting;
  LookAtOwnPose(&s);
  s.speed_m_s = twist.forward_m_s;
  s.turn_rad_s = twist.turn_rad_s;
  s.wheels = state.wheels;
  s.reaction_s = ReactionSeconds(options_);
  s.slows_m =
      StoppingDistance(options_.cruise_m_s, s.reaction_s, options_.profile.deceleration_m_s2);
  s.sweeps_m = OwnSweep(s);
  s.looks_m = LooksAround(options_.profile);
  s.order = ActingOrder(state.order, state.peers, options_.id);
  s.steer_side = state.steer_side;
  s.blind_sensor = state.ranges.FirstBlind(inputs.now, state.tick, options_, cones_.enabled);
  LookAhead(&s);
  s.path_rad = state.way.Of(s.path.direction_world);
  s.arrived = state.arrived;
  return s;
}

// Lights are for cooperative vehicles; the lecture's behaviours know none.
void Vehicle::LookAtSignals(Situation* s) {
  if (options_.behaviour != Behaviour::kCooperative || s->run_state != RunState::kRunning) return;
  const VehicleProfile& profile = options_.profile;
  const double stopping_m =
      StoppingDistance(std::max(0.0, s->speed_m_s), s->reaction_s, profile.deceleration_m_s2);
  s->stop_line = state_->signals.MustStopAt({.path = s->path,
                                             .distance_to_goal_m = s->distance_to_goal_m,
                                             .body_radius_m = profile.body_radius_m,
                                             .stopping_m = stopping_m},
                                            s->now);
  s->at_signal = state_->decision.rule == Rule::kSignal;
}

// Views are made where they stay: copying one costs as much as making it.
std::span<PeerView> Vehicle::ThoseThatMatter(Situation* s) {
  std::uint32_t count = 0;
  std::uint32_t heard = 0;
  bool someone_lost = false;
  for (Peer& peer : state_->peers.Peers()) {
    if (!peer.known) continue;
    const bool fresh = IsFresh(peer, s->now, s->tick, options_);
    heard += fresh ? 1 : 0;
    someone_lost = someone_lost || IsLost(peer, fresh);
    if (!CanMatter(peer, fresh, *s)) continue;
    auto* view = new (&(*views_)[count++]) PeerView;
    view->peer = &peer;
    view->fresh = fresh;
  }
  peers_heard_ = heard;
  s->someone_lost = someone_lost;
  return {views_->data(), count};
}

void Vehicle::LookAtPeers(Situation* s) {
  const std::span<PeerView> views = ThoseThatMatter(s);
  CarryForward(views, *s);
  for (PeerView& view : views) {
    LookAt(&view, *s);
    s->someone_doubted = s->someone_doubted || (view.fresh && !view.believed);
    // To a doubted peer's word an echo near it is still an echo that nobody explains; by the
    // lecture's behaviours a known body is kept from no less than an unknown one.
    const bool explains = view.believed || options_.behaviour != Behaviour::kCooperative;
    s->explained |= explains ? view.explains : 0;
  }
  JudgeEchoes(views, *s, &state_->trust);
  s->blocked_box = FindBoxes(views, *s);
  UpdateEncounters(views, s);
  s->peers = views;
}

// The printed scripts look at nobody: they know neither places nor ways, only the one variable.
void Vehicle::LookAround(Situation* s) {
  if (options_.behaviour != Behaviour::kLecturePrinted) {
    NoteTurning(s);
    LookAtPeers(s);
    ListenForMovers(s);
    if (Remembers(options_)) {
      RememberEchoes(*s, &state_->grid);
      ListPlaces(state_->grid, *s, &places_);
      s->places = places_.All();
    }
    Detour(s);
    return;
  }
  const std::span<const Peer> peers = state_->peers.Peers();
  peers_heard_ =
      static_cast<std::uint32_t>(std::count_if(peers.begin(), peers.end(), [&](const Peer& peer) {
        return IsFresh(peer, s->now, s->tick, options_);
      }));
  HearTheLast(peers, &state_->last_heard);
  s->last_heard = state_->last_heard;
}

// What the next step must know.
void Vehicle::Remember(const Situation& s, const Action& action) {
  const Decision& decision = action.decision;
  VehicleState& state = *state_;
  KeepOrder(s, IsGiveWay(decision.rule) && s.speed_m_s < kStandingSpeed_m_s);
  if (Has(Defect::kMeasuredSpeedInOrder)) state.order.speed_bucket = SpeedBucket(s.speed_m_s);
  state.decision = decision;
  state.decided_tick = s.tick;
  state.steer_side = action.steer_side;
  if (action.away_rad) {
    state.away_rad = *action.away_rad;
    state.away_tick = s.tick;
  }
  KeepBlocked(BlockedBy(s, decision, action.blocked_by), s);
}

// What is in the way now and then is in the way: the order it is lent must not come and go.
void Vehicle::KeepBlocked(VehicleId blocked_by, const Situation& s) {
  VehicleState& state = *state_;
  if (blocked_by != kNobody) {
    state.blocked_by = blocked_by;
    state.blocked_tick = s.tick;
    return;
  }
  const bool recent = state.blocked_tick != kNoTick && !s.arrived &&
                      TicksBetween(state.blocked_tick, s.tick) <= kBlockedTicks;
  if (!recent || !IsStillNear(state.blocked_by, s)) state.blocked_by = kNobody;
}

Beacon Vehicle::Say(const Situation& s) {
  VehicleState& state = *state_;
  ++state.seq;
  state.gives_way_to = GivesWayTo(s);
  ++state.beacons.sent;
  return {.vehicle = options_.id,
          .boot_epoch = state.boot_epoch,
          .seq = state.seq,
          .world_epoch = state.epoch,
          .tick = state.tick,
          .wheels = state.wheels,
          .cruise_m_s = options_.cruise_m_s,
          .world_from_body = s.world_from_body,
          .covariance = s.covariance,
          .body_radius_m = options_.profile.body_radius_m,
          .drive = options_.profile.drive,
          .acceleration_m_s2 = options_.profile.acceleration_m_s2,
          .deceleration_m_s2 = options_.profile.deceleration_m_s2,
          .toward_world = Toward(s),
          .mode = state.decision.mode,
          .rule = state.decision.rule,
          .gives_way_to = state.gives_way_to,
          .blocked_by = state.blocked_by,
          .order = s.order};
}

Outputs Vehicle::Step(const Inputs& inputs) noexcept {
  VehicleState& state = *state_;
  if (inputs.roster) TakeRoster(*inputs.roster);
  if (inputs.scan) TakeScan(*inputs.scan, inputs.now);
  TakeFix(inputs);
  TakePeers(inputs);
  TakeSignalsAndObjects(inputs);
  Situation s = Look(inputs);
  LookAtSignals(&s);
  LookAround(&s);
  const Action action = Decide(s);
  const bool changed = !SameReason(action.decision, state.decision);
  Remember(s, action);
  evidence_ = EvidenceOf(s, action.decision, changed);

  return {.command = {.vehicle = options_.id,
                      .epoch = state.epoch,
                      .tick = state.tick,
                      .target = action.target,
                      .decision = action.decision,
                      .decision_changed = changed,
                      .task = {state.waypoint, state.waited_ticks}},
          .beacon = Say(s),
          .decision_changed = changed};
}

double Vehicle::SpeedMps() const {
  return TwistFromWheels(options_.profile.drive, state_->wheels).forward_m_s;
}

}  // namespace giveway
