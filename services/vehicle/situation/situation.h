// One tick as the rules see it, in stages. Each is completed by one function from those before it,
// and only read from then on: what is not known yet cannot be asked for.
//
//   OwnView     Vehicle::AssessSelf          this vehicle: pose, motion, course, sensors, lights
//   PeersNow    Vehicle::AssessSurroundings  the relevant peers, related to it
//   Movers      DetectMovers                 what moves near and is none of them
//   Escape      Detour                       what to try when it makes no progress
//   Situation   BuildSituation               all of these: what the rules read
#pragma once

#include <array>
#include <optional>
#include <span>

#include "services/types/range_scan.h"
#include "services/types/vehicle_options.h"
#include "services/vehicle/estimation/cones.h"
#include "services/vehicle/estimation/conflict.h"
#include "services/vehicle/estimation/last_heard.h"
#include "services/vehicle/estimation/objects.h"
#include "services/vehicle/estimation/peer_table.h"
#include "services/vehicle/estimation/range_view.h"
#include "services/vehicle/estimation/scan_change.h"
#include "services/vehicle/estimation/signal_table.h"

namespace giveway {

// A peer that may matter.
struct HeardPeer {
  Peer* peer;
  bool fresh;
};

// Carried forward by its wheel speeds to this tick, as it lies to this vehicle: by CarryForward.
struct CarriedPeer : HeardPeer {
  double speed_m_s;  // forward, as measured by the peer
  double turn_rad_s;
  Vec2 position_world;
  Vec2 forward_world;    // unit vector of its heading
  Vec2 offset_world;     // of its centre from the own one
  double distance_m;     // the same
  PoseCovariance apart;  // of where the peer is to this vehicle
  double sigma_m;        // the same along its worst axis
  Vec2 path_world;       // vector from where it is to its next target
  bool path_is_near;     // that path comes within reach of the own path, or may
  // Only if that path is near: its length and its unit vector, or that of the heading where the
  // peer is there already.
  double path_m;
  Vec2 path_direction_world;
};

// Related to the own path and to the right of way, by its beacon and the own state alone: by
// RelatePeers.
struct RelatedPeer : CarriedPeer {
  bool lost;
  bool standing;      // below kStandingSpeed_m_s
  bool has_priority;  // before this vehicle, by both keys as published
  bool believed;      // fresh and not doubted
  bool grants;        // believed, and says that it gives way to this vehicle or stays where it is
  bool at_signal;     // believed, and says that a light stops it
  bool leads;         // drives ahead in the own lane
  double gap_m;       // shell to shell
  double gate_gap_m;  // the same by the metric of the gates; never above gap_m
  // Straight on until the own shell is at the peer's claim; huge if never, or so far on that the
  // own cruise speed is not too fast for it.
  double free_m;
  std::uint32_t explains;  // bit i: the echo of sensor i is where this peer's body should be
  std::optional<Conflict> conflict;  // as `crossing`, where it is a matter of right of way
  std::optional<Conflict> crossing;  // of both paths, independent of the right of way
};

// What this vehicle knows of one peer, all of it: with what follows from all peers together, by
// FindBoxes.
struct PeerView : RelatedPeer {
  double box_begin_m;  // of `crossing`: how far to drive without blocking any
};
static_assert(sizeof(PeerView) <= 336);  // a step makes up to a thousand: they must not grow

// Views in the making. They are made where they stay, a part of all of them at a time: copying one
// costs as much as making it. `Part` is the last that is made; only the function that makes the
// next part sees them.
template <typename Part>
class PeerViews {
 public:
  explicit PeerViews(std::span<PeerView> views) : views_(views) {}
  std::span<PeerView> ToMakeTheNextPart() const { return views_; }

 private:
  std::span<PeerView> views_;
};

// The echoes that the sensors hold, `count` of them.
struct HeardEchoes {
  std::size_t count = 0;
  std::array<double, kSensorCount> age_s;
  std::array<std::size_t, kSensorCount> sensor;
};

// The middles of cells of the obstacle grid that count, in the body frame: see heard_places.h.
struct HeardPlaces {
  std::size_t count = 0;
  std::array<Vec2, 1024> of;

