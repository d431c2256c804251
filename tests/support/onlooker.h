// A vehicle at the origin that looks and drives east, 100 m to go, and what it makes of one peer
// within a tick. It has no tables and takes no steps.
#pragma once

#include "services/vehicle/situation/echoes.h"
#include "services/vehicle/situation/one_lane.h"
#include "services/vehicle/situation/peer_relation.h"
#include "tests/support/brain_bench.h"

namespace giveway::test {

class Onlooker {
 public:
  explicit Onlooker(const VehicleOptions& options = DefaultOptions()) : options_(options) {
    own_.tick = Tick{2};
    own_.forward_world = {1, 0};
    own_.path = {{0, 0}, {1, 0}};
    own_.distance_to_goal_m = 100;
    own_.reaction_s = ReactionSeconds(options_);
    own_.slows_m = 10;
    own_.interest_radius_m = InterestRadius(options_.profile);
  }
  Onlooker(const Onlooker&) = delete;  // its view refers to the others

  const OwnView& Own() const { return own_; }
  void At(Tick tick) { own_.tick = tick; }

  void Knows(const OneLane& lane) {
    options_.one_lanes.push_back(lane);
    own_.lanes = FindLanesAhead(own_, own_, options_);
  }

  // One echo, and nothing else.
  void Hear(std::size_t sensor, double range_m) {
    RangeScan scan = ClearScan(2);
    SetEcho(&scan, static_cast<int>(sensor), range_m);
    ranges_ = {};
    ranges_.Take(scan, SteadyTime{0}, options_.tick_period);
    HearEchoes(ranges_, own_.tick, options_, &echoes_);
  }

  // The view refers to the peer.
  PeerView RelatePeer(Peer* peer) const {
    PeerView view{};
    view.peer = peer;
    view.fresh = IsFresh(*peer, {}, own_.tick, options_);
    giveway::RelatePeers(CarryForward(PeerViews<HeardPeer>({&view, 1}), own_), own_);
    return view;
  }

 private:
  VehicleOptions options_;
  RangeView ranges_;
  ScanChange change_;
  HeardEchoes echoes_{};
  SeenObjects objects_;
  Cones cones_ = ConesOf(options_.profile);
  OwnView own_{{},
               {},
               {},
               {},
               {.ranges = ranges_,
                .change = change_,
                .echoes = echoes_,
                .cones = cones_,
                .objects = objects_},
               {},
               options_};
};

// A peer whose beacon of the tick before states this pose.
inline Peer PeerAt(const Pose& pose, const PoseCovariance& covariance = {},
                   WheelSpeeds wheels = {}) {
  Peer peer{.id = VehicleId{2}, .known = true};
  peer.beacon = BeaconOf(2, 1, pose);
  peer.beacon.covariance = covariance;
  peer.beacon.wheels = wheels;
  return peer;
}

}  // namespace giveway::test
