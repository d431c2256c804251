// Holds numbers of a sample against what they may be, and keeps the first that is not. Wide limits,
// of anything that drives on wheels: what a vehicle's own profile allows is judged by its brain.
#pragma once

#include <optional>

#include "services/types/fleet_limits.h"
#include "services/types/math/math.h"
#include "services/types/refusal.h"

namespace giveway::link {

class FieldRanges {
 public:
  // NaN is in no range.
  void Hold(const char* field, double value, double least, double most) {
    if (!fault_ && !(value >= least && value <= most)) {
      fault_ = FieldFault{field, value, least, most};
    }
  }
  void HoldPlace(const char* field, double value_m) {
    Hold(field, value_m, -kMaxCoordinate_m, kMaxCoordinate_m);
  }
  void HoldBearing(const char* field, double value_rad) {
    Hold(field, value_rad, -kPi - kRounding_rad, kPi + kRounding_rad);
  }
  void HoldCounted(const char* field, double value_rad) {
    Hold(field, value_rad, -kCounted_rad, kCounted_rad);
  }
  void HoldRate(const char* field, double value_rad_s) {
    Hold(field, value_rad_s, -kRate_rad_s, kRate_rad_s);
  }
  const std::optional<FieldFault>& Fault() const { return fault_; }

 private:
  static constexpr double kRounding_rad = 1e-9;
  static constexpr double kCounted_rad = 1e9;  // thirty years at full speed
  static constexpr double kRate_rad_s = 1e4;

  std::optional<FieldFault> fault_;
};

}  // namespace giveway::link
