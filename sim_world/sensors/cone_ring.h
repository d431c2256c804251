// The 16 cones of a vehicle's transducers in the layout that sonar_kernel.h needs: side by side,
// and cut into sectors of four neighbours with lines that bound what each can hear.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "services/types/robot_model.h"
#include "sim_world/sensors/sonar_cone.h"

namespace giveway::sim {

// One number a transducer.
struct alignas(64) Lanes {
  std::array<double, kSensorCount> of{};

  friend bool operator==(const Lanes&, const Lanes&) = default;
};

// The range of a transducer that hears no echo.
inline constexpr double kSilence_m = std::numeric_limits<double>::infinity();

// Four transducers to a sector: as many numbers as a 256-bit register holds.
inline constexpr std::size_t kSectorSize = 4;
inline constexpr std::size_t kSectorCount = kSensorCount / kSectorSize;

// Sectors by bits, the lowest that of transducers 0-3.
using SectorSet = std::uint32_t;
inline constexpr SectorSet kEverySector = (1U << kSectorCount) - 1;
constexpr SectorSet SectorOf(std::size_t transducer) { return 1U << (transducer / kSectorSize); }

// One line for each sector: every point p its cones hold has normal . p >= least_m.
struct alignas(32) SectorLines {
  std::array<double, kSectorCount> normal_x{};
  std::array<double, kSectorCount> normal_y{};
  std::array<double, kSectorCount> least_m{-kSilence_m, -kSilence_m, -kSilence_m, -kSilence_m};

  friend bool operator==(const SectorLines&, const SectorLines&) = default;
};

// A ring of cones in the body frame; all have the same opening.
struct ConeRing {
  Lanes apex_x;
  Lanes apex_y;
  Lanes axis_x;
  Lanes axis_y;
  double cos_half = 1;
  double sin_half = 0;
  std::array<SectorLines, 2> lines;  // right and left of each sector

  friend bool operator==(const ConeRing&, const ConeRing&) = default;
};

ConeRing RingOf(const std::array<Cone, kSensorCount>& cones_body);

}  // namespace giveway::sim
