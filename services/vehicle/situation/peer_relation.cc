#include "services/vehicle/situation/peer_relation.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/vehicle/estimation/injected_mutants.h"
#include "services/vehicle/situation/claim.h"
#include "services/vehicle/situation/echoes.h"
#include "services/vehicle/situation/one_lane.h"

namespace giveway {
namespace {

// A peer that will not move by itself stands where it is: an obstacle to steer round, not a path.
bool StaysPut(const Beacon& beacon) {
  if (MutantActive(Mutant::kArrivedClaimsWay)) return false;
  return StaysPut(beacon.rule);
}

// Uncertainty of the offset to a peer that was carried forward by a displacement since its beacon.
PoseCovariance Apart(const Beacon& beacon, Vec2 path_world, const OwnView& s) {
  return s.covariance + Carried(beacon.covariance, path_world);
}

// At least as much as the above can be along any axis, for a fraction of the price.
double SigmaAtMost(const Beacon& beacon, double moved_m, const OwnView& s) {
  const PoseCovariance both = s.covariance + beacon.covariance;
  const double trace_m2 = both.xx_m2 + both.yy_m2;
  return (trace_m2 > 0 ? Sqrt(trace_m2) : 0) + moved_m * SigmaHeading(beacon.covariance);
}

// How near the two centres may come: both bodies, a margin, and what is not known for sure.
double Reach(const Beacon& beacon, double sigma_m, const OwnView& s) {
  return s.options.profile.body_radius_m + beacon.body_radius_m + kBodiesMargin_m +
         kSigmas * sigma_m;
}

// True if one drives behind the other in the same lane: then distance decides, not right of way.
// Side by side, or coming from another lane, it is not following.
bool Follows(const CarriedPeer& view, bool standing, const OwnView& s) {
  if (MutantActive(Mutant::kLeaderIsConflict)) return false;
  constexpr double kSameDirection = 0.94;  // the cosine of 20 degrees
  constexpr double kThereAlready_m = 0.5;  // nearer to its target its direction says little
  const double across = Cross(s.path.direction_world, view.offset_world);
  const double bodies = s.options.profile.body_radius_m + view.peer->beacon.body_radius_m;
  if (across >= bodies || across <= -bodies) return false;
  const double along = Dot(s.path.direction_world, view.offset_world);
  if (along <= bodies && along >= -bodies) return false;
  if (Dot(s.path.direction_world, view.forward_world) >= kSameDirection) return true;
  // A standing peer may be turned anywhere, looking for a path past something; it will resume.
  if (s.options.behaviour != Behaviour::kCooperative || !standing) return false;
  const double path_m = Norm(view.path_world);
  return path_m > kThereAlready_m &&
         Dot(s.path.direction_world, view.path_world) >= kSameDirection * path_m;
}

// Compares the published priority keys. A vehicle stopped at a red light yields to one that is not:
// it could only block traffic that has green.
bool PeerHasPriority(const HeardPeer& view, bool at_signal, const OwnView& s) {
  if (at_signal != s.at_signal) return s.at_signal;
  const PriorityKey& peers = view.peer->beacon.order;
  if (MutantActive(Mutant::kPriorityReversed)) return PrecedesByKey(s.order, peers);
  const bool tie =
      s.order.waited_ticks == peers.waited_ticks && s.order.speed_bucket == peers.speed_bucket;
  if (tie && MutantActive(Mutant::kTieYieldsBoth)) return true;
  if (tie && MutantActive(Mutant::kTieFreesBoth)) return false;
  return giveway::HasPriority(peers, view.peer->id, s.order, s.options.id);
}

// A red light counts only while the peer can still stop for it: it stands, or can stop before the
// conflict. Two vehicles that were both at a red light until now may not count on each other's.
bool WaitsAtSignal(const RelatedPeer& view, const OwnView& s) {
  if (!view.at_signal || s.at_signal) return false;
  return view.standing || !view.conflict ||
         view.conflict->peer.begin_m >= StoppingDistanceOf(view, s);
}

// False if no point of the peer's path comes within reach_m of the own path.
bool MayComeNear(Vec2 from_world, Vec2 to_world, double reach_m, const Path& own) {
  const Vec2 from = from_world - own.from_world;
  const Vec2 to = to_world - own.from_world;
  const double from_across_m = Cross(own.direction_world, from);
  const double to_across_m = Cross(own.direction_world, to);
  if (from_across_m > reach_m && to_across_m > reach_m) return false;
  if (from_across_m < -reach_m && to_across_m < -reach_m) return false;
  return !(Dot(own.direction_world, from) < -reach_m && Dot(own.direction_world, to) < -reach_m);
}

// Out of reach by this margin holds however it is rounded, and in whatever direction the peer turns
// at its target.
constexpr double kWellAway_m = 2 * kAtTarget_m + 0.001;

// Where the paths of both vehicles to their next targets cross, if neither follows the other.
void FindCrossing(RelatedPeer* view, const OwnView& s) {
  const bool cooperative = s.options.behaviour == Behaviour::kCooperative;
  if (!view->path_is_near) return;
  const double reach_m = Reach(view->peer->beacon, view->sigma_m, s);
  const double path_m = cooperative ? view->path_m : kFar_m;
  const Path peer_path{view->position_world,
                       cooperative ? view->path_direction_world : view->forward_world};
  const auto conflict = FindConflict(s.path, peer_path, reach_m);
  if (!conflict || conflict->own.begin_m > s.distance_to_goal_m) return;
  if (conflict->peer.begin_m > path_m) return;
  view->crossing = conflict;
}

// How long a peer may have moved freely by the time that the motion decided now has ended.
double UnknownSeconds(const Beacon& beacon, const OwnView& s) {
  return Seconds((TicksBetween(beacon.tick, s.tick) + 1) * s.options.tick_period);
}

// The clearance that the centre of this vehicle keeps from a claim.
double ApartFrom(double sigma_m, const OwnView& s) {
  return s.options.profile.body_radius_m + kClearance_m + s.sweeps_m + kSigmas * sigma_m;
}

// At this distance the centre of this vehicle surely clears a claim without length, with a margin.
double KeptFrom(const Beacon& beacon, double sigma_m, const OwnView& s) {
  return ApartFrom(sigma_m, s) + beacon.body_radius_m + kWellAway_m;
}

// True if the claim lies too far away to slow this vehicle down: a claim reaches no further than
// its length and is no wider than that and the body.
bool IsClaimFar(const Beacon& beacon, double speed_m_s, double sigma_m, double unknown_s,
                const OwnView& s) {
  const double length_m =
      ClaimLength(beacon, Magnitude(speed_m_s) + kTurnWhileDriving_rad_s * beacon.drive.axle_m / 4,
                  unknown_s, s.reaction_s) +
      TurnRollsOn(kTurnWhileDriving_rad_s, beacon.drive.axle_m, beacon.deceleration_m_s2);
  const double far_m = s.slows_m + KeptFrom(beacon, sigma_m, s) + 2 * length_m;
  const Vec2 offset = beacon.world_from_body.position_world - s.world_from_body.position_world;
  return SquaredNorm(offset) > far_m * far_m;
}

// Beyond this, shell to shell, only claims and paths are computed: detours and echoes of the
// ultrasonics are nearer, objects of radar and lidar may be this far.
constexpr double kInterestRadius_m = 8;
constexpr double kSeesFar_m = 25;

// For how long a peer is carried forward since its beacon, as views carry it forward.
double CarriedSeconds(const Beacon& beacon, bool fresh, const OwnView& s) {
  // A silent peer is left where it was last heard: what it did since is not known.
  return fresh ? Seconds(TicksBetween(beacon.tick, s.tick) * s.options.tick_period) : 0;
}

// How far away it is, how certain that is, and where it drives from there.
void Measure(CarriedPeer* measured, const OwnView& s) {
  CarriedPeer& view = *measured;
  const Beacon& beacon = view.peer->beacon;
  view.offset_world = view.position_world - s.world_from_body.position_world;
  view.distance_m = Norm(view.offset_world);
  view.path_world = beacon.toward_world - view.position_world;
  view.apart = Apart(beacon, view.position_world - beacon.world_from_body.position_world, s);
  view.sigma_m = SigmaPosition(view.apart);
  const double well_away_m = Reach(beacon, view.sigma_m, s) + kWellAway_m;
  view.path_is_near = s.options.behaviour != Behaviour::kCooperative ||
                      MayComeNear(view.position_world, beacon.toward_world, well_away_m, s.path);
  if (!view.path_is_near) return;
  view.path_m = Norm(view.path_world);
  view.path_direction_world =
      view.path_m > kAtTarget_m ? (1 / view.path_m) * view.path_world : view.forward_world;
}

}  // namespace

double InterestRadius(const RobotModel& profile) {
  const bool sees_far =
      profile.radar || profile.lidar || profile.camera || profile.sonar_max_range_m > 5;
  return (sees_far ? kSeesFar_m : kInterestRadius_m) + profile.body_radius_m;
}

// The claim stands on the beacon itself, not on where the peer is thought to be now. What it may
// have done since is unknown up to the end of the tick that this decision moves.
double FreeAlong(const CarriedPeer& view, Vec2 forward_world, const OwnView& s) {
  const Beacon& beacon = view.peer->beacon;
  if (IsGone(*view.peer)) return kFar_m;
  const double unknown_s = UnknownSeconds(beacon, s);
  if (unknown_s > Seconds(ClaimLasts(s.options)) ||
      IsClaimFar(beacon, view.speed_m_s, view.sigma_m, unknown_s, s)) {
    return kFar_m;
  }
  const Claim claim =
      ClaimOf(beacon, {view.peer->stated_heading.forward_world, view.speed_m_s, view.turn_rad_s},
              unknown_s, s.reaction_s);
  return FreeBefore(claim, {s.world_from_body.position_world, forward_world},
                    ApartFrom(view.sigma_m, s));
}

bool IsRelevant(const Peer& peer, bool fresh, const OwnView& s) {
  if (s.options.behaviour != Behaviour::kCooperative || peer.encounter.active) return true;
  const Beacon& beacon = peer.beacon;
  const double speed_m_s = TwistFromWheels(beacon.drive, beacon.wheels).forward_m_s;
  const double moved_m = CarriedSeconds(beacon, fresh, s) * Magnitude(speed_m_s);
  const Vec2 from_world = beacon.world_from_body.position_world;
  const double near_m = s.interest_radius_m + beacon.body_radius_m + moved_m;
  if (SquaredNorm(from_world - s.world_from_body.position_world) <= near_m * near_m) return true;
  if (MayMeetInOneLane(beacon, moved_m, s)) return true;
  const double sigma_m = SigmaAtMost(beacon, moved_m, s);
  const double reach_m = Reach(beacon, sigma_m, s) + moved_m + kWellAway_m;
  if (MayComeNear(from_world, beacon.toward_world, reach_m, s.path)) return true;
  const double short_m = (near_m - s.slows_m - KeptFrom(beacon, sigma_m, s)) / 2;
  return !IsClaimShort(beacon, speed_m_s, Seconds(ClaimLasts(s.options)), s.reaction_s, short_m) &&
         !IsClaimFar(beacon, speed_m_s, sigma_m, UnknownSeconds(beacon, s), s);
}

PeerViews<CarriedPeer> CarryForward(PeerViews<HeardPeer> heard, const OwnView& s) {
  const std::span<PeerView> views = heard.ToMakeTheNextPart();
  for (const HeardPeer& view : views)
    view.peer->stated_heading.Follow(view.peer->beacon.world_from_body);
  for (CarriedPeer& view : views) {
    const Beacon& beacon = view.peer->beacon;
    const Facing stated = {beacon.world_from_body.position_world,
                           view.peer->stated_heading.forward_world};
    const Twist twist = TwistFromWheels(beacon.drive, beacon.wheels);
    const Facing now = AdvanceFacing(stated, twist, CarriedSeconds(beacon, view.fresh, s));
    view.speed_m_s = twist.forward_m_s;
    view.turn_rad_s = twist.turn_rad_s;
    view.position_world = now.position_world;
    view.forward_world = now.forward_world;
  }
  for (CarriedPeer& view : views) Measure(&view, s);
  return PeerViews<CarriedPeer>(views);
}

namespace {

void Relate(RelatedPeer* related, const OwnView& s) {
  RelatedPeer& view = *related;
  const Beacon& beacon = view.peer->beacon;
  view.believed = view.fresh && !IsDoubted(view.peer->trust, s.now);
  const bool cooperative = s.options.behaviour == Behaviour::kCooperative;
  const PeerEchoes echoes = view.fresh ? EchoesOf(view, s) : PeerEchoes{};
  view.explains = echoes.sensors;
  // What both poses may be off by counts once: an echo that is nearer by it is no other body's.
  if (cooperative) view.sigma_m = std::max(view.sigma_m, echoes.nearer_m / kSigmas);
  view.lost = IsLost(*view.peer, view.fresh);
  view.standing = Magnitude(view.speed_m_s) < kStandingSpeed_m_s;
  view.at_signal = cooperative && view.believed && beacon.rule == Rule::kSignal;
  view.has_priority = PeerHasPriority(view, view.at_signal, s);

  const double radius_m = s.options.profile.body_radius_m;
  view.gap_m = view.distance_m - radius_m - beacon.body_radius_m;
  const DistanceMetric metric = s.options.distance_metric;
  const double gate_m = metric == DistanceMetric::kEuclidean
                            ? view.distance_m
                            : GateDistance(metric, view.offset_world);
  view.gate_gap_m = gate_m - radius_m - beacon.body_radius_m;
  // One that has arrived does not move, whatever its heading: no vehicle queues behind it. Nor
  // behind one that has left, which has no path to cross either.
  const bool goes_on = !StaysPut(beacon) && !IsGone(*view.peer);
  if (goes_on) view.crossing = FindOneLaneConflict(view, s);
  const bool one_lane = view.crossing.has_value();
  const bool follows = goes_on && !one_lane && Follows(view, view.standing, s);
  view.leads = follows && Dot(view.offset_world, s.path.direction_world) > 0;
  if (goes_on && !one_lane && !follows) FindCrossing(&view, s);
  // One that stands and comes later in the order is a body to steer round, if not in a one-lane
  // section.
  const bool stands = view.standing && (view.believed || !view.fresh);
  const bool steered_round = cooperative && stands && !view.has_priority && !one_lane;
  if (!steered_round) view.conflict = view.crossing;
  view.free_m = FreeAlong(view, s.forward_world, s);
  // It stands, comes later in the order and says so: it gives way to any that comes first. Before a
  // one-lane section it need not say so, for it stops there again.
  const bool halts = view.standing && !view.has_priority && (one_lane || IsGiveWay(beacon.rule));
  view.grants = view.believed && (beacon.gives_way_to == s.options.id || StaysPut(beacon) ||
                                  halts || WaitsAtSignal(view, s));
}

}  // namespace

RelatedPeers RelatePeers(PeerViews<CarriedPeer> carried, const OwnView& s) {
  const std::span<PeerView> views = carried.ToMakeTheNextPart();
  RelatedPeers related{.views = PeerViews<RelatedPeer>(views)};
  for (PeerView& view : views) {
    Relate(&view, s);
    related.someone_doubted = related.someone_doubted || (view.fresh && !view.believed);
    // An echo near a doubted peer counts as unexplained; the lecture's behaviours keep the same
    // distance from a known body as from an unknown one.
    const bool explains = view.believed || s.options.behaviour != Behaviour::kCooperative;
    related.explained |= explains ? view.explains : 0;
  }
  return related;
}

}  // namespace giveway
