// What a sensor of a vehicle's pose says. Only what is finite and has a deviation passes: how far
// it is to be believed is for the brain to judge.
#include <cmath>

#include "services/link/convert/convert.h"
#include "services/link/convert/convert_parts.h"

namespace giveway::link {

wire::PoseFix ToWire(const PoseFix& fix) {
  wire::PoseFix sent;
  sent.vehicle(Number(fix.vehicle));
  sent.world_epoch(Number(fix.epoch));
  sent.tick(Number(fix.tick));
  sent.world_from_body(ToWirePart(fix.world_from_body));
  sent.sigma_position_m(fix.sigma_position_m);
  sent.sigma_heading_rad(fix.sigma_heading_rad);
  return sent;
}

bool FromWire(const wire::PoseFix& sample, PoseFix& fix) {
  fix.vehicle = VehicleId{sample.vehicle()};
  fix.epoch = WorldEpoch{sample.world_epoch()};
  fix.tick = Tick{sample.tick()};
  fix.world_from_body = FromWirePart(sample.world_from_body());
  fix.sigma_position_m = sample.sigma_position_m();
  fix.sigma_heading_rad = sample.sigma_heading_rad();
  return IsFinite(fix.world_from_body) && std::isfinite(fix.sigma_position_m) &&
         fix.sigma_position_m > 0 && std::isfinite(fix.sigma_heading_rad) &&
         fix.sigma_heading_rad >= 0;
}

}  // namespace giveway::link
