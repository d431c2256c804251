#include "sim_world/auxiliary_sensors.h"

#include <algorithm>

namespace giveway::sim {
namespace {

bool HasAny(const Body& body) {
  const RobotModel& profile = body.profile;
  return body.present && (profile.radar || profile.lidar || profile.camera);
}

}  // namespace

void AuxiliarySensors::Sense(WorldEpoch epoch, World* world) {
  radars_.clear();
  lidars_.clear();
  cameras_.clear();
  const std::span<const Body> bodies = world->Bodies();
  if (std::ranges::none_of(bodies, HasAny)) return;

  const std::size_t owners = bodies.size() + world->Obstacles().size() + world->Doors().size();
  facts_.clear();
  for (Owner owner = 0; owner < owners; ++owner) facts_.push_back(world->FactsOf(owner));
  const Scene& scene = world->SceneNow();
  for (Owner owner = 0; owner < bodies.size(); ++owner) {
    const Body& body = bodies[owner];
    if (!HasAny(body)) continue;
    const SensorView view{.scene = scene,
                          .facts = facts_,
                          .self = owner,
                          .world_from_body = body.world_from_body,
                          .velocity_world = facts_[owner].velocity_world,
                          .vehicle = body.vehicle,
                          .epoch = epoch,
                          .tick = world->Now()};
    if (body.profile.radar) radars_.push_back(SenseRadar(view));
    if (body.profile.lidar) lidars_.push_back(SenseLidar(view));
    if (body.profile.camera) cameras_.push_back(SenseCamera(view));
  }
}

}  // namespace giveway::sim
