// Drives the bodies of a world by other means than our vehicles' brains, for comparison: same
// bodies, caps, accelerations, starts and goals. An idealised pilot: it sees every true pose and
// speed every tick, and its commands are never lost.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "services/types/scenario.h"

namespace giveway::bench {

struct Seen {
  Pose world_from_body;
  WheelSpeeds wheels;
  bool arrived = false;  // has been at its goal
};

class Pilot {
 public:
  virtual ~Pilot() = default;
  // Vehicles in the scenario's order; ticks are counted from 0 at the start signal.
  virtual void Drive(std::uint32_t tick, std::span<const Seen> fleet,
                     std::span<WheelSpeeds> wheels) = 0;
};

// The result of a run with any pilot.
struct Crossed {
  std::uint32_t vehicles = 0;
  std::uint32_t contacts = 0;
  std::uint32_t arrived = 0;
  // Beyond the time alone, per vehicle; one that never arrives counts until the run's end. To
  // arrive is to come within the goal's radius, as for a pilot that passes it at cruise speed.
  std::vector<double> delays_s;
  double took_s = 0;                   // until the last arrival, or the run's end
  std::optional<double> separation_m;  // the closest two shells ever came
};

// Seconds from the start signal to the goal for a vehicle that has the world to itself: it is there
// when it comes near enough, at cruise speed, and brakes then.
double AloneSeconds(const VehicleOptions& options);

Crossed RunWithPilot(const Scenario& scenario, Pilot* pilot);
// Our own vehicles, with a radio that loses nothing.
Crossed RunWithBrains(const Scenario& scenario);

}  // namespace giveway::bench
