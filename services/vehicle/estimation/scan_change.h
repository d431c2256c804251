// What a scan of the own ultrasonics has that the one before had not: transducers that do not work
// show in the difference of two scans what no single reading does. Knows no peers and decides
// nothing; what the difference is evidence of stands in situation/sonar_trust.h.
#pragma once

#include <array>
#include <cstdint>

#include "services/types/range_scan.h"
#include "services/types/vehicle_options.h"
#include "services/vehicle/estimation/cones.h"
#include "services/vehicle/estimation/range_view.h"

namespace giveway {

enum class ScanNews : std::uint8_t {
  kNone,      // no scan, or whatever has fired repeats that it is clear
  kAllClear,  // every enabled sensor has fired and heard nothing
  kSame,      // whatever has fired repeats itself to the last bit, an echo at least
  kLeaps,     // of more than half of the enabled sensors the reading is another object's
  kOther,     // anything else, as of ultrasonics that work
};

struct ScanChange {
  ScanNews news = ScanNews::kNone;
  // Bit i for sensor i. With kSame: those that hear an echo. With kAllClear: those that heard one
  // the tick before, well within range and amid other cones, out of all of which no body gets in a
  // tick; was_m is then how far away.
  std::uint32_t echoes = 0;
  std::array<double, kSensorCount> was_m{};
};

// `scan` is about to be taken into `before`.
ScanChange ChangeOf(const RangeView& before, const RangeScan& scan, const VehicleOptions& options,
                    const Cones& cones);

}  // namespace giveway
