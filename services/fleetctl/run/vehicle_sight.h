// What an observer saw of one vehicle in the last ticks, and what that says of the vehicle at one
// of them: its body by the truth, its decision and place in the order by its beacons, whom that
// concerns by its status. Pure; knows no other vehicle and judges nothing.
//
// Watching from outside adds what a simulation does not have:
//  - samples are lost and overwritten. A gap in the beacons' sequence numbers says that the watcher
//    missed something, none says that the vehicle was silent. What was missed is never held against
//    the vehicle: facts are held for kHeldTicks, and then nothing is known.
//  - a beacon names the tick of the scan it answers. Where that is new, it is the tick at which it
//    was said; a vehicle that gets no scans repeats the old one, and when it spoke is known only by
//    when it was heard.
#pragma once

#include <deque>
#include <optional>

#include "services/types/beacon.h"
#include "services/types/fleet_facts.h"
#include "services/types/vehicle_options.h"
#include "sim_world/virtual/invariants.h"

namespace giveway::fleetctl {

class VehicleSight {
 public:
  // For how long what was last heard still stands where more was missed.
  static constexpr std::uint32_t kHeldTicks = 4;

  explicit VehicleSight(const VehicleOptions& options)
      : vehicle_(options.id), drive_(options.profile.drive) {}

  void Take(const Truth& truth);
  // `now` is the newest tick of any truth so far.
  void Take(const Beacon& beacon, Tick now);
  void Take(const VehicleStatus& status);
  // What the world's events say: the process is gone, or back.
  void SetLives(bool lives) { lives_ = lives; }

  // Nothing where it is not known. Ticks must be asked for in order: what is older is forgotten.
  std::optional<sim::Observed> At(Tick tick);

 private:
  struct Said {
    Beacon beacon;
    Tick at = kNoTick;       // when it was said
    Tick answers = kNoTick;  // the scan
    bool follows = false;    // directly on the one before it
  };

  bool AddBody(Tick tick, sim::Observed* seen) const;
  bool AddWords(Tick tick, sim::Observed* seen) const;
  Tick Answered(const Said& last, const Said* next, Tick tick) const;
  Decision DecisionOf(const Beacon& beacon) const;
  void Forget(Tick before);

  VehicleId vehicle_;
  DriveGeometry drive_;
  bool lives_ = true;
  std::deque<Truth> truths_;          // ascending by tick
  std::deque<Said> said_;             // ascending by tick said
  std::deque<VehicleStatus> status_;  // ascending by tick
};

}  // namespace giveway::fleetctl
