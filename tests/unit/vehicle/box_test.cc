// A crossing that cannot be left is not entered, and a peer held up before one is not waited for:
// one brain on the bench, heading east from the origin at 0.3 m/s; the peers cross its path at x =
// 4.
#include "services/vehicle/situation/box.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/brain_bench.h"
#include "tests/support/onlooker.h"

namespace giveway {
namespace {

using test::BeaconOf;
using test::BrainBench;
using test::ClearScan;
using test::Rolling;

constexpr double kCruise_m_s = 0.3;
constexpr VehicleId kPeer{2};
constexpr VehicleId kLeader{3};
constexpr VehicleId kThird{9};

// Comes from the south and stands before the own path.
Beacon PeerAt(std::uint32_t tick, double cruise_m_s) {
  return BeaconOf(2, tick, {.position_world = {4, -1.2}, .heading_rad = kPi / 2}, cruise_m_s);
}
// Has priority by its cruise speed, but its beacon says that it gives way to `to`.
Beacon PeerGivingWayTo(VehicleId to, std::uint32_t tick) {
  Beacon peer = PeerAt(tick, 0.4);
  peer.rule = Rule::kGiveWay;
  peer.gives_way_to = to;
  return peer;
}

// Drives ahead in the own lane.
Beacon Leader(std::uint32_t tick, double x_m, double speed_m_s) {
  Beacon beacon = BeaconOf(3, tick, {.position_world = {x_m, 0}}, kCruise_m_s);
  beacon.wheels = Rolling(speed_m_s);
  return beacon;
}

// Drives with the beacons that `beacons_at` gives for each tick, until commanded to stop, for 20 s
// at most.
template <typename BeaconsAt>
Outputs DriveUntilStopped(BrainBench* bench, BeaconsAt beacons_at) {
  Outputs out;
  for (int i = 0; i < 400; ++i) {
    RangeScan scan = ClearScan(0);
    scan.wheels = Rolling(kCruise_m_s);
    const std::uint32_t heard = bench->NextTick() - 1;
    out = bench->Step(scan, heard == 0 ? std::vector<Beacon>{} : beacons_at(heard));
    if (out.command.target.left_rad_s <= 0) break;
  }
  return out;
}

double PlaceOf(const Outputs& out) { return out.beacon.world_from_body.position_world.x; }

// Drives towards the peer, whose beacon does not change.
Outputs DriveUpTo(Beacon peer) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  return DriveUntilStopped(&bench, [&peer](std::uint32_t tick) {
    peer.tick = Tick{tick};
    peer.seq = tick;
    return std::vector{peer};
  });
}

TEST(HeldUp, OneThatGivesWayToAnotherIsNotWaitedFor) {
  EXPECT_GT(PlaceOf(DriveUpTo(PeerGivingWayTo(kThird, 1))), 5);
}

TEST(HeldUp, OneThatStandsInAQueueIsNotWaitedFor) {
  Beacon peer = PeerAt(1, 0.4);
  peer.rule = Rule::kKeepClear;
  peer.blocked_by = kThird;
  EXPECT_GT(PlaceOf(DriveUpTo(peer)), 5);
}

TEST(HeldUp, OneThatGivesWayToThisVehicleAloneIsWaitedForByTheOrder) {
  const Outputs out = DriveUpTo(PeerGivingWayTo(VehicleId{1}, 1));
  EXPECT_EQ(out.command.decision.rule, Rule::kGiveWay);
  EXPECT_LT(PlaceOf(out), 3.4);
}

// Its body is already in the path.
TEST(HeldUp, OneThatStandsInTheCrossingIsWaitedFor) {
  Beacon peer = PeerGivingWayTo(kThird, 1);
  peer.world_from_body.position_world.y = -0.55;
  const Outputs out = DriveUpTo(peer);
  EXPECT_EQ(out.command.decision.rule, Rule::kGiveWay);
  EXPECT_LT(PlaceOf(out), 3.5);
}

// What it waits for may be gone before the lane is free. Its path meets this one at 17 degrees; it
// stands right next to it.
TEST(HeldUp, OneThatComesTheOtherWayIsWaitedFor) {
  Beacon peer = PeerGivingWayTo(kThird, 1);
  peer.world_from_body = {.position_world = {4, 0.62}, .heading_rad = -kPi + 0.3};
  peer.toward_world = {-4, -1.9};
  const Outputs out = DriveUpTo(peer);
  EXPECT_EQ(out.command.decision.rule, Rule::kGiveWay);
  EXPECT_LT(PlaceOf(out), 3);
}

// A peer that is held up, and sets off after so many ticks.
Outputs DriveUpToOneThatSetsOffAt(std::uint32_t when) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  return DriveUntilStopped(&bench, [when](std::uint32_t tick) {
    Beacon peer = PeerGivingWayTo(kThird, tick);
    peer.wheels = Rolling(tick > when ? 0.02 : 0);
    return std::vector{peer};
  });
}

TEST(HeldUp, OneThatSetsOffIsWaitedForWhileThereIsTimeToStop) {
  const Outputs out = DriveUpToOneThatSetsOffAt(140);  // 7 s: 2.1 m along the path
  EXPECT_EQ(out.command.decision.rule, Rule::kGiveWay);
  EXPECT_LT(PlaceOf(out), 3.4);
}

