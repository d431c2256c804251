// What an observer received from one vehicle in the last ticks, and the state that this shows for
// one of them: body from the truth, decision and priority from its beacons, the peers concerned
// from its status. Pure; knows no other vehicle and judges nothing.
//
// An observer of a real run has problems that a simulation does not:
//  - samples are lost and overwritten. A gap in the beacons' sequence numbers shows that the
//    observer missed something; without a gap the vehicle was silent. What was missed is never held
//    against the vehicle: facts are held for kHeldTicks, then they are unknown.
//  - a beacon names the tick of the scan it answers. If that is new, it is the tick in which the
//    beacon was published; a vehicle that receives no scans repeats the old one, and then only the
//    reception time shows when it was published.
#pragma once

#include <deque>
#include <optional>

#include "services/types/beacon.h"
#include "services/types/fleet_facts.h"
#include "services/types/vehicle_options.h"
#include "sim_world/virtual/invariants.h"

namespace giveway::fleetctl {

class VehicleObservation {
 public:
  // How long the last sample remains valid if newer ones were missed.
  static constexpr std::uint32_t kHeldTicks = 4;
  // The world reports a body for a second after it was taken away, and then no more.
  static constexpr std::uint32_t kGoneTicks = 100;

  explicit VehicleObservation(const VehicleOptions& options)
      : vehicle_(options.id), drive_(options.profile.drive) {}

  void Take(const Truth& truth);
  // `now` is the newest tick of any truth so far.
  void Take(const Beacon& beacon, Tick now);
  void Take(const VehicleStatus& status);
  // From the world's events: the process is gone, or back.
  void SetLives(bool lives) { lives_ = lives; }
  // What was seen of it; ticks may start again.
  void Forget();
  // It has a place again. Its body may not be reported yet.
  void Return();
  // Neither process nor body is there, and has not been for kGoneTicks queries.
  bool IsGone() const { return gone_ticks_ > kGoneTicks; }

  // nullopt if it is not known. Query ticks in order: older data is dropped.
  std::optional<sim::Observed> At(Tick tick);

 private:
  struct BeaconRecord {
    Beacon beacon;
    Tick at = kNoTick;       // when it was published
    Tick answers = kNoTick;  // the scan
    bool follows = false;    // directly on the one before it
  };
  // All that is kept of a status, which is large.
  struct StatedDecision {
    Tick tick = kNoTick;
    Decision decision;
  };

  bool IsTakenAway() const { return !truths_.empty() && !truths_.back().present; }
  bool AddBody(Tick tick, sim::Observed* seen) const;
  bool AddDecision(Tick tick, sim::Observed* seen) const;
  Tick Answered(const BeaconRecord& last, const BeaconRecord* next, Tick tick) const;
  Decision DecisionOf(const Beacon& beacon) const;
  void ForgetBefore(Tick tick);

  VehicleId vehicle_;
  DriveGeometry drive_;
  bool lives_ = true;
  std::uint32_t gone_ticks_ = 0;
  std::deque<Truth> truths_;              // ascending by tick
  std::deque<BeaconRecord> beacons_;      // ascending by tick of publication
  std::deque<StatedDecision> decisions_;  // by its statuses, ascending by tick
};

}  // namespace giveway::fleetctl
