#include "services/vehicle/estimation/objects.h"

#include "services/vehicle/estimation/scan_check.h"

namespace giveway {
namespace {

constexpr std::uint32_t kAheadTicks = 2;  // a scan may overtake the ranges by so much

template <typename Scan>
std::uint32_t Take(const Scan* scan, SteadyTime now, const Observer& observer,
                   HeldScan<Scan>* held) {
  if (scan == nullptr) return 0;
  if (scan->epoch != observer.epoch || !IsBelievable(*scan)) return 1;
  if (TicksBetween(observer.tick, scan->tick) > kAheadTicks) return 1;
  if (held->scan.epoch == scan->epoch && scan->tick <= held->scan.tick) return 0;  // out of order
  *held = {*scan, now, observer.world_from_body, observer.speed_m_s};
  return 0;
}

}  // namespace

std::uint32_t TakeObjects(const Inputs& inputs, const Observer& observer, SeenObjects* seen) {
  return Take(inputs.radar, inputs.now, observer, &seen->radar) +
         Take(inputs.lidar, inputs.now, observer, &seen->lidar) +
         Take(inputs.camera, inputs.now, observer, &seen->camera);
}

void AddTo(const SeenObjects& seen, StateHash* hash) {
  const auto add = [hash](const auto& held) {
    if (held.scan.tick == kNoTick) return;
    hash->Add(held.scan.tick);
    hash->Add(held.taken.count());
    hash->Add(held.world_from_body.position_world.x);
    hash->Add(held.world_from_body.position_world.y);
    hash->Add(held.world_from_body.heading_rad);
  };
  add(seen.radar);
  add(seen.lidar);
  add(seen.camera);
  for (std::uint32_t i = 0; i < seen.radar.scan.count; ++i) {
    hash->Add(seen.radar.scan.detections[i].range_m);
  }
}

}  // namespace giveway
