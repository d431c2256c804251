// Whether a brain can be made of recorded options. Recordings come from outside.
#include <algorithm>
#include <cmath>

#include "services/recording/recording.h"
#include "services/recording/recording_fields.h"
#include "services/types/fleet_limits.h"

namespace giveway {
namespace {

constexpr double kMostNumber = 1e6;  // of anything in a vehicle's options
constexpr double kLeastLength_m = 1e-3;

// True if every number is finite and not absurd. Recordings come from outside: arithmetic that a
// checked scenario keeps in bounds must stay there.
class Sober {
 public:
  void operator()(const auto&... values) { (Check(values), ...); }
  bool Holds() const { return holds_; }

 private:
  template <typename T>
  void Check(const T& value) {
    if constexpr (std::is_same_v<T, double>) {
      holds_ = holds_ && std::isfinite(value) && std::abs(value) <= kMostNumber;
    } else if constexpr (std::is_same_v<T, Nanoseconds>) {
      holds_ = holds_ && value.count() >= 0 && value <= std::chrono::hours(24);
    } else if constexpr (requires { value.begin(); }) {
      for (const auto& element : value) Check(element);
    } else if constexpr (std::is_class_v<T>) {
      Visit(*this, value);
    }
  }
  bool holds_ = true;
};

bool IsNoSection(const OneLane& lane) {
  return !(Norm(lane.to_world - lane.from_world) >= kLeastLength_m) ||
         !(lane.width_m >= kLeastLength_m);
}

}  // namespace

std::string WhyUnusable(const VehicleOptions& options) {
  const RobotModel& profile = options.profile;
  const double lengths[] = {profile.drive.wheel_radius_m, profile.drive.axle_m,
                            profile.body_radius_m,        profile.max_speed_m_s,
                            profile.max_turn_rad_s,       profile.acceleration_m_s2,
                            profile.deceleration_m_s2,    profile.sonar_max_range_m};
  Sober sober;
  sober(options);
  if (!sober.Holds()) return "options hold a number no vehicle has";
  if (options.id == kNoVehicle) return "options name no vehicle";
  if (options.tick_period < std::chrono::milliseconds(1)) return "options have no tick";
  if (options.route.count > kMaxWaypoints) return "options have too long a route";
  if (options.one_lanes.size() > kMaxOneLanes) return "options have too many one-lane sections";
  if (std::ranges::any_of(options.one_lanes, IsNoSection)) {
    return "options have a one-lane section without a length or a width";
  }
  if (std::ranges::any_of(lengths, [](double x) { return x < kLeastLength_m; }) ||
      !(options.cruise_m_s > 0) || options.cruise_m_s > kMaxSpeed_m_s) {
    return "options describe no vehicle that could drive";
  }
  return {};
}

}  // namespace giveway
