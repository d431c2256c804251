// Can two vehicles of a scenario stop before they touch, from whatever directions they meet? The
// sum of what both drive until they stand, against the distance at which they learn of each other.
// Physics alone: if the sum is too long, no rule of right of way helps.
#pragma once

#include "services/config/scenario_read.h"
#include "services/types/vehicle_options.h"

namespace giveway {

// What two that drive at each other need, and have. Metres.
struct BrakingSum {
  double own_m = 0;       // braking from cruise speed, and the 2 % that a seed may add
  double peer_m = 0;      // the same of the peer
  double reaction_s = 0;  // until both brake: two ticks, a third for the beacon's transit, the
                          // radio's delay, the ultrasonics' refresh
  double reaction_m = 0;  // driven by both in that time
  double bodies_m = 0;    // both radii: beacons give centres, ultrasonics shells
  double radio_m = 0;     // the emission radius that both hear within
  double sonar_m = 0;     // shell to shell: at the entry gate ultrasonics alone stop a vehicle

  double NeededShells() const { return own_m + peer_m + reaction_m; }
  double NeededCentres() const { return NeededShells() + bodies_m; }
  bool ComesOut() const { return NeededCentres() <= radio_m || NeededShells() <= sonar_m; }
};

// `delay_s` is the longest that the scenario holds a beacon back.
BrakingSum SumOf(const VehicleOptions& own, const VehicleOptions& peer, double delay_s);

// How far before its shell a vehicle surely hears what stands in its path, m. Exact ultrasonics
// hear all within their range; others may hear no more than an edge, and that last where it lies
// midway between two cones. A face that they hear from further off may end where they do not.
double SureReach(const VehicleOptions& own, SonarTier tier);

// True if it stops for what stands within that.
bool CanStopForStanding(const VehicleOptions& own, SonarTier tier);

// Refuses vehicles and spawn places that could not stop for another of the scenario, and those that
// could not stop for a wall, an obstacle or a door once their ultrasonics surely hear it. One
// problem a vehicle at most, and of two the one that needs more is blamed.
void CheckBraking(const ReadScenario& read);

}  // namespace giveway
