// What the vehicles of a world sense: fills the scene with everything as it was at a moment of the
// tick, and reads the ultrasonics in it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/types/parallel.h"
#include "services/types/scenario.h"
#include "sim_world/body.h"
#include "sim_world/dynamics/collidables.h"
#include "sim_world/sensors/scene.h"
#include "sim_world/sensors/sensor.h"
#include "sim_world/sensors/sonar.h"

namespace giveway::sim {

class Sensing {
 public:
  explicit Sensing(const Scenario& scenario);

  // A body was inserted at `index`: a new one, or another vehicle in an old place.
  void Insert(std::size_t index, const RobotModel& profile);
  void Replace(std::size_t index, const RobotModel& profile);
  // The body at `index` left the list.
  void Erase(std::size_t index);

  // Reads every present body's ultrasonics after the tick that `collidables` made.
  void Sense(const SonarTick& tick, double dt_s, const Collidables& collidables,
             const ParallelFor& parallel, std::span<Body> bodies);

  // Everything as it is at the end of the tick.
  const Scene& SceneAtEnd(double dt_s, const Collidables& collidables,
                          std::span<const Body> bodies);

 private:
  void Fill(double before_s, double dt_s, const Collidables& collidables,
            std::span<const Body> bodies);

  Sonar sonar_;
  Scene scene_;
  bool at_end_ = false;  // the scene is that of the tick's end
  SonarRings rings_;
  std::vector<const SonarRing*> ring_of_;  // by body
  std::vector<SonarSubject> subjects_;
};

}  // namespace giveway::sim