  std::span<const Vec2> All() const { return {of.data(), count}; }
};

// A box that would be left too late: see box.h.
struct BlockedBox {
  double begin_m = 0;  // from the own axle centre, along the own path; above 0
  VehicleId by = kNoVehicle;
  Tick beacon_tick = kNoTick;  // of the beacon that shows it
};

// When it is, and what the step was called with.
struct Moment {
  SteadyTime now{0};
  Tick tick = kNoTick;
  bool new_tick = false;  // a scan came since the last step
  RunState run_state = RunState::kWaiting;
  bool leaving = false;
  bool halting = false;
};

// Where the vehicle takes itself to be.
struct OwnPose {
  Pose world_from_body;
  Vec2 forward_world;         // unit vector of the own heading
  PoseCovariance covariance;  // of world_from_body
  double known_share = 1;  // of the cruise speed that it may drive, by how well it knows its pose
  bool lost = false;       // it does not know well enough where it is
};

// How it moves, and how far that reaches.
struct OwnMotion {
  double speed_m_s = 0;   // forward, measured
  double turn_rad_s = 0;  // measured
  WheelSpeeds wheels;     // measured
  double reaction_s = 0;  // see ReactionSeconds
  double slows_m = 0;     // a free path no longer than this is too short for the cruise speed
  double sweeps_m = 0;    // see OwnSweep
  double interest_radius_m = 0;  // see InterestRadius
  bool turns = false;            // sharply, or did just now: echoes do not show which of both moves
};

// A one-lane section that the own path leads through or into, or that this vehicle is in.
struct LaneAhead {
  const OneLane* lane;
  Stretch own;   // of the own path
  bool forward;  // from the first end of the lane to its second
};

// The nearest of them: see one_lane.h.
struct LanesAhead {
  std::array<LaneAhead, 4> of;  // the first `count`
  std::size_t count = 0;

