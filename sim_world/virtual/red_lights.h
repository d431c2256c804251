// Which vehicles drive past a red light, by the truth: the axle centre crosses the stop line,
// within 45 degrees of the direction that the light is for, while it shows red. A vehicle that
// could not have stopped when it turned red is excused: its shell was nearer to the line than its
// stopping distance. A light that a fault has put out or silenced does not count.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/types/scenario.h"
#include "sim_world/virtual/observed.h"

namespace giveway::sim {

class RedLights {
 public:
  explicit RedLights(const Scenario& scenario);

  // Adds a vehicle that the scenario does not name; one of the same id is forgotten.
  void Admit(const VehicleOptions& options);
  void Forget(VehicleId vehicle);

  // Processes one tick, time_s after the start signal. Vehicles in order of their ids, the admitted
  // ones among them. Returns those that passed a red light since the last tick, by index; valid
  // until the next.
  std::span<const std::uint32_t> Observe(double time_s, std::span<const Observed> vehicles);
  // True if any light was red or yellow in it.
  bool AnyStops() const { return any_stops_; }

 private:
  struct Head {
    SignalPlan plan;
    double out_from_s;  // dark or silent from then on
    Vec2 travel_world;
    SignalPhase phase = SignalPhase::kDark;
    bool was_red = false;
    bool turned_red = false;
  };
  struct Track {
    VehicleId vehicle = kNoVehicle;
    double radius_m = 0;
    double deceleration_m_s2 = 0;
    bool seen = false;
    Vec2 last_position_world;
    std::vector<bool> excused;  // by head, until it is red again
  };

  Track TrackOf(const VehicleOptions& options) const;
  void Follow(double time_s);
  bool PassesRed(const Observed& now, Track* track) const;

  Nanoseconds tick_period_;
  std::vector<Head> heads_;
  std::vector<Track> tracks_;
  std::vector<std::uint32_t> passed_;
  bool any_stops_ = false;
};

}  // namespace giveway::sim
