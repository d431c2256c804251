// A vehicle's ring of transducers and what it hears in a scene: for each the exact range to the
// nearest point in its cone that answers. No noise, no schedule, no other vehicle's pulses.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "services/types/range_scan.h"
#include "services/types/robot_model.h"
#include "services/types/scenario.h"
#include "sim_world/sensors/scene.h"
#include "sim_world/sensors/sonar_cone.h"
#include "sim_world/sensors/sonar_kernel.h"

namespace giveway::sim {

struct Disc {
  Vec2 centre_world;
  double radius_m = 0;
};

using Readings = std::array<RangeReading, kSensorCount>;

class SonarRing {
 public:
  explicit SonarRing(const RobotModel& profile, SimdWidth width = FastestSimd());

  // Metres from each transducer; kSilence_m where nothing answers within range and where the
  // transducer is switched off. Shapes of `self` are not heard. A box is four flat surfaces; in it
  // the range is 0. Only the transducers of `sectors` are asked for; others may give silence.
  Lanes Hear(const Scene& scene, const Pose& world_from_body, Owner self, Incidence incidence = {},
             SectorSet sectors = kEverySector) const;

  // The same over every body and wall one by one, with the reference formulas: slow and plain.
  // bodies[self] is the own body, which no transducer hears.
  Readings Sense(const Pose& world_from_body, Tick tick, std::span<const Disc> bodies,
                 std::size_t self, std::span<const Wall> walls) const;

  bool Enabled(std::size_t i) const { return enabled_[i]; }
  const Cone& ConeBody(std::size_t i) const { return cones_body_[i]; }
  double MaxRange() const { return max_range_m_; }
  // Distance of the outermost transducer from the axle centre, m.
  double ApexReach() const { return apex_reach_m_; }
  // Those that are switched on: bit i for transducer i.
  std::uint32_t EnabledBits() const { return enabled_bits_; }

  friend bool operator==(const SonarRing& a, const SonarRing& b);

 private:
  void HearDiscs(const Scene& scene, const Receiver& receiver, Lanes* range_m) const;
  void HearSegments(const Scene& scene, const Receiver& receiver, Lanes* range_m) const;
  void HearFromInBoxes(const Scene& scene, const Receiver& receiver, Lanes* range_m) const;

  const SonarKernel* kernel_;
  ConeRing cones_;  // the same as below, as the kernel wants it
  std::array<Cone, kSensorCount> cones_body_{};
  std::array<bool, kSensorCount> enabled_{};
  std::uint32_t enabled_bits_ = 0;
  SectorSet sectors_ = 0;  // with a transducer that is enabled
  double max_range_m_ = 0;
  double apex_reach_m_ = 0;  // farthest transducer from the axle centre
};

// The rings of a fleet: vehicles with equal ultrasonics share one.
class SonarRings {
 public:
  // The width changes the speed and not a bit of the result.
  explicit SonarRings(SimdWidth width = FastestSimd()) : width_(width) {}

  // Its address is stable as long as this object lives.
  const SonarRing& Of(const RobotModel& profile);

 private:
  SimdWidth width_;
  std::vector<std::unique_ptr<const SonarRing>> rings_;
};

}  // namespace giveway::sim
