// How a peer stands to a vehicle at the origin that drives east, 10 m to go.
#include "services/vehicle/look.h"

#include <gtest/gtest.h>

#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

// Of a peer that stands 2 m ahead in the own lane, turned as the vehicle is.
bool Leads(Rule rule) {
  const VehicleOptions options = test::DefaultOptions();
  const RangeView ranges;
  const HeardEchoes echoes{};
  const Cones cones = ConesOf(options.profile);
  const SeenObjects objects;
  Situation s{
      .options = options, .ranges = ranges, .echoes = echoes, .cones = cones, .objects = objects};
  s.tick = Tick{2};
  s.forward_world = {1, 0};
  s.path = {{0, 0}, {1, 0}};
  s.distance_to_goal_m = 10;
  Peer peer{.id = VehicleId{2}, .known = true};
  peer.beacon = test::BeaconOf(2, 1, {{2, 0.1}, 0.1});
  peer.beacon.rule = rule;
  PeerView view{.peer = &peer, .fresh = true};
  CarryForward({&view, 1}, s);
  LookAt(&view, s);
  return view.leads;
}

// Vehicles queued for good behind one that had arrived and happened to be turned their way.
TEST(LookAt, OneThatHasArrivedIsNoLeaderHoweverItIsTurned) {
  EXPECT_TRUE(Leads(Rule::kGiveWay));
  EXPECT_TRUE(Leads(Rule::kSignal));
  EXPECT_FALSE(Leads(Rule::kArrived));
}

}  // namespace
}  // namespace giveway
