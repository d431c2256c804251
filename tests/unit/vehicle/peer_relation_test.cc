// How a peer relates to a vehicle at the origin that drives east.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/onlooker.h"

namespace giveway {
namespace {

// Stands ahead in the own lane, with nearly the own heading.
Peer Ahead() { return test::PeerAt({{2, 0.1}, 0.1}); }
// Crosses the own path from the right.
Peer Across() { return test::PeerAt({{3, -2}, kPi / 2}); }

bool Leads(Rule rule) {
  Peer peer = Ahead();
  peer.beacon.rule = rule;
  return test::Onlooker().RelatePeer(&peer).leads;
}

// Regression: vehicles queued permanently behind one that had arrived and happened to have their
// heading.
TEST(RelatePeer, OneThatHasArrivedIsNoLeaderHoweverItIsTurned) {
  EXPECT_TRUE(Leads(Rule::kGiveWay));
  EXPECT_TRUE(Leads(Rule::kSignal));
  EXPECT_FALSE(Leads(Rule::kArrived));
}

TEST(RelatePeer, OneThatIsGoneIsNoLeaderAndHasNoWay) {
  for (bool Peer::*gone : {&Peer::left, &Peer::out_of_reach}) {
    Peer ahead = Ahead();
    EXPECT_TRUE(test::Onlooker().RelatePeer(&ahead).leads);
    ahead.*gone = true;
    EXPECT_FALSE(test::Onlooker().RelatePeer(&ahead).leads);
    Peer across = Across();
    EXPECT_TRUE(test::Onlooker().RelatePeer(&across).crossing);
    across.*gone = true;
    EXPECT_FALSE(test::Onlooker().RelatePeer(&across).crossing);
  }
}

// A silent peer may still be there.
TEST(RelatePeer, OneThatIsLostKeepsItsWay) {
  Peer across = Across();
  across.deadline_missed = true;
  const PeerView view = test::Onlooker().RelatePeer(&across);
  EXPECT_TRUE(view.lost);
  EXPECT_TRUE(view.crossing);
}

// With ticks as long as they may be, the next beacon is never younger than two of them.
TEST(FreeAlong, KeepsClearOfAFreshBeaconHoweverLongATickIs) {
  VehicleOptions options = test::DefaultOptions();
  options.tick_period = std::chrono::milliseconds(600);
  options.beacon_age_limit = std::chrono::milliseconds(1800);
  Peer peer = test::PeerAt({{1, 0}, kPi});
  EXPECT_LT(test::Onlooker(options).RelatePeer(&peer).free_m, 1);
}

TEST(FreeAlong, KeepsClearOfABeaconAsLongAsItIsFresh) {
  VehicleOptions options = test::DefaultOptions();
  options.beacon_age_limit = std::chrono::milliseconds(2000);
  for (const std::uint32_t tick : {21U, 42U}) {  // a second, and as old as a fresh one can be
    Peer peer = test::PeerAt({{1, 0}, kPi});
    test::Onlooker onlooker(options);
    onlooker.At(Tick{tick});
    const PeerView view = onlooker.RelatePeer(&peer);
    EXPECT_TRUE(view.fresh) << tick;
    EXPECT_LT(view.free_m, 1) << tick;
  }
  Peer peer = test::PeerAt({{1, 0}, kPi});
  test::Onlooker onlooker;  // by default fresh for 200 ms, and kept clear of for a second
  onlooker.At(Tick{20});
  EXPECT_LT(onlooker.RelatePeer(&peer).free_m, 1);
  onlooker.At(Tick{21});
  EXPECT_GT(onlooker.RelatePeer(&peer).free_m, 1000);
}

// A peer at its destination has no path left: the direction of what remains means nothing.
TEST(CarryForward, TakesTheStraightWayToWhereThePeerDrivesUntilItIsThere) {
  Peer peer = test::PeerAt({{3, -0.3}, 0});
  peer.beacon.toward_world = {3, -0.24};
  const PeerView drives = test::Onlooker().RelatePeer(&peer);
  EXPECT_EQ(drives.offset_world, (Vec2{3, -0.3}));
  EXPECT_DOUBLE_EQ(drives.distance_m, std::sqrt(9.09));
  ASSERT_TRUE(drives.path_is_near);
  EXPECT_NEAR(drives.path_m, 0.06, 1e-12);
  EXPECT_NEAR(Norm(drives.path_direction_world - Vec2{0, 1}), 0, 1e-12);
  peer.beacon.toward_world = {3, -0.26};
  const PeerView there = test::Onlooker().RelatePeer(&peer);
  ASSERT_TRUE(there.path_is_near);
  EXPECT_NEAR(there.path_m, 0.04, 1e-12);
  EXPECT_EQ(there.path_direction_world, (Vec2{1, 0}));
}

// Bodies of 0.25 m each and a margin of 0.1 m: nearer than 0.6 m, apart from rounding.
TEST(CarryForward, LooksAtNoWayThatComesNowhereNearTheOwnOne) {
  Peer peer = test::PeerAt({{3, -5}, kPi / 2});
  peer.beacon.toward_world = {3, -0.75};
  EXPECT_FALSE(test::Onlooker().RelatePeer(&peer).path_is_near);
  peer.beacon.toward_world = {3, -0.59};
  EXPECT_TRUE(test::Onlooker().RelatePeer(&peer).path_is_near);
}

}  // namespace
}  // namespace giveway
