// How a peer stands to a vehicle at the origin that drives east, 10 m to go.
#include "services/vehicle/look.h"

#include <gtest/gtest.h>

#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

// A view of the peer, which must outlive it.
PeerView Look(Peer* peer) {
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
  PeerView view{.peer = peer, .fresh = IsFresh(*peer, {}, s.tick, options)};
  CarryForward({&view, 1}, s);
  LookAt(&view, s);
  return view;
}

Peer PeerAt(const Pose& pose) {
  Peer peer{.id = VehicleId{2}, .known = true};
  peer.beacon = test::BeaconOf(2, 1, pose);
  return peer;
}

// Stands ahead in the own lane, turned as the vehicle is.
Peer Ahead() { return PeerAt({{2, 0.1}, 0.1}); }
// Comes across the own way from the right.
Peer Across() { return PeerAt({{3, -2}, kPi / 2}); }

bool Leads(Rule rule) {
  Peer peer = Ahead();
  peer.beacon.rule = rule;
  return Look(&peer).leads;
}

// Vehicles queued for good behind one that had arrived and happened to be turned their way.
TEST(LookAt, OneThatHasArrivedIsNoLeaderHoweverItIsTurned) {
  EXPECT_TRUE(Leads(Rule::kGiveWay));
  EXPECT_TRUE(Leads(Rule::kSignal));
  EXPECT_FALSE(Leads(Rule::kArrived));
}

TEST(LookAt, OneThatIsGoneIsNoLeaderAndHasNoWay) {
  for (bool Peer::*gone : {&Peer::left, &Peer::out_of_reach}) {
    Peer ahead = Ahead();
    EXPECT_TRUE(Look(&ahead).leads);
    ahead.*gone = true;
    EXPECT_FALSE(Look(&ahead).leads);
    Peer across = Across();
    EXPECT_TRUE(Look(&across).crossing);
    across.*gone = true;
    EXPECT_FALSE(Look(&across).crossing);
  }
}

// One that fell silent may still be there.
TEST(LookAt, OneThatIsLostKeepsItsWay) {
  Peer across = Across();
  across.deadline_missed = true;
  const PeerView view = Look(&across);
  EXPECT_TRUE(view.lost);
  EXPECT_TRUE(view.crossing);
}

}  // namespace
}  // namespace giveway
