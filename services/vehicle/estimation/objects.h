// What radar, lidar and camera last showed, as the vehicle keeps it: the newest believable scan of
// each kind, and where it was taken. What of it is an obstacle is judged in
// situation/objects_ahead.
#pragma once

#include "services/types/sensor_scan.h"
#include "services/types/state_hash.h"
#include "services/types/time.h"
#include "services/types/vehicle_io.h"
#include "services/types/vehicle_options.h"

namespace giveway {

// The newest scan of one kind, and where it was taken.
template <typename Scan>
struct HeldScan {
  Scan scan;  // tick kNoTick: none yet
  SteadyTime taken{0};
  Pose world_from_body;  // by dead reckoning, when the scan was received
  double speed_m_s = 0;  // forward, likewise
};

struct SeenObjects {
  HeldScan<RadarScan> radar;
  HeldScan<LidarScan> lidar;
  HeldScan<CameraScan> camera;
};

// What of a vehicle a scan is kept with.
struct Observer {
  WorldEpoch epoch = kNoEpoch;
  Tick tick = kNoTick;
  Pose world_from_body;
  double speed_m_s = 0;
};

// Keeps what is new, believable and of this world; returns how many scans it refused.
std::uint32_t TakeObjects(const Inputs& inputs, const Observer& observer, SeenObjects* seen);

// Adds nothing while no scan was ever taken.
void AddTo(const SeenObjects& seen, StateHash* hash);

}  // namespace giveway
