#include "sim_world/sensors/pose_fix.h"

#include <algorithm>
#include <cmath>

#include "services/types/math/math.h"
#include "services/types/math/random.h"

namespace giveway::sim {
namespace {

constexpr std::uint64_t kPoseFix = 0x706f7365ULL << 32;

}  // namespace

std::optional<PoseFix> SensePose(const PoseFixModel& model, const PoseFixMoment& moment) {
  if (!model.Fitted()) return std::nullopt;
  const auto every =
      std::max(1U, static_cast<std::uint32_t>(std::lround(model.every_s / moment.dt_s)));
  const std::uint64_t vehicle = Number(moment.vehicle);
  if ((moment.driven_tick + vehicle * 7) % every != 0) return std::nullopt;
  Random random(kPoseFix | moment.seed, vehicle << 32 | moment.driven_tick);
  if (random.Uniform(0, 1) < model.dropout) return std::nullopt;
  PoseFix fix;
  const Pose& truth = moment.world_from_body;
  const double x_m = random.Gaussian(model.sigma_m);
  const double y_m = random.Gaussian(model.sigma_m);
  fix.world_from_body.position_world = truth.position_world + Vec2{x_m, y_m};
  fix.sigma_position_m = model.sigma_m;
  fix.sigma_heading_rad = model.sigma_heading_rad;
  if (model.sigma_heading_rad > 0) {
    const double off_rad = random.Gaussian(model.sigma_heading_rad);
    fix.world_from_body.heading_rad = WrapAngle(truth.heading_rad + off_rad);
  }
  return fix;
}

}  // namespace giveway::sim
