// Everything a brain remembers from one step to the next, by what writes it. Trivially copyable: a
// snapshot is a copy. What one step makes of it is a Situation (situation/situation.h).
//
//   world      which it is in: TakeRoster, TakeScan
//   motion     its own pose: TakeScan, TakeFix, and AssessOwnPose whether it is lost
//   sensed     its own sensors: TakeScan, TakeSignalsAndObjects, RememberEchoes, JudgeSonar
//   heard      peers and lights: TakePeers, TakeSignalsAndObjects, and AssessSurroundings what it
//              has with each peer
//   route      how far along it is: UpdatePath
//   progress   whether it gets nearer: UpdatePath, Detour, Remember
//   waiting    its place in the order: KeepOrder
//   movers     unexplained ones: NoteTurning, DetectMovers
//   last       what it decided: Remember
//   published  its last beacon: MakeBeacon
//   counters   what was refused or distrusted: by all that refuse or distrust
// EnterWorld, and a roster or handover that says how far its task was, set back what is of a place.
#pragma once

#include <cstdint>

#include "services/types/counters.h"
#include "services/types/decision.h"
#include "services/types/fleet_facts.h"
#include "services/types/math/pose.h"
#include "services/vehicle/estimation/last_heard.h"
#include "services/vehicle/estimation/objects.h"
#include "services/vehicle/estimation/obstacle_grid.h"
#include "services/vehicle/estimation/odometry.h"
#include "services/vehicle/estimation/peer_table.h"
#include "services/vehicle/estimation/pose_keeping.h"
#include "services/vehicle/estimation/range_view.h"
#include "services/vehicle/estimation/signal_table.h"
#include "services/vehicle/situation/sonar_trust.h"

namespace giveway {

// What its beacons continue from: which life they are of, and what the last one said.
struct Published {
  std::uint32_t boot_epoch = 0;
  std::uint32_t seq = 0;
  VehicleId gives_way_to = kNoVehicle;
};

// The world it is in, and the tick of the scan last taken.
struct InWorld {
  WorldEpoch epoch = kNoEpoch;
  WorldEpoch placed_in = kNoEpoch;  // the epoch of the last roster entry that said where it stands
  Tick tick = kNoTick;
  RunState run_state = RunState::kWaiting;
};

// Where it takes itself to be, and what that was made from.
struct MeasuredMotion {
  Odometry odometry;
  PoseKeeping pose;
  Tick pose_tick = kNoTick;  // the tick of odometry's pose; kNoTick: the one before the next scan
  WheelSpeeds wheels;        // as last measured
  WheelAngles counted;       // by the encoders, as last heard
};

// By its own sensors.
struct Sensed {
  RangeView ranges;
  ObstacleGrid grid;  // of imperfect ultrasonics
  SeenObjects objects;
  SonarDoubt doubt;
};

// By radio. An encounter with a peer is remembered with the peer: estimation/peer_table.h.
struct Heard {
  PeerTable peers;
  SignalTable signals;
  LastHeard last_heard;  // of lecture_printed
};

// How far along its route it is.
struct RouteProgress {
  std::uint32_t waypoint = 0;  // the next one of the route; its count: on to the goal
  bool arrived = false;
  CachedBearing bearing;  // to where it drives next
};

// Whether it gets nearer to where it drives, and what it does where it does not.
struct GoalProgress {
  double nearest_m = 1e9;               // the least distance to the goal so far
  std::uint32_t no_progress_ticks = 0;  // driven since without coming nearer
  Vec2 detour_world;                    // where the detour leads first, if detour_tick is set
  Tick detour_tick = kNoTick;           // when it was looked for
  double away_rad = 0;            // the heading taken from what stopped it, if away_tick is set
  Tick away_tick = kNoTick;       // when it was taken
  Vec2 stuck_world;               // where it has been stuck since
  std::uint32_t stuck_ticks = 0;  // for how long, not counting where it waits or queues
};

// Its place in the order, and the waiting that moves it up.
struct Waiting {
  PriorityKey order;
  std::uint32_t waited_ticks = 0;  // halted to give way, before the conflict it is not through yet
  Vec2 waited_world;               // where it halted last
  bool let_pass = false;           // a peer with priority has passed since it waits
};

// Whether something near moves that no fresh beacon explains.
struct MoverWatch {
  bool unidentified = false;
  int unidentified_sensor = -1;
  SteadyTime unidentified_since{0};  // last time something near moved unexplained
  Tick turned_tick = kNoTick;        // when it last turned sharply
};

// What the last step decided.
struct LastStep {
  Tick decided_tick = kNoTick;  // of that step
  Decision decision;
  int steer_side = 0;                 // 1 left, -1 right, 0 straight on
  VehicleId blocked_by = kNoVehicle;  // as last published
  Tick blocked_tick = kNoTick;        // when that was last seen blocking
};

// Since the process started; a new world does not reset them.
struct BrainCounters {
  std::uint32_t scans_refused = 0;  // of any sensor
  std::uint32_t signals_refused = 0;
  BeaconCounters beacons;
  QosCounters qos;
  TrustCounters trust;
};

struct VehicleState {
  static constexpr std::uint32_t kVersion = 2;  // of snapshots; see services/snapshot

  Published published;
  InWorld world;
  MeasuredMotion motion;
  RouteProgress route;
  GoalProgress progress;
  Waiting waiting;
  MoverWatch movers;
  LastStep last;
  Sensed sensed;
  Heard heard;
  BrainCounters counters;
};

// What a brain knows of its world and its peers, as one number. Its other memory, such as detours
// or where it waited, shows here as soon as it drives by it.
std::uint64_t HashOf(const VehicleState& state, const RobotModel& profile);

}  // namespace giveway
