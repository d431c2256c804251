// The sensors other than the ultrasonics, of every vehicle that has them, once a tick. They read
// the state of the world at the tick's end and change nothing in it.
#pragma once

#include <span>
#include <vector>

#include "services/types/sensor_scan.h"
#include "sim_world/sensors/sensor.h"
#include "sim_world/world.h"

namespace giveway::sim {

class AuxiliarySensors {
 public:
  // Costs nothing if no vehicle present has such a sensor.
  void Sense(WorldEpoch epoch, World* world);

  // Of the last Sense, by vehicle.
  std::span<const RadarScan> Radars() const { return radars_; }
  std::span<const LidarScan> Lidars() const { return lidars_; }
  std::span<const CameraScan> Cameras() const { return cameras_; }

 private:
  std::vector<OwnerFacts> facts_;
  std::vector<RadarScan> radars_;
  std::vector<LidarScan> lidars_;
  std::vector<CameraScan> cameras_;
};

}  // namespace giveway::sim
