#include "services/vehicle/vehicle.h"

#include <algorithm>

#include "services/types/check.h"
#include "services/types/math/math.h"
#include "services/types/time.h"
#include "services/vehicle/decision/decide.h"
#include "services/vehicle/estimation/beacon_check.h"
#include "services/vehicle/estimation/injected_mutants.h"
#include "services/vehicle/estimation/lost_ticks.h"
#include "services/vehicle/estimation/scan_check.h"
#include "services/vehicle/evidence.h"
#include "services/vehicle/mover_watch.h"
#include "services/vehicle/own_path.h"
#include "services/vehicle/placing.h"
#include "services/vehicle/situation/blocked.h"
#include "services/vehicle/situation/box.h"
#include "services/vehicle/situation/echo_trust.h"
#include "services/vehicle/situation/echoes.h"
#include "services/vehicle/situation/encounter.h"
#include "services/vehicle/situation/heard_places.h"
#include "services/vehicle/situation/peer_relation.h"
#include "services/vehicle/situation/sonar_trust.h"
#include "services/vehicle/waiting.h"

namespace giveway {
namespace {

constexpr Nanoseconds kBlockedFor = std::chrono::seconds(1);  // a blocker that is not seen any more
// What the wheels do and what the encoders say of it are wrong independently of each other.
double WheelError(const RobotModel& profile) {
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
      state_(std::make_unique<VehicleState>()) {
  GIVEWAY_CHECK(options.id != kNoVehicle);
  GIVEWAY_CHECK(boot_epoch != 0);
  state_->published.boot_epoch = boot_epoch;
  state_->motion.odometry = Odometry(options.start_world);
  Begin(options.profile, &state_->motion.pose);
  state_->waiting.order = {.speed_bucket = SpeedBucket(options.cruise_m_s), .vehicle = options.id};
}

void Vehicle::Reseat(const VehicleOptions& options) {
  GIVEWAY_CHECK(options.id == options_.id, Number(options.id));
  options_ = options;
  cones_ = ConesOf(options.profile);
  state_->waiting.order = {.speed_bucket = SpeedBucket(options.cruise_m_s), .vehicle = options.id};
  state_->world.placed_in = kNoEpoch;
}

std::optional<Handover> Vehicle::HandOver() const { return HandoverOf(*state_); }

bool Vehicle::TakeOver(const Handover& handover) {
  return giveway::TakeOver(handover, options_, state_.get());
}

std::uint64_t Vehicle::Hash() const { return HashOf(*state_, options_.profile); }

// Dead reckoning: the encoders give the constant wheel speeds since the last tick, or the angles
// counted since the assigned start pose was true.
void Vehicle::TakeScan(const RangeScan& scan, SteadyTime now) {
  VehicleState& state = *state_;
  if (!IsBelievable(scan, options_)) {  // as if none had come: the ranges grow old, and it halts
    ++state.counters.scans_refused;
    return;
  }
  // A world that has not said where the vehicle stands in it, or one that is gone.
  if (state.world.placed_in != kNoEpoch && scan.epoch != state.world.placed_in) return;
  if (scan.epoch != state.world.epoch)
    EnterWorld(scan.epoch, options_.start_world, options_, &state);
  // Out of order: older than known. The scan of the very tick it was placed at is still to be seen.
  if (scan.tick < state.motion.pose_tick || scan.tick == state.world.tick) return;
  const std::uint32_t ticks =
      state.motion.pose_tick == kNoTick ? 1 : TicksBetween(state.motion.pose_tick, scan.tick);
  const double dt_s = Seconds(ticks * options_.tick_period);
  const RobotModel& profile = options_.profile;
  const Vec2 from_world = state.motion.odometry.WorldFromBody().position_world;
  const Vec2 forward_world = state.motion.odometry.ForwardWorld();
  const double from_rad = state.motion.odometry.WorldFromBody().heading_rad;
  const LostTicksMotion gone = ticks > 1
                                   ? MotionOfLostTicks(state.motion.counted, scan, options_, dt_s)
                                   : LostTicksMotion{.wheels = scan.wheels};
  const PoseCovariance added = Roll(profile,
                                    {.wheels = gone.wheels,
                                     .dt_s = dt_s,
                                     .wheel_error = WheelError(profile),
                                     .guessed_m = gone.guessed_m,
                                     .tick = scan.tick},
                                    &state.motion.odometry, &state.motion.pose);
  if (Remembers(options_)) {
    const Pose& after = state.motion.odometry.WorldFromBody();
    const Vec2 displacement = after.position_world - from_world;
    state.sensed.grid.Move({Dot(forward_world, displacement), Cross(forward_world, displacement)},
                           after.heading_rad - from_rad, VarianceOfPlaces(added));
  }
  state.world.tick = scan.tick;
  state.motion.pose_tick = scan.tick;
  state.motion.counted = scan.counted;
  state.world.run_state = scan.run_state;
  state.motion.wheels = scan.wheels;
  change_ = ChangeOf(state.sensed.ranges, scan, options_, cones_);
  if (HasImperfectSonar(options_)) {
    const Twist twist = TwistFromWheels(profile.drive, gone.wheels);
    const double turned_rad = twist.turn_rad_s * dt_s;
    const OwnDisplacement moved{twist.forward_m_s * dt_s,
                                turned_rad < 0 ? -turned_rad : turned_rad};
    state.sensed.ranges.TakeImperfect(scan, now, options_.tick_period, moved);
  } else {
    state.sensed.ranges.Take(scan, now, options_.tick_period);
  }
}

// Those of a world that has not placed it yet say nothing.
void Vehicle::TakeFix(const Inputs& inputs) {
  VehicleState& state = *state_;
  if (state.world.tick == kNoTick) return;
  const FixTaker taker{.vehicle = options_.id,
                       .epoch = state.world.epoch,
                       .tick = state.world.tick,
                       .tick_s = Seconds(options_.tick_period)};
  TakeWaiting(options_.profile, taker, &state.motion.odometry, &state.motion.pose);
  if (inputs.pose_fix) {
    Take(*inputs.pose_fix, options_.profile, taker, &state.motion.odometry, &state.motion.pose);
  }
}

void Vehicle::TakePeers(const Inputs& inputs) {
  VehicleState& state = *state_;
  const Self self{options_.id, state.world.epoch, state.world.tick,
                  state.motion.odometry.WorldFromBody().position_world};
  state.heard.peers.Advance(inputs.now, state.world.tick);
  refused_count_ = 0;
  fates_.clear();
  for (std::uint32_t i = 0; i < inputs.beacons.size(); ++i) {
    BeaconCounters& counted = state.counters.beacons;
    const std::uint32_t accepted = counted.accepted;
    const BeaconRefusal why =
        state.heard.peers.Take(inputs.beacons[i], self, options_, &counted, &state.counters.trust);
    fates_.push_back(why != BeaconRefusal::kNone    ? BeaconFate::kRefused
                     : counted.accepted != accepted ? BeaconFate::kAccepted
                                                    : BeaconFate::kNotHeard);
    if (why == BeaconRefusal::kNone || refused_count_ == refused_.size()) continue;
    refused_[refused_count_++] = {i, why};
  }
  for (const QosEvent& event : inputs.events) state.heard.peers.Note(event, &state.counters.qos);
}

void Vehicle::TakeSignalsAndObjects(const Inputs& inputs) {
  VehicleState& state = *state_;
  const Pose& own = state.motion.odometry.WorldFromBody();
  for (const SignalState& signal : inputs.signals) {
    const bool taken =
        state.heard.signals.Take(signal, state.world.epoch, inputs.now, own.position_world);
    state.counters.signals_refused += taken ? 0 : 1;
  }
  const Observer observer{state.world.epoch, state.world.tick, own, SpeedMps()};
  state.counters.scans_refused += TakeObjects(inputs, observer, &state.sensed.objects);
}

OwnPose Vehicle::AssessOwnPose() {
  MeasuredMotion& motion = state_->motion;
  const PoseCovariance promised = PromisedCovariance(motion.odometry, motion.pose);
  const double known_share = JudgeCertainty(options_.profile, promised, &motion.pose);
  return {.world_from_body = motion.odometry.WorldFromBody(),
          .forward_world = motion.odometry.ForwardWorld(),
          .covariance = promised,
          .known_share = known_share,
          .lost = motion.pose.lost};
}

OwnMotion Vehicle::AssessOwnMotion(const OwnPose& pose) {
  const WheelSpeeds wheels = state_->motion.wheels;
  const Twist twist = TwistFromWheels(options_.profile.drive, wheels);
  OwnMotion motion{.speed_m_s = twist.forward_m_s,
                   .turn_rad_s = twist.turn_rad_s,
                   .wheels = wheels,
                   .reaction_s = ReactionSeconds(options_),
                   .interest_radius_m = InterestRadius(options_.profile)};
  motion.slows_m =
      StoppingDistance(options_.cruise_m_s, motion.reaction_s, options_.profile.deceleration_m_s2);
  motion.sweeps_m = OwnSweep(motion, pose.covariance, options_);
  // The printed scripts know no peers.
  motion.turns = options_.behaviour != Behaviour::kLecturePrinted &&
                 NoteTurning(twist, state_->world.tick, options_.tick_period, &state_->movers);
  return motion;
}

// Lights are for cooperative vehicles; the lecture's behaviours know none.
Lights Vehicle::AssessSignals(const Moment& moment, const OwnMotion& motion,
                              const OwnCourse& course) {
  if (options_.behaviour != Behaviour::kCooperative || moment.run_state != RunState::kRunning) {
    return {};
  }
  SignalTable& signals = state_->heard.signals;
  const bool at_signal = state_->last.decision.rule == Rule::kSignal;
  if (signals.Heard() == 0) return {.at_signal = at_signal};
  const RobotModel& profile = options_.profile;
  const double stopping_m = StoppingDistance(std::max(0.0, motion.speed_m_s), motion.reaction_s,
                                             profile.deceleration_m_s2);
  // Further past a waypoint it can stop in time once it has passed it. What it turns there, and the
  // margin to a line, take some of that.
  constexpr double kInHandAtWaypoint_m = 0.5;
  const LegsBeyond beyond =
      FindLegsBeyond(course, state_->route.waypoint, options_,
                     motion.slows_m + profile.body_radius_m + kInHandAtWaypoint_m);
  return {.stop_line = signals.MustStopAt({.path = course.path,
                                           .distance_to_goal_m = course.distance_to_goal_m,
                                           .body_radius_m = profile.body_radius_m,
                                           .stopping_m = stopping_m,
                                           .beyond = beyond.All()},
                                          moment.now),
          .at_signal = at_signal};
}

OwnView Vehicle::AssessSelf(const Inputs& inputs) {
  VehicleState& state = *state_;
  HearEchoes(state.sensed.ranges, state.world.tick, options_, &echoes_);
  const Moment moment{.now = inputs.now,
                      .tick = state.world.tick,
                      .new_tick = state.world.tick != state.last.decided_tick,
                      .run_state = state.world.run_state,
                      .leaving = inputs.leaving,
                      .halting = inputs.halting};
  const OwnPose pose = AssessOwnPose();
  const OwnMotion motion = AssessOwnMotion(pose);
  const OwnCourse course = UpdatePath(pose, options_, &state.route, &state.progress);
  const SensorsNow sensors{.ranges = state.sensed.ranges,
                           .change = change_,
                           .echoes = echoes_,
                           .cones = cones_,
                           .objects = state.sensed.objects,
                           .blind_sensor = state.sensed.ranges.FirstBlind(
                               inputs.now, moment.tick, options_, cones_.enabled)};
  const Lights lights = AssessSignals(moment, motion, course);
  return {moment,
          pose,
          motion,
          course,
          sensors,
          lights,
          options_,
          ActingOrder(state.waiting.order, state.heard.peers, moment, options_),
          state.last.steer_side};
}

PeerViews<HeardPeer> Vehicle::SelectRelevantPeers(const OwnView& s, bool* any_lost) {
  views_.clear();
  std::uint32_t heard = 0;
  bool someone_lost = false;
  for (Peer& peer : state_->heard.peers.Peers()) {
    if (!peer.known) continue;
    const bool fresh = IsFresh(peer, s.now, s.tick, options_);
    heard += fresh ? 1 : 0;
    someone_lost = someone_lost || IsLost(peer, fresh);
    if (!IsRelevant(peer, fresh, s)) continue;
    PeerView& view = views_.emplace_back();
    view.peer = &peer;
    view.fresh = fresh;
  }
  peers_heard_ = heard;
  *any_lost = someone_lost;
  return PeerViews<HeardPeer>(views_);
}

PeersNow Vehicle::AssessPeers(const OwnView& s) {
  bool someone_lost = false;
  const PeerViews<HeardPeer> heard = SelectRelevantPeers(s, &someone_lost);
  const RelatedPeers related = RelatePeers(CarryForward(heard, s), s);
  const Boxes boxes = FindBoxes(related.views, s);
  JudgeEchoes(boxes.views, someone_lost, s, &state_->counters.trust);
  JudgeSonar(boxes.views, s, &state_->sensed.doubt);
  return {.peers = boxes.views,
          .explained = related.explained,
          .someone_lost = someone_lost,
          .someone_doubted = related.someone_doubted,
          .unheard = someone_lost ? FindUnheard(boxes.views, s, state_->sensed.doubt) : nullptr,
          .blocked_box = boxes.blocked,
          .encounters = UpdateEncounters(boxes.views, s)};
}

// The printed scripts know neither places nor paths, only the one variable.
PeersNow Vehicle::AssessLastHeard(const OwnView& s) {
  const std::span<const Peer> peers = state_->heard.peers.Peers();
  peers_heard_ =
      static_cast<std::uint32_t>(std::count_if(peers.begin(), peers.end(), [&](const Peer& peer) {
        return IsFresh(peer, s.now, s.tick, options_);
      }));
  HearTheLast(peers, &state_->heard.last_heard);
  return {};
}

PeersNow Vehicle::AssessSurroundings(const OwnView& s) {
  return options_.behaviour == Behaviour::kLecturePrinted ? AssessLastHeard(s) : AssessPeers(s);
}

// Where something was heard, this tick's firings among it.
std::span<const Vec2> Vehicle::PlacesHeard(const OwnView& s, const PeersNow& near) {
  if (!Remembers(options_)) return {};
  RememberEchoes(s, near, &state_->sensed.grid);
  ListPlaces(state_->sensed.grid, s, &places_);
  return places_.All();
}

Situation Vehicle::BuildSituation(const OwnView& own, const PeersNow& near) {
  VehicleState& state = *state_;
  if (options_.behaviour == Behaviour::kLecturePrinted) {
    return {.own = own, .near = near, .last_heard = state.heard.last_heard};
  }
  return {.own = own,
          .near = near,
          .movers = DetectMovers(own, near, &state.movers, &state.counters.trust),
          .places = PlacesHeard(own, near),
          .escape = Detour(own, near, state.last, &state.progress)};
}

// What the next step must know.
void Vehicle::Remember(const Situation& s, const Action& action) {
  const Decision& decision = action.decision;
  VehicleState& state = *state_;
  const bool waits = IsGiveWay(decision.rule) && s.own.speed_m_s < kStandingSpeed_m_s;
  KeepOrder(s.own, s.near.encounters, waits, &state.waiting);
  if (MutantActive(Mutant::kMeasuredSpeedInOrder))
    state.waiting.order.speed_bucket = SpeedBucket(s.own.speed_m_s);
  state.last.decision = decision;
  state.last.decided_tick = s.own.tick;
  state.last.steer_side = action.steer_side;
  if (action.away_rad) {
    state.progress.away_rad = *action.away_rad;
    state.progress.away_tick = s.own.tick;
  }
  KeepBlocked(BlockedBy(s, decision, action.blocked_by), s);
}

// Hysteresis: an intermittent obstruction counts as continuous, so that the inherited priority does
// not flicker.
void Vehicle::KeepBlocked(VehicleId blocked_by, const Situation& s) {
  VehicleState& state = *state_;
  if (blocked_by != kNoVehicle) {
    state.last.blocked_by = blocked_by;
    state.last.blocked_tick = s.own.tick;
    return;
  }
  const PeerView* blocker = ViewOf(state.last.blocked_by, s.near.peers);
  const bool fresh = blocker != nullptr && blocker->fresh;
  // Nor with a hold that only the inherited priority makes: without that key this vehicle would
  // drive on until the peer blocks it, which would inherit again.
  if (fresh && blocker->peer->encounter.holds && blocker->peer->beacon.order.vehicle == options_.id)
    state.last.blocked_tick = s.own.tick;
  const bool recent = state.last.blocked_tick != kNoTick && !s.own.arrived &&
                      TicksBetween(state.last.blocked_tick, s.own.tick) <=
                          TicksCovering(kBlockedFor, options_.tick_period);
  const bool near = fresh && blocker->gap_m < kQueueWithin_m;  // to block it again at once
  if (!recent || !near) state.last.blocked_by = kNoVehicle;
}

Beacon Vehicle::MakeBeacon(const Situation& s) {
  VehicleState& state = *state_;
  ++state.published.seq;
  state.published.gives_way_to = GivesWayTo(s);
  ++state.counters.beacons.sent;
  return {.vehicle = options_.id,
          .boot_epoch = state.published.boot_epoch,
          .seq = state.published.seq,
          // Before its first scan it answers none: it is of no world yet.
          .world_epoch = state.world.tick == kNoTick ? kNoEpoch : state.world.epoch,
          .tick = state.world.tick,
          .wheels = state.motion.wheels,
          .cruise_m_s = options_.cruise_m_s,
          .world_from_body = s.own.world_from_body,
          .covariance = s.own.covariance,
          .body_radius_m = options_.profile.body_radius_m,
          .drive = options_.profile.drive,
          .acceleration_m_s2 = options_.profile.acceleration_m_s2,
          .deceleration_m_s2 = options_.profile.deceleration_m_s2,
          .toward_world = Toward(s.own),
          .mode = state.last.decision.mode,
          .rule = state.last.decision.rule,
          .gives_way_to = state.published.gives_way_to,
          .blocked_by = state.last.blocked_by,
          .order = s.own.order};
}

Outputs Vehicle::Step(const Inputs& inputs) noexcept {
  VehicleState& state = *state_;
  if (inputs.roster) TakeRoster(*inputs.roster, options_, &state);
  change_ = {};
  if (inputs.scan) TakeScan(*inputs.scan, inputs.now);
  TakeFix(inputs);
  TakePeers(inputs);
  TakeSignalsAndObjects(inputs);
  const OwnView own = AssessSelf(inputs);
  const PeersNow near = AssessSurroundings(own);
  const Situation s = BuildSituation(own, near);
  const Action action = Decide(s);
  const bool changed = !SameReason(action.decision, state.last.decision);
  Remember(s, action);
  evidence_ = EvidenceOf(s, action.decision, changed);

  return {.command = {.vehicle = options_.id,
                      .epoch = state.world.epoch,
                      .tick = state.world.tick,
                      .target = action.target,
                      .decision = action.decision,
                      .decision_changed = changed,
                      .task = {state.route.waypoint, state.waiting.waited_ticks}},
          .beacon = MakeBeacon(s),
          .decision_changed = changed};
}

double Vehicle::SpeedMps() const {
  return TwistFromWheels(options_.profile.drive, state_->motion.wheels).forward_m_s;
}

}  // namespace giveway
