// The brain: one pure step from what a vehicle heard and sensed to what it does and says. No
// clock, no thread, no allocation, no exception; the same inputs give the same bits anywhere.
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
#include "services/vehicle/estimation/obstacle_grid.h"
#include "services/vehicle/estimation/odometry.h"
#include "services/vehicle/estimation/peer_table.h"
#include "services/vehicle/estimation/pose_keeping.h"
#include "services/vehicle/estimation/range_view.h"
#include "services/vehicle/situation/situation.h"

namespace giveway {

// Everything a brain remembers. Trivially copyable: a snapshot is a copy.
struct VehicleState {
  static constexpr std::uint32_t kVersion = 2;

  std::uint32_t boot_epoch = 0;
  std::uint32_t seq = 0;
  WorldEpoch epoch = kNoEpoch;
  Tick tick = kNoTick;
  WorldEpoch placed_in = kNoEpoch;  // the epoch of the last roster entry that said where it stands
  RunState run_state = RunState::kWaiting;
  Odometry odometry;
  Tick reckoned = kNoTick;     // the tick of odometry's pose; kNoTick: the one before the next scan
  WheelSpeeds wheels;          // as last measured
  WheelAngles counted;         // by the encoders, as last heard
  KnownBearing way;            // to where it drives next
  std::uint32_t waypoint = 0;  // the next one of the route; its count: on to the goal
  bool arrived = false;
  OrderKey order;
  std::uint32_t waited_ticks = 0;  // halted to give way, on the way to where it is through
  Vec2 waited_world;               // where it halted last
  bool let_pass = false;           // somebody that comes first has passed since it waits
  SteadyTime deaf_since{0};        // last time something near moved unexplained
  Tick turned_tick = kNoTick;      // when it last turned sharply
  Tick decided_tick = kNoTick;     // of the last step
  bool deaf = false;
  int deaf_sensor = -1;
  Decision decision;
  VehicleId gives_way_to = kNobody;  // as last published
  VehicleId blocked_by = kNobody;    // as last published
  Tick blocked_tick = kNoTick;       // when it was last seen in the way
  int steer_side = 0;                // 1 left, -1 right, 0 straight on
  double nearest_m = 1e9;            // the least distance to the goal so far
  std::uint32_t aimless_ticks = 0;   // driven since without coming nearer
  Vec2 detour_world;                 // where the way round leads first, if detour_tick is set
  Tick detour_tick = kNoTick;        // when it was looked for
  double away_rad = 0;               // the heading taken from what stopped it, if away_tick is set
  Tick away_tick = kNoTick;          // when it was taken
  Vec2 caught_world;                 // from where it gets no farther
  std::uint32_t caught_ticks = 0;    // for how long, not counting where it waits or queues
  RangeView ranges;
  ObstacleGrid grid;  // of imperfect ultrasonics
  PeerTable peers;
  SignalTable signals;
  SeenObjects objects;
  LastHeard last_heard;             // of lecture_printed
  std::uint32_t scans_refused = 0;  // of any sensor
  std::uint32_t signals_refused = 0;
  BeaconCounters beacons;
  QosCounters qos;
  TrustCounters trust;
  PoseKeeping pose;
};

// A beacon of the last step's inputs that was refused.
struct RefusedBeacon {
  std::uint32_t index = 0;  // into Inputs::beacons
  BeaconRefusal why = BeaconRefusal::kNone;
};

class Vehicle {
 public:
  // `boot_epoch` is random and not 0: it tells two lives of one vehicle apart.
  Vehicle(const VehicleOptions& options, std::uint32_t boot_epoch);

  // One step. The outputs answer inputs.scan, or repeat the tick of the last one.
  Outputs Step(const Inputs& inputs) noexcept;

  const VehicleState& State() const { return *state_; }
  // Continues from a snapshot taken with the same options.
  void Restore(const VehicleState& state) { *state_ = state; }
  // Drives by other options of the same vehicle id from its next roster entry on. Peers take it for
  // the same life: sequence numbers go on.
  void Reseat(const VehicleOptions& options);
  // What the next process of this vehicle needs to go on; nothing before it was placed.
  std::optional<Handover> HandOver() const;
  // Goes on where the process before stopped. Before the first step. False, and nothing is done,
  // where a handover is not sound.
  bool TakeOver(const Handover& handover);
  std::uint64_t Hash() const;
  // Forward speed as last measured, m/s.
  double SpeedMps() const;
  // Neither rolls nor turns, as last measured. Until it is told it is taken to.
  bool Stands() const { return state_->wheels == WheelSpeeds{}; }
  // What the last step decided by.
  const DecisionEvidence& Evidence() const { return evidence_; }
  // Peers with a fresh beacon in the last step.
  std::uint32_t PeersHeard() const { return peers_heard_; }
  // What became of each of the last step's beacons, in their order.
  std::span<const BeaconFate> Fates() const { return fates_; }
  // The first few of the last step, for the log; the counters have all.
  std::span<const RefusedBeacon> Refused() const { return {refused_.data(), refused_count_}; }

 private:
  void EnterWorld(WorldEpoch epoch, const Pose& world_from_body);
  void GoOn(TaskProgress task);
  void TakeRoster(const RosterEntry& entry);
  void TakeScan(const RangeScan& scan, SteadyTime now);
  void TakeFix(const Inputs& inputs);
  void TakePeers(const Inputs& inputs);
  void TakeSignalsAndObjects(const Inputs& inputs);
  Situation Look(const Inputs& inputs);
  void LookAtOwnPose(Situation* situation);
  void LookAhead(Situation* situation);
  void LookAtSignals(Situation* situation);
  void LookAround(Situation* situation);
  std::span<PeerView> ThoseThatMatter(Situation* situation);
  void LookAtPeers(Situation* situation);
  void NoteTurning(Situation* situation);
  void ListenForMovers(Situation* situation);
  void Detour(Situation* situation);
  void NoteCaught(Situation* situation, bool queues);
  std::uint32_t AgedTicks() const;
  void KeepOrder(const Situation& situation, bool waits);
  void Remember(const Situation& situation, const Action& action);
  void KeepBlocked(VehicleId blocked_by, const Situation& situation);
  Beacon Say(const Situation& situation);

  VehicleOptions options_;
  Cones cones_;         // of options_.profile
  HeardEchoes echoes_;  // scratch of one step
  HeardPlaces places_;  // the same
  std::unique_ptr<VehicleState> state_;
  std::unique_ptr<std::array<PeerView, kMaxPeers>> views_;  // scratch of one step
  std::uint32_t peers_heard_ = 0;
  DecisionEvidence evidence_;
  std::array<RefusedBeacon, 8> refused_;
  std::uint32_t refused_count_ = 0;
  std::vector<BeaconFate> fates_;  // grows to the most beacons of a step
};

}  // namespace giveway
