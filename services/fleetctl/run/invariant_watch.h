// Checks a real run against the invariants of the virtual ones, from what an observer receives:
// truths, beacons, statuses and events. Off the vehicles' path: no vehicle waits for it. Pure.
//
// A tick is judged kLagTicks later, when all its samples have arrived. A tick with missing samples
// is left out and counted, because a check must report what it did not see.
//
// A world that was restarted resumes under another epoch, from ticks it had already passed: what
// was seen of its ticks before is judged and let go, and the new ones are judged from its first
// step on. The link believes one world at a time, so a stranger's is not taken for it.
//
// Limits are wider than in a virtual run without loss, each for its own cause:
//  - brains miss beacons and scans as they do with a lossy radio: LimitsFor;
//  - an observation may be VehicleObservation::kHeldTicks old: a wait cycle or a halt of all
//    vehicles may last that much longer, a priority key may be that much older, and braking may
//    start that much later.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "services/fleetctl/run/vehicle_observation.h"
#include "services/link/observer_link.h"
#include "services/report/report.h"
#include "services/types/scenario.h"
#include "sim_world/virtual/invariants.h"

namespace giveway::fleetctl {

class InvariantWatch {
 public:
  static constexpr std::uint32_t kLagTicks = 10;

  explicit InvariantWatch(const Scenario& scenario);

  void Fold(const link::Observed& observed);
  // Evaluates the ticks still held back, and which vehicles have not arrived if the run ended by
  // itself.
  void Finish(bool came_to_its_end);

  const sim::Invariants& Judged() const { return invariants_; }
  std::uint32_t TicksJudged() const { return ticks_judged_; }
  std::uint32_t TicksUnseen() const { return ticks_unseen_; }
  std::size_t Vehicles() const { return observations_.size(); }  // that are judged
  // The counts, and the verdict of a run that otherwise passed.
  void AddTo(Report* report) const;

 private:
  void Admit(const RosterEntry& entry);
  void FoldTruth(const Truth& truth);
  bool IsOfAPastWorld(WorldEpoch epoch) const;
  void Follow(const Truth& first);
  void FoldEvent(const WorldEvent& event);
  bool IsOfThisWorld(WorldEpoch epoch) const { return epoch == epoch_; }
  void EvaluateUntil(Tick last);
  void Evaluate(Tick tick);
  double TimeOf(Tick tick) const;  // since the start signal
  void NoteComingsAndGoings(Tick tick);
  void ForgetGone();
  bool Observe(Tick tick);

  Scenario scenario_;
  sim::Invariants invariants_;
  std::map<VehicleId, VehicleObservation> observations_;
  // Of vehicles that the scenario does not name, until they are gone.
  std::map<VehicleId, std::uint32_t> spawns_;
  WorldEpoch epoch_ = kNoEpoch;         // of the newest world heard
  std::deque<WorldEpoch> past_epochs_;  // the last ones before it
  double waits_at_s_ = 0;               // that world's time until its first step
  Tick newest_ = kNoTick;               // of any truth of it
  Tick next_ = kNoTick;                 // to be judged; kNoTick before the start
  Tick judged_ = kNoTick;               // the newest, of any world: never one twice
  Tick first_ = kNoTick;                // of this world that was judged, and
  double first_time_s_ = 0;             // its time since the start signal
  Tick last_ = kNoTick;                 // the run's, once it has ended
  std::vector<WorldEvent> events_;      // not given to the invariants yet
  std::size_t noted_ = 0;               // of them: used to learn which vehicles are live
  std::vector<sim::Observed> seen_;
  std::uint32_t ticks_judged_ = 0;
  std::uint32_t ticks_unseen_ = 0;
};

}  // namespace giveway::fleetctl
