// Which of what radar, lidar and camera show is an obstacle.
//
// An object is first of all only an object. Its place and its motion alone make it an obstacle:
//  - place: a point of it lies in the corridor straight ahead that the own body will sweep (its
//    radius and a margin to either side), so near that the vehicle must slow down to stop before
//    it;
//  - motion: it comes nearer by itself (the radar's range rate less the own motion), and carried on
//    at that rate along the line of sight it is in that corridor before the vehicle, at what it
//    drives now, could stand: reaction time and braking.
// Everything else stays an object. What lies in the corridor by either test limits the speed to one
// from which the vehicle stops before it. The lidar has no range rate: its objects are judged by
// their place alone, again with every scan.
//
// The camera makes no obstacles and knows no distance; it names the class of what is at a bearing.
// One exception hangs on it: where it sees a vehicle and a fresh beacon says that a vehicle stands
// just there, the object is that peer, and left to right of way and the ultrasonics.
//
// Sensors that are off, silent or older than the ranges may be show nothing and stop no vehicle:
// the ultrasonics remain the one sensor without which there is no motion.
#pragma once

#include <optional>

#include "services/vehicle/estimation/objects.h"
#include "services/vehicle/situation/situation.h"

namespace giveway {

struct ObjectAhead {
  double free_m = 0;    // straight on until the own shell touches where the object is, or will be
  Tick tick = kNoTick;  // of the scan that shows it
};

// The nearest obstacle among the objects, if any.
std::optional<ObjectAhead> NearestObstacle(const SeenObjects& seen, const Situation& s);

}  // namespace giveway