  std::span<const LaneAhead> All() const { return {of.data(), count}; }
};

// Where it drives to.
struct OwnCourse {
  Path path;                      // towards the goal, or straight on
  double path_rad = 0;            // the heading along it, world frame
  double distance_to_goal_m = 0;  // or to the next waypoint; kFar_m without either
  bool stops_there = false;       // at the goal; a waypoint is driven through
  bool arrived = false;
  LanesAhead lanes;
};

// What its sensors hold.
struct SensorsNow {
  const RangeView& ranges;
  const ScanChange& change;   // by the scan of this step
  const HeardEchoes& echoes;  // in `ranges`
  const Cones& cones;
  const SeenObjects& objects;
  int blind_sensor = -1;  // see RangeView::FirstBlind
};

// What traffic lights ask of it.
struct Lights {
  std::optional<StopLine> stop_line;  // a light ahead that says stop
  bool at_signal = false;             // a light stops this vehicle, as last published
};

// The first stage: this vehicle, as estimation has it. Nothing of any single peer.
struct OwnView : Moment, OwnPose, OwnMotion, OwnCourse, SensorsNow, Lights {
  const VehicleOptions& options;
  PriorityKey order;   // as it publishes it with this step
  int steer_side = 0;  // the side of the last turn past something: 1 left, -1 right
};

// What encounters ask for, all of them together: see encounter.h.
struct Encounters {
  bool holds = false;     // this vehicle holds for any of them
  bool let_pass = false;  // one with a peer that comes first is over, just now
  bool meets = false;     // one is active
};

// The second stage: the peers, and what follows from all of them together.
struct PeersNow {
  // Those that are near, that cross the own path, or with which an encounter is active.
  std::span<const PeerView> peers;
  std::uint32_t explained = 0;        // union of the `explains` of peers it is believed of
  bool someone_lost = false;          // of all peers
  bool someone_doubted = false;       // of `peers`
  const PeerView* unheard = nullptr;  // neither by radio nor by its echo: see sonar_trust.h
  std::optional<BlockedBox> blocked_box;
  Encounters encounters;
};

// What moves by itself near the vehicle.
struct Movers {
  bool unidentified = false;  // something near moves and no fresh beacon explains it
  int unidentified_sensor = -1;
};

// What a vehicle does when it makes no progress towards its target.
struct Escape {
  bool no_progress = false;          // has driven about for seconds without coming nearer
  bool long_no_progress = false;     // for so long that it does not stay in line any more
  std::optional<Vec2> detour_world;  // where to go first, instead of straight to the goal
  // World frame: chosen recently, to get past echoes or out of where it is stuck. Echoes turn with
  // the vehicle: a new choice each tick would make it oscillate.
  std::optional<double> away_rad;
  int escape_attempts = -1;  // headings tried since it got stuck at this place; -1: not stuck
};

// The last stage, what the rules read: both before, and what follows from both.
struct Situation {
  const OwnView& own;
  const PeersNow& near;
  Movers movers;
  std::span<const Vec2> places{};  // where something was heard: see heard_places.h
  Escape escape;
  LastHeard last_heard;  // of lecture_printed alone, which has no peers
};

// Below this a vehicle stands still, as the verdict defines it.
inline constexpr double kStandingSpeed_m_s = 0.01;
// Nearer to its target than this, the direction to it says little.
inline constexpr double kAtTarget_m = 0.05;
// Turning no faster, it drives straight on or stands.
inline constexpr double kTurning_rad_s = 0.02;
// Kept between two shells beyond what geometry and uncertainty ask for.
inline constexpr double kPassingMargin_m = 0.2;
// Between two bodies that are not to meet, on top of what is not known.
inline constexpr double kBodiesMargin_m = 0.1;
// Kept from a claim on top of the uncertainty: steering bends the straight path a little.
inline constexpr double kClearance_m = 0.05;
// Left between where the vehicle stops and where it must have stopped.
inline constexpr double kInHand_m = 0.03;

// From seeing to braking: the decision of tick k acts from tick k+1 on, on a view one tick old, of
// readings that may be older by the ultrasonics' refresh.
inline double ReactionSeconds(const VehicleOptions& options) {
  return 2 * Seconds(options.tick_period) + Seconds(options.sonar_refresh);
}

// Distance this vehicle needs to stand still from its present speed, with one tick in hand.
double OwnStoppingDistance(const OwnView& s);

// How far from its straight stopping path this vehicle may end, turning as it does now, with a
// heading that is not known better than the covariance says.
double OwnSweep(const OwnMotion& s, const PoseCovariance& covariance,
                const VehicleOptions& options);

// Distance the peer needs to stand still from its present speed, by what it says of its brakes.
double StoppingDistanceOf(const CarriedPeer& view, const OwnView& s);

// The distance, shell to shell, at which two closing vehicles must start to stop: both stopping
// distances, margin and uncertainty; never below the gate.
double CriticalDistance(const OwnView& s, const CarriedPeer& view);

// A point given in the world, in the own body frame.
inline Vec2 InBody(const OwnView& s, Vec2 point_world) {
  const Vec2 offset = point_world - s.world_from_body.position_world;
  return {Dot(s.forward_world, offset), Cross(s.forward_world, offset)};
}

// How far the two axle centres keep apart when one steers round the other.
double RoomBeside(const CarriedPeer& view, const OwnView& s);

// The point that the vehicle drives straight to; without a goal straight ahead, beyond the range of
// any computation; its own place if it has arrived.
Vec2 Toward(const OwnView& s);

// True if the own body covers the peer's target, so that the peer cannot stand there.
bool IsOnGoalOf(const CarriedPeer& view, const OwnView& s);

// True if the peer's body covers that point, so that this vehicle cannot stand there.
bool Occupies(const CarriedPeer& view, Vec2 point_world, const OwnView& s);

// The velocity of a peer where it is now.
Vec2 VelocityOf(const CarriedPeer& view);

// How fast the gap to a peer shrinks.
double ClosingSpeed(const CarriedPeer& view, const OwnView& s);

}  // namespace giveway
