#include "sim_world/sensors/sonar_echo.h"

#include <algorithm>

namespace giveway::sim {
namespace {

// Separates the ultrasonics' random stream from others of the same seed.
constexpr std::uint64_t kSonarNumbers = 0x736f6e6172ULL << 24;

}  // namespace

Random FiringRandom(std::uint32_t seed, VehicleId vehicle, std::uint64_t when,
                    std::size_t transducer) {
  Random of_vehicle(kSonarNumbers ^ seed, Number(vehicle));
  return Random(of_vehicle.Next(), when * kSensorCount + transducer);
}

double Measured(double range_m, const SonarModel& model, double max_range_m, Random random) {
  if (random.Uniform(0, 1) < model.drop_out || range_m == kSilence_m) return kSilence_m;
  const double rim_m = std::min(model.blind_m, max_range_m);
  if (range_m < rim_m) return rim_m;
  return std::clamp(range_m + random.Gaussian(model.noise * range_m), rim_m, max_range_m);
}

}  // namespace giveway::sim
