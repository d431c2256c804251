// What the checks of a fleet know of one vehicle at one tick: the truth, and what it published.
// Virtual runs fill it in from their brains, real ones from world/truth, beacons and status.
#pragma once

#include "services/types/beacon.h"
#include "services/types/ids.h"

namespace giveway::sim {

// Slower is standing.
inline constexpr double kStandstill_m_s = 0.01;
// A vehicle may be off the pose it publishes by so many of the standard deviations it publishes.
inline constexpr double kPoseSigmas = 3;

struct Observed {
  VehicleId vehicle = kNoVehicle;
  bool present = false;  // its body stands in the world
  bool lives = false;    // its process runs
  bool arrived = false;
  Vec2 position_world;
  double heading_rad = 0;
  double forward_m_s = 0;
  double rim_m_s = 0;       // of the faster wheel: brakes act on wheels, not on the body's centre
  Tick answered = kNoTick;  // the scan its last command answers
  Decision decision;        // as last published, like what follows
  VehicleId gives_way_to = kNoVehicle;
  PriorityKey order;
  Tick stated = kNoTick;  // the tick of the pose in its last beacon
  Vec2 stated_position_world;
  PoseCovariance stated_covariance;
  // The whole beacon, valid until the next tick; null if it is not known: what needs it is not
  // judged.
  const Beacon* beacon = nullptr;
  bool stops = false;  // its last command stops the wheels; known if the beacon is
};

// Of the faster wheel.
double RimSpeed(const DriveGeometry& drive, WheelSpeeds wheels);

}  // namespace giveway::sim
