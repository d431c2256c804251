#include "services/app/recording.h"

#include <algorithm>
#include <cmath>

#include "services/app/recording_fields.h"
#include "services/types/fleet_limits.h"

namespace giveway::app {
namespace {

template <typename T>
std::optional<T> Copy(const T* value) {
  return value == nullptr ? std::nullopt : std::optional<T>(*value);
}

template <typename T>
const T* PointerTo(const std::optional<T>& value) {
  return value ? &*value : nullptr;
}

constexpr double kMostNumber = 1e6;  // of anything in a vehicle's options
constexpr double kLeastLength_m = 1e-3;

// True if every number is finite and not absurd. Recordings come from outside: arithmetic that a
// checked scenario keeps in bounds must stay there.
class Sober {
 public:
  void operator()(const auto&... values) { (Look(values), ...); }
  bool Holds() const { return holds_; }

 private:
  template <typename T>
  void Look(const T& value) {
    if constexpr (std::is_same_v<T, double>) {
      holds_ = holds_ && std::isfinite(value) && std::abs(value) <= kMostNumber;
    } else if constexpr (std::is_same_v<T, Nanoseconds>) {
      holds_ = holds_ && value.count() >= 0 && value <= std::chrono::hours(24);
    } else if constexpr (requires { value.begin(); }) {
      for (const auto& element : value) Look(element);
    } else if constexpr (std::is_class_v<T>) {
      Visit(*this, value);
    }
  }
  bool holds_ = true;
};

}  // namespace

void RecordedStep::Hold(const Inputs& inputs, const Outputs& said, std::uint64_t state_hash) {
  now = inputs.now;
  scan = inputs.scan;
  beacons.assign(inputs.beacons.begin(), inputs.beacons.end());
  events.assign(inputs.events.begin(), inputs.events.end());
  radar = Copy(inputs.radar);
  lidar = Copy(inputs.lidar);
  camera = Copy(inputs.camera);
  signals.assign(inputs.signals.begin(), inputs.signals.end());
  roster = inputs.roster;
  pose_fix = inputs.pose_fix;
  leaving = inputs.leaving;
  halting = inputs.halting;
  outputs = said;
  hash = state_hash;
}

Inputs RecordedStep::AsInputs() const {
  return {.now = now,
          .scan = scan,
          .beacons = beacons,
          .events = events,
          .radar = PointerTo(radar),
          .lidar = PointerTo(lidar),
          .camera = PointerTo(camera),
          .signals = signals,
          .roster = roster,
          .pose_fix = pose_fix,
          .leaving = leaving,
          .halting = halting};
}

std::string WhyUnusable(const VehicleOptions& options) {
  const VehicleProfile& profile = options.profile;
  const double lengths[] = {profile.drive.wheel_radius_m, profile.drive.axle_m,
                            profile.body_radius_m,        profile.max_speed_m_s,
                            profile.max_turn_rad_s,       profile.acceleration_m_s2,
                            profile.deceleration_m_s2,    profile.sonar_max_range_m};
  Sober sober;
  sober(options);
  if (!sober.Holds()) return "options hold a number no vehicle has";
  if (options.id == kNobody) return "options name no vehicle";
  if (options.tick_period < std::chrono::milliseconds(1)) return "options have no tick";
  if (options.route.count > kMaxWaypoints) return "options have too long a route";
  if (std::ranges::any_of(lengths, [](double x) { return x < kLeastLength_m; }) ||
      !(options.cruise_m_s > 0) || options.cruise_m_s > kMaxSpeed_m_s) {
    return "options describe no vehicle that could drive";
  }
  return {};
}

}  // namespace giveway::app
