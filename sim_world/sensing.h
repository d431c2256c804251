// What the vehicles of a world sense: fills the scene with everything as it was at a moment of the
// tick, and reads the ultrasonics in it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/types/parallel.h"
#include "services/types/scenario.h"
#include "sim_world/body.h"
#include "sim_world/dynamics/things.h"
#include "sim_world/sensors/scene.h"
#include "sim_world/sensors/sensor.h"
#include "sim_world/sensors/sonar.h"

namespace giveway::sim {

class Sensing {
 public:
  explicit Sensing(const Scenario& scenario);

  // A body was inserted at `index`: a new one, or another vehicle in an old place.
  void Insert(std::size_t index, const VehicleProfile& profile);
  void Replace(std::size_t index, const VehicleProfile& profile);
  // The body at `index` left the list.
  void Erase(std::size_t index);

  // Reads every present body's ultrasonics after the tick that `things` made.
  void Sense(Tick tick, double dt_s, const Things& things, const ParallelFor& parallel,
             std::span<Body> bodies);

  // Everything as it is at the end of the tick.
  const Scene& SceneAtEnd(double dt_s, const Things& things, std::span<const Body> bodies);

 private:
  void Fill(double before_s, double dt_s, const Things& things, std::span<const Body> bodies);

  Sonar sonar_;
  Scene scene_;
  bool at_end_ = false;  // the scene is that of the tick's end
  SonarRings rings_;
  std::vector<const SonarRing*> ring_of_;  // by body
  std::vector<SonarSubject> subjects_;
};

}  // namespace giveway::sim
