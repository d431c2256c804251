// What a vehicle publishes every tick, whether or not any peer is near.
#pragma once

#include <compare>
#include <cstdint>

#include "services/types/decision.h"
#include "services/types/figures/beacon_account.h"
#include "services/types/ids.h"
#include "services/types/math/pose.h"
#include "services/types/time.h"

namespace giveway {

// Decides which vehicle has priority. Vehicles that waited beyond a limit come first, the longest
// wait first; then the higher cruise-speed bucket; then the lower id. A strict total order over
// distinct ids.
struct PriorityKey {
  std::uint32_t waited_ticks = 0;  // whole ageing limits; 0 below the first
  std::uint32_t speed_bucket = 0;  // round(cruise / 0.05 m/s)
  VehicleId vehicle = kNoVehicle;

  friend constexpr bool operator==(const PriorityKey&, const PriorityKey&) = default;
};

// True if `a` goes before `b`.
constexpr bool PrecedesByKey(const PriorityKey& a, const PriorityKey& b) {
  if (a.waited_ticks != b.waited_ticks) return a.waited_ticks > b.waited_ticks;
  if (a.speed_bucket != b.speed_bucket) return a.speed_bucket > b.speed_bucket;
  return a.vehicle < b.vehicle;
}

// The same for keys that may be inherited: of two vehicles that act by one key its owner goes last,
// for the other blocks it; of two that inherited it the lower id goes first.
constexpr bool HasPriority(const PriorityKey& a, VehicleId id_a, const PriorityKey& b,
                           VehicleId id_b) {
  if (a != b) return PrecedesByKey(a, b);
  if (a.vehicle == id_a) return false;
  return b.vehicle == id_b || id_a < id_b;
}

struct Beacon {
  VehicleId vehicle = kNoVehicle;
  std::uint32_t boot_epoch = 0;  // random, one a process life; never 0
  std::uint32_t seq = 0;         // 1, 2, 3 … within a boot epoch
  WorldEpoch world_epoch = kNoEpoch;
  Tick tick = kNoTick;             // the world tick this beacon answers
  WheelSpeeds wheels;              // measured
  double cruise_m_s = 0;           // the intent: does not drop because the vehicle gives way
  Pose world_from_body;            // estimate at `tick`
  PoseCovariance covariance;       // of world_from_body
  double body_radius_m = 0.25;     // disc round the axle centre
  DriveGeometry drive;             // what turns the wheel speeds into motion
  double acceleration_m_s2 = 0.3;  // of a wheel's rim: what the vehicle may do next
  double deceleration_m_s2 = 0.6;
  // Where it drives to in a straight line: its next waypoint or its goal; where it stands if it
  // stays there.
  Vec2 toward_world;
  Mode mode = Mode::kHalt;
  Rule rule = Rule::kNotRunning;
  VehicleId gives_way_to = kNoVehicle;
  VehicleId blocked_by = kNoVehicle;  // a vehicle whose body, standing or slower, blocks it
  // The key it acts by: its own, or inherited from the first in the order that it blocks.
  PriorityKey order;
};

// A beacon as the link hands it to the brain.
struct ReceivedBeacon {
  Beacon beacon;
  SteadyTime received{0};  // receiver's steady clock
  bool crc_valid = false;
  bool name_valid = false;   // the id is the one of the writer's partition
  std::uint64_t writer = 0;  // identity of the writing endpoint, for duplicate ids; never 0
  bool in_range = false;     // all its numbers are already checked; else each brain checks them
  BeaconArrival arrival;     // for accounting; no brain reads it
};

}  // namespace giveway
