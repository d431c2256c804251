// A scenario: the place, the vehicles in it, what is planned to go wrong and what is expected.
// A value; config loads and checks it, all other modules read it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/types/impairment.h"
#include "services/types/one_lane.h"
#include "services/types/signal.h"
#include "services/types/time.h"
#include "services/types/vehicle_options.h"

namespace giveway {

// A straight wall without thickness, in the world frame, metres.
struct Wall {
  Vec2 from_world;
  Vec2 to_world;
};

// How believable the ultrasonics are; each tier adds to the one before.
enum class SonarTier : std::uint8_t {
  kIdeal,      // the exact nearest point in the cone, every tick
  kTypical,    // blind zone, noise, incidence cut-off, drop-outs
  kP3dx,       // the real firing schedule: one transducer an array at a time
  kCrosstalk,  // transducers of different vehicles that fire in one slot hear each other
};

// How far off an edge, the weakest reflector, is heard on the axis of a cone, m; 0: corners are not
// heard. Polaroid transducers hear the edges of cardboard and of door frames from about 2 m when it
// is quiet; on a moving vehicle, with the gain that its schedule of 40 ms leaves, from less.
constexpr double EdgeReach(SonarTier tier) {
  switch (tier) {
    case SonarTier::kIdeal:
      return 0;
    case SonarTier::kTypical:
      return 2.0;
    case SonarTier::kP3dx:
    case SonarTier::kCrosstalk:
      break;
  }
  return 1.5;
}

// The same in a direction off the axis: `off` is the square of its sine by that of the half angle,
// 1 at the rim. There either way loses half the amplitude: 4 to the power of -2/3 is 0.4.
constexpr double EdgeReachOff(double edge_reach_m, double off) {
  return edge_reach_m * (1 - 0.6 * off);
}

// Numbers of the tiers above ideal. Sources: services/types/robot_model.h names the robot's.
struct SonarModel {
  SonarTier tier = SonarTier::kIdeal;
  double blind_m = 0.1;                           // what is nearer reads as this
  double noise = 0.01;                            // standard deviation, share of the range
  double max_incidence_rad = 0.4363323129985824;  // 25 degrees off a surface's normal: no echo
  double drop_out = 0.01;                         // probability that a firing hears nothing
  Nanoseconds slot{40'000'000};                   // one transducer of an array listens so long
};

// A body that is not a vehicle: stands, or follows its waypoints at constant speed for ever and
// gives way to no vehicle. It stops where it would touch, and continues when it can.
struct Obstacle {
  BodyShape shape = BodyShape::kDisc;
  double radius_m = 0.25;             // of a disc; half diagonal of a box
  Vec2 box_half_m;                    // half length (along x at heading 0) and half width
  Pose start_world;                   // a box keeps this heading wherever it goes
  std::vector<Vec2> waypoints_world;  // visited in turn, starting from start_world; empty: stands
  bool loop = false;                  // after the last: true on to the start, false back along them
  double speed_m_s = 0;
};

// A leaf that slides along its own line out of the doorway and back, driven by time since start.
struct Door {
  Vec2 from_world;  // jamb the leaf slides into
  Vec2 to_world;
  double closed_s = 5;  // stays closed, then opens in move_s, stays open, closes in move_s
  double open_s = 5;
  double move_s = 1;
  double offset_s = 0;  // how far into its cycle it is at the start signal
};

// A signal head with a fixed-time plan: green, yellow, red, for traffic in `travel_rad` direction
// that crosses the stop line. Heads of one group never show green against each other.
struct SignalPlan {
  SignalId id = kNoSignal;
  std::uint32_t group = 0;  // 0: none
  Vec2 line_from_world;     // stop line
  Vec2 line_to_world;
  double travel_rad = 0;  // heading of the traffic it is for, world frame
  double green_s = 10;
  double yellow_s = 3;
  double red_s = 13;
  double offset_s = 0;  // how far into its cycle (green first) it is at the start signal
};

enum class FaultKind : std::uint8_t {
  kKill,          // the vehicle's process dies
  kSignalDark,    // the head continues talking, but its lamps are out
  kSignalSilent,  // the head falls silent
};

// A planned fault. Due when every given condition holds.
struct PlannedFault {
  FaultKind kind = FaultKind::kKill;
  VehicleId vehicle = kNoVehicle;           // of kKill
  std::optional<double> at_s;               // seconds since the start signal
  std::optional<double> before_crossing_m;  // the vehicle is this near to `crossing`
  SignalId signal = kNoSignal;              // of the signal faults, which need at_s
};

// What must be true at the end for the verdict "passed". Sets are exact and sorted.
struct Expectation {
  std::uint32_t contacts = 0;
  std::vector<VehicleId> halted;
  std::vector<VehicleId> arrived;
  std::optional<Rule> halted_for;  // this rule started at least one halt
  bool any_halted = false;         // which vehicles halt is not judged
  bool any_arrived = false;        // which vehicles arrive is not judged
  bool parted = false;             // at the end every pair is further apart than at its closest
  std::optional<double> min_separation_m;  // at least this, shell to shell
  std::optional<double> time_to_clear_s;   // at most this
};

// For how long a world must not have heard a vehicle to count it as silent. Of a long tick a second
// is no time: the command that answers it comes with the next.
constexpr Nanoseconds SilenceIn(Nanoseconds tick_period) {
  constexpr Nanoseconds kLeast{1'000'000'000};
  constexpr std::int64_t kFewestTicks = 3;
  return std::max(kLeast, kFewestTicks * tick_period);
}

struct Scenario {
  std::string name;
  std::string description;
  std::string area = "main";
  std::uint32_t seed = 0;
  Nanoseconds tick_period{50'000'000};
  double duration_s = 60;            // 0: until it is stopped
  double start_timeout_s = 15;       // the world gives up waiting for the roster
  double remove_after_s = 5;         // a silent vehicle's body stays this long
  std::uint32_t watchdog_ticks = 3;  // the world stops a vehicle whose last command is older
  Vec2 crossing_world;
  std::vector<VehicleOptions> vehicles;  // sorted by id; start_world set
  // Places for vehicles that come without being named above: start pose and everything else by
  // which such a vehicle drives; ids are given by the world. Not empty: the fleet is open, vehicles
  // come and go, and the run lasts for its duration.
  std::vector<VehicleOptions> spawns;
  std::uint32_t start_with = 0;  // joined vehicles that start a run of an open fleet
  SonarModel sonar;
  std::vector<Wall> walls;
  std::vector<Obstacle> obstacles;
  std::vector<Door> doors;
  std::vector<SignalPlan> signals;  // sorted by id
  std::vector<OneLane> one_lanes;   // those of the vehicles' options
  std::vector<PlannedFault> faults;
  Impairment impairment;  // of what the vehicles hear; the virtual fleet has a radio of its own
  Expectation expect;
};

// Its run lasts until it is stopped.
inline bool IsEndless(const Scenario& scenario) { return scenario.duration_s == 0; }

}  // namespace giveway
