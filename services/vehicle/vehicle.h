// The brain: one pure step from what a vehicle heard and sensed to what it does and says. No
// clock, no thread, no exception, no allocation after warm-up; the same inputs give the same bits
// anywhere.
//
//   scan, beacons, events -> dead reckoning -> PeerTable, RangeView -> Situation -> Decide -> out
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "services/types/decision_evidence.h"
#include "services/types/figures/beacon_account.h"
#include "services/types/handover.h"
#include "services/types/vehicle_io.h"
#include "services/types/vehicle_options.h"
#include "services/vehicle/decision/decide.h"
#include "services/vehicle/situation/situation.h"
#include "services/vehicle/vehicle_state.h"

namespace giveway {

// A beacon of the last step's inputs that was refused.
struct RefusedBeacon {
  std::uint32_t index = 0;  // into Inputs::beacons
  BeaconRefusal why = BeaconRefusal::kNone;
};

class Vehicle {
 public:
  // `boot_epoch` is random and not 0: it distinguishes two lives of one vehicle.
  Vehicle(const VehicleOptions& options, std::uint32_t boot_epoch);

  // One step. The outputs answer inputs.scan, or repeat the tick of the last one.
  Outputs Step(const Inputs& inputs) noexcept;

  const VehicleState& State() const { return *state_; }
  // Continues from a snapshot taken with the same options.
  void Restore(const VehicleState& state) { *state_ = state; }
  // Applies other options of the same vehicle id from its next roster entry on. Peers take it for
  // the same life: sequence numbers continue.
  void Reseat(const VehicleOptions& options);
  // What the next process of this vehicle needs to resume; empty before it was placed.
  std::optional<Handover> HandOver() const;
  // Resumes where the process before stopped. Before the first step. False, with nothing changed,
  // if the handover is not sound.
  bool TakeOver(const Handover& handover);
  std::uint64_t Hash() const;
  // Forward speed as last measured, m/s.
  double SpeedMps() const;
  // Neither rolls nor turns, as last measured. Assumed until the first measurement.
  bool Stands() const { return state_->motion.wheels == WheelSpeeds{}; }
  // What the last step decided by.
  const DecisionEvidence& Evidence() const { return evidence_; }
  // Peers with a fresh beacon in the last step.
  std::uint32_t PeersHeard() const { return peers_heard_; }
  // What became of each of the last step's beacons, in their order.
  std::span<const BeaconFate> Fates() const { return fates_; }
  // The first few of the last step, for the log; the counters have all.
  std::span<const RefusedBeacon> Refused() const { return {refused_.data(), refused_count_}; }

 private:
  // Estimation.
  void TakeScan(const RangeScan& scan, SteadyTime now);
  void TakeFix(const Inputs& inputs);
  void TakePeers(const Inputs& inputs);
  void TakeSignalsAndObjects(const Inputs& inputs);
  // The stages of a situation: situation/situation.h.
  OwnView AssessSelf(const Inputs& inputs);
  OwnPose AssessOwnPose();
  OwnMotion AssessOwnMotion(const OwnPose& pose);
  Lights AssessSignals(const Moment& moment, const OwnMotion& motion, const OwnCourse& course);
  PeersNow AssessSurroundings(const OwnView& own);
  PeersNow AssessPeers(const OwnView& own);
  PeersNow AssessLastHeard(const OwnView& own);
  PeerViews<HeardPeer> SelectRelevantPeers(const OwnView& own, bool* any_lost);
  std::span<const Vec2> PlacesHeard(const OwnView& own, const PeersNow& near);
  Situation BuildSituation(const OwnView& own, const PeersNow& near);
  // After the decision.
  void Remember(const Situation& situation, const Action& action);
  void KeepBlocked(VehicleId blocked_by, const Situation& situation);
  Beacon MakeBeacon(const Situation& situation);

  VehicleOptions options_;
  Cones cones_;         // of options_.profile
  ScanChange change_;   // of one step
  HeardEchoes echoes_;  // scratch of one step
  HeardPlaces places_;  // the same
  std::unique_ptr<VehicleState> state_;
  std::vector<PeerView> views_;  // of one step; its memory is kept
  std::uint32_t peers_heard_ = 0;
  DecisionEvidence evidence_;
  std::array<RefusedBeacon, 8> refused_;
  std::uint32_t refused_count_ = 0;
  std::vector<BeaconFate> fates_;  // grows to the most beacons of a step
};

}  // namespace giveway
