#include "services/config/pose_read.h"

#include <fmt/format.h>

#include "services/types/math/math.h"

namespace giveway {
namespace {

constexpr Allowed kError{-0.2, 0.2};

PoseFixModel ReadPoseFix(const Section& section) {
  PoseFixModel model;
  model.every_s = section.Number("every_s", {0.005, 3600, "s"});
  model.sigma_m = section.Number("sigma_m", {0.001, 10, "m"});
  model.dropout = section.NumberOr(0, "dropout", {0, 0.99});
  model.sigma_heading_rad = Radians(section.NumberOr(0, "sigma_heading_deg", {0, 90, "degrees"}));
  return model;
}

}  // namespace

void ReadPoseKeeping(const Section& section, RobotModel* profile) {
  const auto sensors = section.Child("sensors");
  const auto fixes = sensors ? sensors->Child("pose_fix") : std::nullopt;
  if (fixes) profile->pose_fix = ReadPoseFix(*fixes);
  const auto errors = section.Child("wheel_error");
  if (errors) {
    profile->wheel_error = {.diameter = errors->NumberOr(0, "diameter", kError),
                            .axle = errors->NumberOr(0, "axle", kError)};
  }
  if (section.Has("pose_limit_m")) {
    profile->pose_limit_m = section.Number("pose_limit_m", {0, 10, "m"});
  } else if (profile->pose_limit_m == 0 && (fixes || errors)) {
    profile->pose_limit_m = kUsualPoseLimit_m;
  }
  const double limit_m = profile->pose_limit_m;
  if (fixes && limit_m > 0 && profile->pose_fix.sigma_m > limit_m / 2) {
    fixes->AddError("sigma_m",
                    fmt::format("{} m is more than half of pose_limit_m ({} m): a vehicle that was "
                                "lost would stay so, whatever fixes come",
                                profile->pose_fix.sigma_m, limit_m),
                    fmt::format("write at most {}, or raise pose_limit_m", limit_m / 2));
  }
}

}  // namespace giveway