// The beacon says that it gives way for as long as it could stop, and no longer.
TEST(HeldUp, TheWordToItIsTakenBackOnceItIsTooLateToStop) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  double said_last_m = 0;
  DriveUntilStopped(&bench, [&](std::uint32_t tick) {
    if (bench.Brain().State().published.gives_way_to == kPeer) {
      said_last_m = bench.Brain().State().motion.odometry.WorldFromBody().position_world.x;
    }
    return std::vector{PeerGivingWayTo(kThird, tick)};
  });
  EXPECT_GT(said_last_m, 2.5);
  EXPECT_LT(said_last_m, 3.3);
}

// It has no priority, but cannot stop any more; the peer, which has not moved for so long, can.
TEST(HeldUp, OneThatSetsOffTooLateToStopForIsDrivenPast) {
  EXPECT_GT(PlaceOf(DriveUpToOneThatSetsOffAt(222)), 5);  // 11.1 s: 3.33 m along the path
}

// Has priority and comes from ahead, in a lane so near that both are in each other's path from the
// start. It stands behind another one, which `blocks_it` blocks.
Outputs DriveUpToAQueueBehindOneBlockedBy(VehicleId blocks_it) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  return DriveUntilStopped(&bench, [blocks_it](std::uint32_t tick) {
    const auto peer = [tick](std::uint32_t id, double x_m, VehicleId blocked_by) {
      Beacon beacon = BeaconOf(id, tick, {{x_m, 0.58}, kPi}, kCruise_m_s + 0.1);
      beacon.rule = Rule::kKeepClear;
      beacon.blocked_by = blocked_by;
      return beacon;
    };
    return std::vector{peer(2, 2, VehicleId{3}), peer(3, 1.2, blocks_it)};
  });
}

// Regression: two queues blocked each other permanently, each waiting for a vehicle that stood
// behind one that the other queue blocked.
TEST(HeldUp, OneThatIsHeldUpByThisVehicleOverAnotherIsNotWaitedFor) {
  const Outputs waits = DriveUpToAQueueBehindOneBlockedBy(kThird);
  EXPECT_EQ(waits.command.decision.rule, Rule::kGiveWay);
  EXPECT_LT(PlaceOf(waits), 0.5);
  EXPECT_GT(PlaceOf(DriveUpToAQueueBehindOneBlockedBy(VehicleId{1})), 3);
}

// A peer whose path crosses the own one at `own`, `away_m` before it.
PeerView Crossing(Peer* peer, Stretch own, double away_m) {
  PeerView view{};
  view.peer = peer;
  view.crossing = Conflict{own, {away_m, away_m + 1}, true};
  return view;
}

// The space between 4.5 and 5 m is too short to stop in, that between 4.5 and 5.3 m is long enough.
// Peers far from the crossing point start no box, but are part of one.
TEST(Box, BeginsWithTheFirstOfThoseThatLeaveNoRoomBetween) {
  const test::Onlooker onlooker;
  Peer peer = test::PeerAt({});
  std::vector<PeerView> views = {Crossing(&peer, {3, 4}, 1), Crossing(&peer, {3.5, 4.5}, 1),
                                 Crossing(&peer, {5, 6}, 10), Crossing(&peer, {5.3, 6}, 10),
                                 Crossing(&peer, {2, 2.5}, 10)};
  FindBoxes(PeerViews<RelatedPeer>(views), onlooker.Own());
  EXPECT_EQ(views[0].box_begin_m, 3);
  EXPECT_EQ(views[1].box_begin_m, 3);
  EXPECT_EQ(views[2].box_begin_m, 3);
  EXPECT_EQ(views[3].box_begin_m, 5.3);
  EXPECT_EQ(views[4].box_begin_m, 2);
}

// The peer crosses at x = 4 some time later; the leader stands where this vehicle would have to
// stop in the peer's path.
TEST(Box, IsNotEnteredBehindOneThatStands) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  const Outputs out = DriveUntilStopped(&bench, [](std::uint32_t tick) {
    return std::vector{PeerAt(tick, 0.2), Leader(tick, 5, 0)};
  });
  EXPECT_EQ(out.command.decision.rule, Rule::kKeepClear);
  EXPECT_EQ(out.command.decision.peer, kLeader);
  EXPECT_LT(PlaceOf(out), 3.4);
}

TEST(Box, IsEnteredWhereThereIsRoomBehindIt) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  const Outputs out = DriveUntilStopped(&bench, [](std::uint32_t tick) {
    return std::vector{PeerAt(tick, 0.2), Leader(tick, 6, 0)};
  });
  EXPECT_EQ(out.command.decision.peer, kLeader);
  EXPECT_GT(PlaceOf(out), 5);
}

// A leader that keeps rolling through the crossing will leave space behind it.
TEST(Box, IsEnteredBehindOneThatDrivesOn) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  const Outputs out = DriveUntilStopped(&bench, [](std::uint32_t tick) {
    return std::vector{PeerAt(tick, 0.2), Leader(tick, 2 + 0.2 * 0.05 * tick, 0.2)};
  });
  EXPECT_GT(PlaceOf(out), 4);
}

// It gives way to a vehicle further ahead, so it will stop, and this vehicle would have to stop in
// the crossing.
TEST(Box, IsNotEnteredBehindOneThatWillStop) {
  BrainBench bench(test::OptionsWithoutUltrasonics());
  const Outputs out = DriveUntilStopped(&bench, [](std::uint32_t tick) {
    Beacon leader = Leader(tick, 4.4, 0.02);
    leader.gives_way_to = kThird;
    return std::vector{PeerAt(tick, 0.2), leader};
  });
  EXPECT_EQ(out.command.decision.peer, kLeader);
  EXPECT_LT(PlaceOf(out), 3.4);
}

}  // namespace
}  // namespace giveway
