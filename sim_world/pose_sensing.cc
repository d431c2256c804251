#include "sim_world/pose_sensing.h"

#include "sim_world/sensors/pose_fix.h"

namespace giveway::sim {

PoseSensing::PoseSensing(const Scenario& scenario)
    : seed_(scenario.seed), dt_s_(Seconds(scenario.tick_period)) {}

void PoseSensing::Sense(WorldEpoch epoch, Tick tick, std::uint32_t driven_tick,
                        std::span<const Body> bodies) {
  fixes_.clear();
  if (driven_tick == 0) return;
  for (const Body& body : bodies) {
    if (!body.present || !body.profile.pose_fix.Fitted()) continue;
    std::optional<PoseFix> fix =
        SensePose(body.profile.pose_fix, {.seed = seed_,
                                          .vehicle = body.vehicle,
                                          .driven_tick = driven_tick,
                                          .dt_s = dt_s_,
                                          .world_from_body = body.world_from_body});
    if (!fix) continue;
    fix->vehicle = body.vehicle;
    fix->epoch = epoch;
    fix->tick = tick;
    fixes_.push_back(*fix);
  }
}

}  // namespace giveway::sim
