// What every sensor other than the ultrasonics receives from the world, and all that it may use:
// radar, lidar and camera are pure functions from a SensorView to their scan. All sit at the axle
// centre, look forward and are exact; what is nearer hides what is behind it.
#pragma once

#include <span>

#include "services/types/ids.h"
#include "services/types/math/pose.h"
#include "services/types/sensor_scan.h"
#include "sim_world/sensors/scene.h"

namespace giveway::sim {

// What a sensor can learn of a shape's owner besides its outline. Owners are numbered as in
// collidables.h; walls have none.
struct OwnerFacts {
  Vec2 velocity_world;    // m/s, of the middle of a disc or box, of the whole of a segment
  double turn_rad_s = 0;  // of a disc or box about its middle
  SeenClass seen_class = SeenClass::kUnknown;
};

struct SensorView {
  const Scene& scene;
  std::span<const OwnerFacts>
      facts;              // by owner number; an owner not in it stands still and is unknown
  Owner self = kNoOwner;  // whose shapes the sensor does not see
  Pose world_from_body;
  Vec2 velocity_world;  // of the axle centre
  // What the scan is stamped with.
  VehicleId vehicle = kNoVehicle;
  WorldEpoch epoch = kNoEpoch;
  Tick tick = kNoTick;

  OwnerFacts FactsOf(Owner owner) const {
    return owner < facts.size() ? facts[owner] : OwnerFacts{};
  }
};

RadarScan SenseRadar(const SensorView& view);
LidarScan SenseLidar(const SensorView& view);
CameraScan SenseCamera(const SensorView& view);

// Points of the world in the sensor's frame: x forward, y left, itself at the origin.
class BodyFrame {
 public:
  explicit BodyFrame(const Pose& world_from_body)
      : origin_world_(world_from_body.position_world), x_axis_world_(Forward(world_from_body)) {}
  Vec2 Point(Vec2 world) const { return Direction(world - origin_world_); }
  Vec2 Direction(Vec2 world) const {
    return {Dot(x_axis_world_, world), Cross(x_axis_world_, world)};
  }

 private:
  Vec2 origin_world_;
  Vec2 x_axis_world_;
};

}  // namespace giveway::sim
