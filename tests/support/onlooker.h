// A vehicle at the origin that looks and drives east, 100 m to go, and what it makes of one peer
// within a tick. It has no tables and takes no steps.
#pragma once

#include "services/vehicle/situation/echoes.h"
#include "services/vehicle/situation/look.h"
#include "tests/support/brain_bench.h"

namespace giveway::test {

class Onlooker {
 public:
  explicit Onlooker(const VehicleOptions& options = DefaultOptions()) : options_(options) {
    situation_.tick = Tick{2};
    situation_.forward_world = {1, 0};
    situation_.path = {{0, 0}, {1, 0}};
    situation_.distance_to_goal_m = 100;
    situation_.reaction_s = ReactionSeconds(options_);
    situation_.slows_m = 10;
    situation_.looks_m = LooksAround(options_.profile);
  }
  Onlooker(const Onlooker&) = delete;  // the situation refers to the others

  const giveway::Situation& Situation() const { return situation_; }

  // One echo, and nothing else.
  void Hear(std::size_t sensor, double range_m) {
    RangeScan scan = ClearScan(2);
    SetEcho(&scan, static_cast<int>(sensor), range_m);
    ranges_ = {};
    ranges_.Take(scan, SteadyTime{0}, options_.tick_period);
    HearEchoes(ranges_, situation_.tick, options_, &echoes_);
  }

  // The view refers to the peer.
  PeerView LookAt(Peer* peer) const {
    PeerView view{.peer = peer, .fresh = IsFresh(*peer, {}, situation_.tick, options_)};
    CarryForward({&view, 1}, situation_);
    giveway::LookAt(&view, situation_);
    return view;
  }

 private:
  VehicleOptions options_;
  RangeView ranges_;
  HeardEchoes echoes_{};
  SeenObjects objects_;
  Cones cones_ = ConesOf(options_.profile);
  giveway::Situation situation_{.options = options_,
                                .ranges = ranges_,
                                .echoes = echoes_,
                                .cones = cones_,
                                .objects = objects_};
};

// One that told so with the tick before.
inline Peer PeerAt(const Pose& pose, const PoseCovariance& covariance = {},
                   WheelSpeeds wheels = {}) {
  Peer peer{.id = VehicleId{2}, .known = true};
  peer.beacon = BeaconOf(2, 1, pose);
  peer.beacon.covariance = covariance;
  peer.beacon.wheels = wheels;
  return peer;
}

}  // namespace giveway::test
