// Which vehicles are stuck: they have a goal, could move, and for a long time neither come nearer
// nor wait for a vehicle that does, whatever rule they report. Judged by the truth; of what the
// vehicles publish only for which peers they wait and that a light stops them.
//
// A vehicle makes progress when it passes a waypoint of its route, or comes nearer to the next one,
// or to its goal, than ever on this leg. Waiting for one's turn is not being stuck, however long it
// takes, as long as one of the vehicles it waits for makes progress, or one of those that these
// wait for, and so on. The wait-for relation is what vehicles publish: the decision's peer and the
// one given way to. An arrived vehicle is not waited for: it never leaves. A vehicle at a red
// light, at a door that is not open, or at a dead vehicle is excused, and so are those that wait
// for it, because these obstructions end.
//
// In 700 sound runs (every generator, seeds 1 to 100, 2 to 50 vehicles, loss 0 to 20 %) a vehicle
// came no nearer by itself for 119 s at most, with those it waited for for 53 s at most.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/types/scenario.h"
#include "sim_world/virtual/observed.h"

namespace giveway::sim {

class Progress {
 public:
  Progress(const Scenario& scenario, double limit_s);

  // Adds a vehicle that the scenario does not name; one of the same id is forgotten.
  void Admit(const VehicleOptions& options);
  void Forget(VehicleId vehicle);

  // So many ticks were not seen: they count for no vehicle.
  void Skip(std::uint32_t ticks);

  // Processes one tick, time_s after the start signal. Vehicles in order of their ids, the admitted
  // ones among them; `red` says whether any light is red or yellow. Returns those that break the
  // invariant from this tick on, by index; valid until the next.
  std::span<const std::uint32_t> Observe(Tick tick, double time_s, bool red,
                                         std::span<const Observed> vehicles);

  // By the last tick: the vehicle need not make progress, whatever stops the others.
  bool Excused(std::size_t index) const { return tracks_[index].excused; }

 private:
  struct Track {
    VehicleId vehicle = kNoVehicle;
    Goal goal;  // not set: none
    Route route;
    double nearer_m = 0;  // what counts as nearer
    bool under_way = false;
    std::uint32_t waypoint = 0;  // the next one
    double nearest_m = 0;        // to it, or to the goal; so far on this leg
    Tick progress = kNoTick;     // the last
    bool reported = false;
    bool excused = false;
  };

  static Track TrackOf(const VehicleOptions& options);
  bool MakesProgress(const Observed& now, Track* track) const;
  bool IsExcused(const Observed& now, double time_s, bool red) const;
  void FindCrowds(std::span<const Observed> vehicles);
  std::uint32_t CrowdOf(std::uint32_t vehicle);
  void Join(std::uint32_t a, std::uint32_t b);
  std::uint32_t IndexOf(VehicleId vehicle) const;

  std::vector<Door> doors_;
  std::uint32_t limit_ticks_;
  std::uint32_t second_ticks_;
  std::vector<Track> tracks_;
  std::vector<std::uint32_t> crowd_;  // of each vehicle: another of the same, or itself
  std::vector<Tick> crowd_progress_;  // by the crowd's first
  std::vector<std::uint32_t> wedged_;
};

}  // namespace giveway::sim
