#include "services/vehicle/situation.h"

#include <algorithm>

#include "services/types/math.h"
#include "services/vehicle/claim.h"
#include "services/vehicle/echoes.h"

namespace giveway {
namespace {

constexpr double kFarAway_m = 1e6;
constexpr double kLongestWay_m = 1000;

// A peer that will not move by itself stands where it is: an obstacle to steer round, not a path.
bool StaysPut(const Beacon& beacon) {
  return beacon.rule == Rule::kArrived || beacon.rule == Rule::kNotRunning;
}

// How near the two centres may come: both bodies, a margin, and what is not known for sure.
double Reach(const PeerView& view, const Situation& s) {
  const Beacon& beacon = view.peer->beacon;
  return s.options.profile.body_radius_m + beacon.body_radius_m + kPassingMargin_m +
         2 * (s.sigma_position_m + beacon.sigma_position_m);
}

// True if one drives behind the other in the same lane: that is a matter of distance, not of right
// of way. Side by side, or coming from another lane, it is not following.
bool Follows(const PeerView& view, const Situation& s) {
  constexpr double kSameWay = 0.94;  // the cosine of 20 degrees
  if (Dot(s.path.direction_world, view.forward_world) < kSameWay) return false;
  const Vec2 offset = view.world_from_body.position_world - s.world_from_body.position_world;
  const double along = Dot(s.path.direction_world, offset);
  const double across = Cross(s.path.direction_world, offset);
  const double bodies = s.options.profile.body_radius_m + view.peer->beacon.body_radius_m;
  const bool same_lane = across < bodies && across > -bodies;
  return same_lane && (along > bodies || along < -bodies);
}

// By both keys as published. Whom a light stops comes after whom none does, as long as it says so:
// it stands before its line, and would only block the ones with green.
bool ComesFirst(const PeerView& view, const Situation& s) {
  if (view.at_signal != s.at_signal) return s.at_signal;
  return giveway::ComesFirst(view.peer->beacon.order, view.peer->id, s.order, s.options.id);
}

// The light's word counts only while the peer could still keep it: it stands, or can stop before
// the conflict. Of two that lights stopped until now neither may count on the other's.
bool WaitsAtSignal(const PeerView& view, const Situation& s) {
  if (!view.at_signal || s.at_signal) return false;
  const double stopping_m =
      StoppingDistance(std::max(0.0, view.speed_m_s), ReactionSeconds(s.options),
                       s.options.profile.deceleration_m_s2);
  return view.standing || !view.conflict || view.conflict->peer.begin_m >= stopping_m;
}

// Both vehicles' ways to where they drive next. A peer that stays put has none.
std::optional<Conflict> CrossingWith(const PeerView& view, const Situation& s) {
  if (StaysPut(view.peer->beacon) || Follows(view, s)) return std::nullopt;
  const bool cooperative = s.options.behaviour == Behaviour::kCooperative;
  Path peer_path{view.world_from_body.position_world, view.forward_world};
  double peer_way_m = kFarAway_m;
  if (cooperative) {
    const Vec2 way = view.peer->beacon.toward_world - peer_path.from_world;
    peer_way_m = Norm(way);
    if (peer_way_m > 0.05) peer_path.direction_world = (1 / peer_way_m) * way;
  }
  auto conflict = FindConflict(s.path, peer_path, Reach(view, s));
  if (!conflict || conflict->own.begin_m > s.distance_to_goal_m) return std::nullopt;
  if (conflict->peer.begin_m > peer_way_m) return std::nullopt;
  return conflict;
}

// Of one that was silent for longer nothing can be said; the ultrasonics and PeerLost see to it.
constexpr double kClaimLasts_s = 1.0;
// Kept from a claim on top of what is not known: steering bends the straight way a little.
constexpr double kClearance_m = 0.05;

// The claim stands on the beacon itself, not on where the peer is thought to be now. What it may
// have done since is unknown up to the end of the tick that this decision moves.
double FreeOf(const PeerView& view, const Situation& s) {
  const Beacon& beacon = view.peer->beacon;
  if (view.peer->out_of_reach || view.peer->left) return kFarAway_m;
  const double unknown_s = Seconds((TicksBetween(beacon.tick, s.tick) + 1) * s.options.tick_period);
  if (unknown_s > kClaimLasts_s) return kFarAway_m;
  const Claim claim =
      ClaimOf(beacon, Forward(beacon.world_from_body), unknown_s, ReactionSeconds(s.options));
  const double apart_m = s.options.profile.body_radius_m + kClearance_m +
                         2 * (s.sigma_position_m + beacon.sigma_position_m);
  return FreeBefore(claim, {s.world_from_body.position_world, s.forward_world}, apart_m);
}

}  // namespace

double ReactionSeconds(const VehicleOptions& options) {
  return 2 * Seconds(options.tick_period) + Seconds(options.sonar_refresh);
}

double OwnStoppingDistance(const Situation& s) {
  const double speed = std::max(0.0, s.speed_m_s);
  constexpr double kInHand_m = 0.03;
  return StoppingDistance(speed, ReactionSeconds(s.options) + Seconds(s.options.tick_period),
                          s.options.profile.deceleration_m_s2) +
         kInHand_m;
}

double CriticalDistance(const Situation& s, const PeerView& view) {
  const double reaction = ReactionSeconds(s.options);
  const double braking = s.options.profile.deceleration_m_s2;
  constexpr double kMargin_m = 0.1;
  const double both = StoppingDistance(std::max(0.0, s.speed_m_s), reaction, braking) +
                      StoppingDistance(std::max(0.0, view.speed_m_s), reaction, braking);
  const double uncertainty = 2 * (s.sigma_position_m + view.peer->beacon.sigma_position_m);
  return std::max(s.options.gate_enter_m, both + kMargin_m + uncertainty);
}

Vec2 InBody(const Situation& s, Vec2 point_world) {
  const Vec2 offset = point_world - s.world_from_body.position_world;
  return {Dot(s.forward_world, offset), Cross(s.forward_world, offset)};
}

double RoomBeside(const PeerView& view, const Situation& s) {
  constexpr double kRoundMargin_m = 0.15;  // between the two shells
  return s.options.profile.body_radius_m + view.peer->beacon.body_radius_m + kRoundMargin_m;
}

Vec2 Toward(const Situation& s) {
  if (s.arrived) return s.world_from_body.position_world;
  const double way_m = std::min(s.distance_to_goal_m, kLongestWay_m);
  return s.world_from_body.position_world + way_m * s.path.direction_world;
}

bool Occupies(const PeerView& view, Vec2 point_world, const Situation& s) {
  const double room_m =
      s.options.profile.body_radius_m + view.peer->beacon.body_radius_m + kPassingMargin_m;
  return SquaredNorm(view.world_from_body.position_world - point_world) < room_m * room_m;
}

bool IsOnGoalOf(const PeerView& view, const Situation& s) {
  const Beacon& beacon = view.peer->beacon;
  const double room_m = s.options.profile.body_radius_m + beacon.body_radius_m + kPassingMargin_m;
  return SquaredNorm(beacon.toward_world - s.world_from_body.position_world) < room_m * room_m;
}

PeerView LookAt(Peer* peer, const Situation& s) {
  PeerView view{.peer = peer};
  const Beacon& beacon = peer->beacon;
  const Twist twist = TwistFromWheels(beacon.drive, beacon.wheels);
  view.fresh = IsFresh(*peer, s.now, s.tick, s.options);
  view.lost = IsLost(*peer, s.now, s.tick, s.options);
  // A silent peer is left where it was last heard: what it did since is not known.
  const double ahead_s =
      view.fresh ? Seconds(TicksBetween(beacon.tick, s.tick) * s.options.tick_period) : 0;
  view.world_from_body = AdvanceArc(beacon.world_from_body, twist, ahead_s);
  view.forward_world = Forward(view.world_from_body);
  view.speed_m_s = twist.forward_m_s;
  view.standing = twist.forward_m_s < kStandingSpeed_m_s && twist.forward_m_s > -kStandingSpeed_m_s;
  const bool knows_lights = s.options.behaviour == Behaviour::kCooperative;
  view.at_signal = knows_lights && view.fresh && beacon.rule == Rule::kSignal;
  view.goes_first = ComesFirst(view, s);

  const Vec2 offset = view.world_from_body.position_world - s.world_from_body.position_world;
  const double distance = Norm(offset);
  const double gate_distance = GateDistance(s.options.distance_metric, offset);
  view.gap_m = distance - s.options.profile.body_radius_m - beacon.body_radius_m;
  view.gate_gap_m = gate_distance - s.options.profile.body_radius_m - beacon.body_radius_m;
  const Vec2 velocity = view.speed_m_s * view.forward_world - s.speed_m_s * s.forward_world;
  view.closing_m_s = distance > 0 ? -Dot(offset, velocity) / distance : 0;
  view.leads = Follows(view, s) && Dot(offset, s.path.direction_world) > 0;
  view.crossing = CrossingWith(view, s);
  // One that stands and comes later in the order is a body to steer round.
  const bool steered_round = s.options.behaviour == Behaviour::kCooperative && view.standing;
  if (!steered_round || view.goes_first) view.conflict = view.crossing;
  view.free_m = FreeOf(view, s);
  const bool halted = view.standing && IsGiveWay(beacon.rule) && !view.goes_first;
  view.grants = view.fresh && (beacon.gives_way_to == s.options.id || StaysPut(beacon) || halted ||
                               WaitsAtSignal(view, s));
  if (view.fresh) {
    view.explains = EchoesOf(view.world_from_body.position_world,
                             view.speed_m_s * view.forward_world, beacon.body_radius_m, s);
  }
  return view;
}

}  // namespace giveway
