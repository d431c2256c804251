#include "services/config/pose_read.h"

#include <fmt/format.h>

#include <utility>

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

constexpr std::string_view kStaysLost =
    "a vehicle that was lost would stay so, whatever fixes come";

std::optional<Section> FixesIn(const std::optional<Section>& profile) {
  const auto sensors = profile ? profile->Child("sensors") : std::nullopt;
  return sensors ? sensors->Child("pose_fix") : std::nullopt;
}

}  // namespace

void ReadPoseKeeping(const Section& section, RobotModel* profile) {
  if (const auto fixes = FixesIn(section)) profile->pose_fix = ReadPoseFix(*fixes);
  if (const auto errors = section.Child("wheel_error")) {
    profile->wheel_error = {.diameter = errors->NumberOr(0, "diameter", kError),
                            .axle = errors->NumberOr(0, "axle", kError)};
  }
  profile->pose_limit_m = section.NumberOr(profile->pose_limit_m, "pose_limit_m", {0, 10, "m"});
}

void PoseLimits::Settle(const std::optional<Section>& own, RobotModel* profile) {
  if (!Writes("pose_limit_m", own) &&
      (FixesIn(own) || FixesIn(shared_) || Writes("wheel_error", own))) {
    profile->pose_limit_m = kUsualPoseLimit_m;
  }
  const double limit_m = profile->pose_limit_m;
  const double sigma_m = profile->pose_fix.sigma_m;
  if (!profile->pose_fix.Fitted() || !(limit_m > 0) || !(sigma_m > limit_m / 2)) return;
  const std::optional<Section> fixes = FixesIn(own);
  if (!fixes && own && own->Has("pose_limit_m")) {
    own->AddError("pose_limit_m",
                  fmt::format("{} m is less than twice the sigma_m of the fixes ({} m): {}",
                              limit_m, sigma_m, kStaysLost),
                  fmt::format("write at least {}, or lower sigma_m", 2 * sigma_m));
  } else if (fixes || !std::exchange(shared_is_blamed_, true)) {
    (fixes ? fixes : FixesIn(shared_))
        ->AddError("sigma_m",
                   fmt::format("{} m is more than half of pose_limit_m ({} m): {}", sigma_m,
                               limit_m, kStaysLost),
                   fmt::format("write at most {}, or raise pose_limit_m", limit_m / 2));
  }
}

bool PoseLimits::Writes(std::string_view field, const std::optional<Section>& own) const {
  return (own && own->Has(field)) || (shared_ && shared_->Has(field));
}

}  // namespace giveway
