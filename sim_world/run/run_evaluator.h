// Watches the true state of a run and reports what happened: which vehicle halted to give way,
// continued, arrived, touched something. Does not decide when the run ends. What must hold in every
// run is checked in sim_world/virtual/invariants.h.
//
// A vehicle has arrived while it stands in its goal: its process drives it, it came to a standstill
// with the axle centre within the goal's radius, and it has not left the circle since. Driving
// through does not count, and a vehicle that leaves again has not arrived. A looping route has no
// goal.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "services/types/scenario.h"
#include "sim_world/body.h"
#include "sim_world/run/event_log.h"
#include "sim_world/run/expectation.h"
#include "sim_world/separation.h"

namespace giveway::sim {

// An event for each.
void LogContacts(std::span<const Contact> contacts, EventLog* log);

class RunEvaluator {
 public:
  explicit RunEvaluator(const Scenario& scenario);

  // Processes one tick of the run, time_s after its start.
  void Observe(double time_s, std::span<const Body> bodies, std::span<const Contact> contacts,
               EventLog* log);

  bool HasArrived(VehicleId vehicle) const;
  // Every vehicle that ever halted to give way, and every vehicle that arrived; sorted.
  std::vector<VehicleId> Halted() const;
  std::vector<VehicleId> Arrived() const;
  // The rules that started the halts; sorted, each once.
  std::vector<Rule> HaltedFor() const;
  // Seconds from the start to the last arrival so far; none before the first.
  std::optional<double> LastArrival() const;

  // The vehicle is put on its start pose again: it has yet to arrive. What it did before still
  // counts among Halted and Arrived.
  void Restart(VehicleId vehicle);

  // The vehicle is gone, as it seems permanently. What counts in the verdict is kept, for a limited
  // number of vehicles.
  void Forget(VehicleId vehicle);

  // What is remembered of one vehicle.
  struct Track {
    VehicleId vehicle = kNoVehicle;
    std::uint32_t still_ticks = 0;  // consecutive, standing to give way
    bool halted = false;            // stands, after a halt that was logged
    bool halted_once = false;
    Rule stopping_for = Rule::kCruise;  // the first of consecutive rules to give way; else kCruise
    std::uint32_t halted_for = 0;       // bit i: rule i started a halt
    bool arrived_before = false;        // and was put on its start pose again since
    std::optional<double> arrived_s;    // stands in its goal since then
  };
  std::span<const Track> Tracks() const { return tracks_; }
  void Restore(std::span<const Track> tracks) { tracks_.assign(tracks.begin(), tracks.end()); }

 private:
  Track& TrackOf(std::size_t body, VehicleId vehicle);
  void WatchGoal(double time_s, const Body& body, Track* track, EventLog* log) const;
  void WatchHalt(const Body& body, Track* track, EventLog* log) const;

  std::uint32_t halt_ticks_;
  std::vector<Track> tracks_;  // by id, as the bodies are
};

}  // namespace giveway::sim
