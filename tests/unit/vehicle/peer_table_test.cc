#include "services/vehicle/estimation/peer_table.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <vector>

#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;
using test::BeaconOf;
using test::Received;

class PeerTableTest : public testing::Test {
 protected:
  void Take(const ReceivedBeacon& received) {
    table_->Take(received, self_, options_, &counters_, &trust_);
  }
  void Hear(std::uint32_t id, std::uint32_t seq, milliseconds at) {
    Take(Received(BeaconOf(id, seq, {}), at));
  }
  // So near the emission radius that it may be beyond it a tick later.
  void HearAtTheRim(std::uint32_t id, std::uint32_t seq, milliseconds at) {
    Take(Received(BeaconOf(id, seq, {.position_world = {4.98, 0}}), at));
  }
  bool Fresh(std::uint32_t id, milliseconds now) {
    const Peer* peer = table_->Find(VehicleId{id});
    return peer != nullptr && IsFresh(*peer, now, self_.tick, options_);
  }

  VehicleOptions options_ = test::DefaultOptions();
  Self self_{VehicleId{1}, test::kEpoch, Tick{100}, {}};
  std::unique_ptr<PeerTable> table_ = std::make_unique<PeerTable>();
  BeaconCounters counters_;
  TrustCounters trust_;
  QosCounters qos_;
};

TEST_F(PeerTableTest, EveryNeighbourKeepsItsOwnPlace) {
  for (std::uint32_t id : {9U, 2U, 5U}) Hear(id, 99, milliseconds(0));
  ASSERT_EQ(table_->Peers().size(), 3U);
  EXPECT_EQ(table_->Peers()[0].id, VehicleId{2});
  EXPECT_EQ(table_->Peers()[2].id, VehicleId{9});
  EXPECT_EQ(counters_.accepted, 3U);
}

// The table looks first at the peer that came next the last time.
TEST_F(PeerTableTest, InWhateverOrderTheyAreHeardEachIsFoundInItsPlace) {
  const std::vector<std::vector<std::uint32_t>> orders = {{7, 3, 9, 5},    {7, 3, 9, 5},
                                                          {5, 9, 4, 7, 3}, {3, 4, 5, 7, 9},
                                                          {9, 8, 2},       {2, 9, 3, 5, 7, 8, 4}};
  std::uint32_t seq = 90;
  for (const std::vector<std::uint32_t>& order : orders) {
    ++seq;
    for (const std::uint32_t id : order) Hear(id, seq, milliseconds(0));
    for (const std::uint32_t id : order) {
      const Peer* peer = table_->Find(VehicleId{id});
      ASSERT_NE(peer, nullptr) << id;
      EXPECT_EQ(peer->id, VehicleId{id});
      EXPECT_EQ(peer->last_seq, seq) << id;
    }
    EXPECT_EQ(table_->Find(VehicleId{6}), nullptr);
  }
  EXPECT_EQ(table_->Peers().size(), 7U);
  EXPECT_EQ(counters_.accepted, 28U);
}

TEST_F(PeerTableTest, WhatWasFoundToBeInRangeIsNotLookedAtAgain) {
  ReceivedBeacon received = Received(BeaconOf(2, 99, {}), milliseconds(0));
  received.beacon.wheels.right_rad_s = 31;
  Take(received);
  EXPECT_EQ(counters_.rejected_out_of_range, 1U);
  received.in_range = true;
  Take(received);
  EXPECT_EQ(counters_.accepted, 1U);
}

TEST_F(PeerTableTest, ASilentPeerIsNotBelievedPastTheAgeLimit) {
  Hear(2, 99, milliseconds(0));
  EXPECT_TRUE(Fresh(2, milliseconds(200)));
  EXPECT_FALSE(Fresh(2, milliseconds(201)));
}

// The receiver's clock says "just now", but the content is old: a peer without ranges.
TEST_F(PeerTableTest, OldContentIsOldHoweverLatelyItCame) {
  Hear(2, 94, milliseconds(0));
  EXPECT_FALSE(Fresh(2, milliseconds(0)));
  Hear(2, 95, milliseconds(0));
  EXPECT_TRUE(Fresh(2, milliseconds(0)));
}

TEST_F(PeerTableTest, BeaconsOfThisTickWaitForTheNext) {
  Hear(2, 99, milliseconds(0));
  Hear(2, 100, milliseconds(1));
  Hear(2, 101, milliseconds(2));
  EXPECT_EQ(table_->Find(VehicleId{2})->beacon.tick, Tick{99});
  table_->Advance(milliseconds(50), Tick{101});
  EXPECT_EQ(table_->Find(VehicleId{2})->beacon.tick, Tick{100});
  table_->Advance(milliseconds(100), Tick{102});
  EXPECT_EQ(table_->Find(VehicleId{2})->beacon.tick, Tick{101});
}

TEST_F(PeerTableTest, EveryRefusalHasItsCounterAndNamesWhoItWas) {
  const auto refused = [&](auto change, std::uint32_t BeaconCounters::*counter) {
    ReceivedBeacon received = Received(BeaconOf(3, 99, {}), milliseconds(0));
    change(&received);
    const std::uint32_t before = counters_.*counter;
    Take(received);
    EXPECT_EQ(counters_.*counter, before + 1);
    EXPECT_EQ(table_->LastRejected(), received.beacon.vehicle);
    EXPECT_FALSE(Fresh(3, milliseconds(0)));
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](ReceivedBeacon* r) { r->beacon.vehicle = VehicleId{1}; },
          &BeaconCounters::rejected_own);
  refused([](ReceivedBeacon* r) { r->name_valid = false; }, &BeaconCounters::rejected_wrong_name);
  refused([](ReceivedBeacon* r) { r->crc_valid = false; }, &BeaconCounters::rejected_crc);
  refused([nan](ReceivedBeacon* r) { r->beacon.wheels.left_rad_s = nan; },
          &BeaconCounters::rejected_not_finite);
  refused([nan](ReceivedBeacon* r) { r->beacon.world_from_body.position_world.y = nan; },
          &BeaconCounters::rejected_not_finite);
  refused([](ReceivedBeacon* r) { r->beacon.wheels.right_rad_s = 31; },
          &BeaconCounters::rejected_out_of_range);
  refused([](ReceivedBeacon* r) { r->beacon.body_radius_m = 0; },
          &BeaconCounters::rejected_out_of_range);
  refused([](ReceivedBeacon* r) { r->beacon.drive.axle_m = 1e-300; },
          &BeaconCounters::rejected_out_of_range);
  refused([](ReceivedBeacon* r) { r->beacon.cruise_m_s = -0.1; },
          &BeaconCounters::rejected_out_of_range);
  refused([nan](ReceivedBeacon* r) { r->beacon.covariance.yh_m_rad = nan; },
          &BeaconCounters::rejected_not_finite);
  refused([](ReceivedBeacon* r) { r->beacon.covariance.yy_m2 = -1e-6; },
          &BeaconCounters::rejected_out_of_range);
  refused([](ReceivedBeacon* r) { r->beacon.covariance = {.xx_m2 = 1, .xy_m2 = 1, .yy_m2 = 0.9}; },
          &BeaconCounters::rejected_out_of_range);
  refused([](ReceivedBeacon* r) { r->beacon.covariance.hh_rad2 = 40; },
          &BeaconCounters::rejected_out_of_range);
  refused([](ReceivedBeacon* r) { r->beacon.order.speed_bucket = 99; },
          &BeaconCounters::rejected_out_of_range);
  refused([](ReceivedBeacon* r) { r->beacon.order.vehicle = kNoVehicle; },
          &BeaconCounters::rejected_out_of_range);
  refused([](ReceivedBeacon* r) { r->beacon.rule = static_cast<Rule>(99); },
          &BeaconCounters::rejected_out_of_range);
  refused([](ReceivedBeacon* r) { r->beacon.world_epoch = WorldEpoch{8}; },
          &BeaconCounters::rejected_wrong_epoch);
  EXPECT_EQ(counters_.taken, counters_.accepted + counters_.not_heard + counters_.Rejected());
}

TEST_F(PeerTableTest, ABeaconOfATickFarAheadIsRefused) {
  Hear(2, 100 + kMostTicksAhead, milliseconds(0));
  EXPECT_EQ(counters_.accepted, 1U);
  Hear(3, 101 + kMostTicksAhead, milliseconds(0));
  Hear(4, 0xffff'ffff, milliseconds(0));
  EXPECT_EQ(counters_.rejected_out_of_range, 2U);
  EXPECT_EQ(table_->Peers().size(), 1U);
  self_.tick = kNoTick;  // no scan yet: there is nothing to compare with
  Hear(3, 500, milliseconds(0));
  EXPECT_EQ(counters_.accepted, 2U);
}

// In lockstep a beacon counts as received at its tick: one of a second writer from years ahead had
// the owner of the id refused for as long.
TEST_F(PeerTableTest, ARivalFromYearsAheadTakesNoIdAway) {
  Hear(2, 98, milliseconds(4900));
  ReceivedBeacon rival = Received(BeaconOf(2, 0xffff'ffff, {}), std::chrono::hours(59'000));
  rival.writer = 77;
  Take(rival);
  EXPECT_EQ(counters_.rejected_duplicate_id, 0U);
  Hear(2, 99, milliseconds(4950));
  EXPECT_EQ(counters_.accepted, 2U);
  EXPECT_TRUE(Fresh(2, milliseconds(4950)));
}

TEST_F(PeerTableTest, AReplayedBeaconIsRefused) {
  Hear(2, 98, milliseconds(0));
  Hear(2, 98, milliseconds(10));
  Hear(2, 97, milliseconds(20));
  EXPECT_EQ(counters_.rejected_replayed, 2U);
  EXPECT_EQ(counters_.accepted, 1U);
}

TEST_F(PeerTableTest, GapsInTheSequenceAreCountedAsLost) {
  Hear(2, 90, milliseconds(0));
  Hear(2, 94, milliseconds(10));
  EXPECT_EQ(counters_.lost, 3U);
}

TEST_F(PeerTableTest, BeyondTheEmissionRadiusIsNotHeardAndNoLoss) {
  HearAtTheRim(2, 97, milliseconds(0));
  Take(Received(BeaconOf(2, 98, {.position_world = {5.02, 0}}), milliseconds(50)));
  EXPECT_EQ(counters_.not_heard, 1U);
  EXPECT_FALSE(Fresh(2, milliseconds(50)));
  EXPECT_FALSE(IsLost(*table_->Find(VehicleId{2}), Fresh(2, milliseconds(900))));
  Hear(2, 99, milliseconds(100));
  EXPECT_TRUE(Fresh(2, milliseconds(100)));
  EXPECT_EQ(counters_.lost, 0U);
}

// During the tick that its first beacon waits, what is known of it is as old as when it left.
TEST_F(PeerTableTest, OneThatComesBackIntoReachIsNotLostUntilItsBeaconCounts) {
  HearAtTheRim(2, 97, milliseconds(0));
  Take(Received(BeaconOf(2, 98, {.position_world = {5.02, 0}}), milliseconds(50)));
  self_.tick = Tick{120};
  const milliseconds now(1000);
  Hear(2, 120, now);  // of this tick: it waits
  EXPECT_FALSE(Fresh(2, now));
  EXPECT_FALSE(IsLost(*table_->Find(VehicleId{2}), Fresh(2, now)));
  self_.tick = Tick{121};
  table_->Advance(now + milliseconds(50), self_.tick);
  EXPECT_TRUE(Fresh(2, now + milliseconds(50)));
}

// The waiting one is older than the one from out of range.
TEST_F(PeerTableTest, OneThatLeavesWhileABeaconWaitsIsNoLossEither) {
  HearAtTheRim(2, 99, milliseconds(0));
  HearAtTheRim(2, 100, milliseconds(50));
  Take(Received(BeaconOf(2, 101, {.position_world = {5.02, 0}}), milliseconds(50)));
  self_.tick = Tick{130};
  table_->Advance(milliseconds(1500), self_.tick);
  EXPECT_TRUE(IsGone(*table_->Find(VehicleId{2})));
  EXPECT_FALSE(IsLost(*table_->Find(VehicleId{2}), Fresh(2, milliseconds(1500))));
}

// By one beacon from far off it dropped the claim of where it was, and nothing was held against it.
TEST_F(PeerTableTest, OneThatJumpsOutOfReachIsDoubtedAndLost) {
  const auto jump = [this](std::uint32_t tick, milliseconds at) {
    self_.tick = Tick{tick + 1};
    Take(Received(BeaconOf(2, tick, {.position_world = {50, 0}}), at));
    return table_->Find(VehicleId{2});
  };
  Hear(2, 98, milliseconds(0));
  const Peer* peer = jump(99, milliseconds(50));
  EXPECT_EQ(trust_.jumps, 1U);
  EXPECT_EQ(trust_.Total(), 1U);
  EXPECT_TRUE(IsDoubted(peer->trust, milliseconds(50)));
  EXPECT_EQ(peer->beacon.tick, Tick{98});
  EXPECT_EQ(peer->last_seq, 99U);
  for (std::uint32_t tick = 100; tick < 138; ++tick) {
    peer = jump(tick, milliseconds(50 * (tick - 98)));
    EXPECT_FALSE(IsGone(*peer)) << tick;
  }
  EXPECT_TRUE(IsLost(*peer, Fresh(2, milliseconds(1950))));
  EXPECT_EQ(trust_.jumps, 1U) << "there is no second one";
  peer = jump(150, milliseconds(2600));
  EXPECT_TRUE(IsGone(*peer)) << "its claim has lapsed by now";
}

// A radio that holds a beacon back says nothing new by it, wherever it is from.
TEST_F(PeerTableTest, AnOldBeaconFromBeyondTheRadiusChangesNothing) {
  const Pose far{.position_world = {5.1, 0}};
  Hear(2, 97, milliseconds(0));
  Hear(2, 99, milliseconds(100));
  Take(Received(BeaconOf(2, 98, far), milliseconds(120)));
  Beacon of_other_life = BeaconOf(2, 120, far);
  of_other_life.boot_epoch = 7;
  Take(Received(of_other_life, milliseconds(120)));
  EXPECT_EQ(counters_.not_heard, 2U);
  EXPECT_FALSE(table_->Find(VehicleId{2})->out_of_reach);
  EXPECT_TRUE(Fresh(2, milliseconds(120)));
  EXPECT_EQ(table_->Find(VehicleId{2})->last_seq, 99U);
  Hear(2, 99, milliseconds(130));
  EXPECT_EQ(counters_.rejected_replayed, 1U);
}

// Regression: every start-up counted a refused beacon or two, though no sender had done anything
// wrong.
TEST_F(PeerTableTest, BeforeTheWorldIsHeardNobodyIsHeardAndNobodyIsRefused) {
  Beacon early = BeaconOf(2, 1, {});
  early.world_epoch = kNoEpoch;
  Take(Received(early, milliseconds(0)));
  self_.epoch = kNoEpoch;
  Hear(3, 99, milliseconds(0));
  EXPECT_EQ(counters_.not_heard, 2U);
  EXPECT_EQ(counters_.Rejected(), 0U);
}

// One that had left and was placed again was taken for lost until its first scan.
TEST_F(PeerTableTest, ABeaconThatAnswersNoScanChangesNothing) {
  Beacon good_bye = BeaconOf(2, 98, {});
  good_bye.mode = Mode::kLeaving;
  Take(Received(good_bye, milliseconds(0)));
  ReceivedBeacon placed = Received(BeaconOf(2, 0, {}), milliseconds(50));
  placed.beacon.seq = 1;
  placed.beacon.boot_epoch = 5;
  placed.writer = 77;
  Take(placed);
  EXPECT_EQ(counters_.not_heard, 1U);
  EXPECT_TRUE(IsGone(*table_->Find(VehicleId{2})));
  EXPECT_FALSE(IsLost(*table_->Find(VehicleId{2}), Fresh(2, milliseconds(50))));
}

TEST_F(PeerTableTest, TwoWritersForOneIdAreBothDistrustedAndNamed) {
  Hear(2, 98, milliseconds(0));
  ReceivedBeacon rival = Received(BeaconOf(2, 50, {}), milliseconds(10));
  rival.writer = 77;
  rival.beacon.boot_epoch = 5;
  Take(rival);
  EXPECT_FALSE(Fresh(2, milliseconds(10)));
  Hear(2, 99, milliseconds(50));
  EXPECT_FALSE(Fresh(2, milliseconds(50)));
  EXPECT_EQ(counters_.rejected_duplicate_id, 2U);
  EXPECT_EQ(table_->LastRejected(), VehicleId{2});
}

TEST_F(PeerTableTest, ARivalThatFallsSilentGivesTheIdBack) {
  Hear(2, 98, milliseconds(0));
  ReceivedBeacon rival = Received(BeaconOf(2, 50, {}), milliseconds(10));
  rival.writer = 77;
  rival.beacon.boot_epoch = 5;
  Take(rival);
  Hear(2, 99, milliseconds(300));
  EXPECT_TRUE(Fresh(2, milliseconds(300)));
}

TEST_F(PeerTableTest, ARestartedVehicleIsAcceptedOnceTheOldOneIsSilentPastItsLease) {
  Hear(2, 98, milliseconds(0));
  ReceivedBeacon restarted = Received(BeaconOf(2, 99, {}), milliseconds(251));
  restarted.writer = 77;
  restarted.beacon.boot_epoch = 5;
  restarted.beacon.seq = 1;
  Take(restarted);
  EXPECT_TRUE(Fresh(2, milliseconds(251)));
  EXPECT_EQ(counters_.rejected_duplicate_id, 0U);
}

TEST_F(PeerTableTest, ARestartedVehicleIsAcceptedAtOnceAfterAGoodBye) {
  Beacon good_bye = BeaconOf(2, 98, {});
  good_bye.mode = Mode::kLeaving;
  Take(Received(good_bye, milliseconds(0)));
  ReceivedBeacon restarted = Received(BeaconOf(2, 99, {}), milliseconds(20));
  restarted.writer = 77;
  restarted.beacon.boot_epoch = 5;
  Take(restarted);
  EXPECT_TRUE(Fresh(2, milliseconds(20)));
}

TEST_F(PeerTableTest, ADeadlineMissIsAnEdgeUntilTheNextAcceptedBeacon) {
  Hear(2, 98, milliseconds(0));
  const QosEvent miss{QosEventKind::kDeadlineMissed, VehicleId{2}, milliseconds(150)};
  for (int i = 0; i < 3; ++i) table_->Note(miss, &qos_);
  EXPECT_EQ(qos_.deadline_missed, 1U);
  EXPECT_FALSE(Fresh(2, milliseconds(150)));
  Hear(2, 99, milliseconds(160));
  EXPECT_TRUE(Fresh(2, milliseconds(160)));
  table_->Note(miss, &qos_);
  EXPECT_EQ(qos_.deadline_missed, 2U);
  EXPECT_EQ(table_->LastDeadlineMissed(), VehicleId{2});
}

TEST_F(PeerTableTest, LostLivelinessDistrustsAtOnceAndNamesThePeer) {
  Hear(2, 99, milliseconds(0));
  table_->Note({QosEventKind::kLivelinessLost, VehicleId{2}, milliseconds(10)}, &qos_);
  EXPECT_FALSE(Fresh(2, milliseconds(10)));
  EXPECT_EQ(table_->LastLivelinessLost(), VehicleId{2});
}

TEST_F(PeerTableTest, AfterAGoodByeSilenceIsNeitherLossNorMiss) {
  Beacon good_bye = BeaconOf(2, 99, {});
  good_bye.mode = Mode::kLeaving;
  Take(Received(good_bye, milliseconds(0)));
  EXPECT_FALSE(Fresh(2, milliseconds(0)));
  table_->Note({QosEventKind::kDeadlineMissed, VehicleId{2}, milliseconds(150)}, &qos_);
  table_->Note({QosEventKind::kLivelinessLost, VehicleId{2}, milliseconds(250)}, &qos_);
  EXPECT_EQ(qos_.deadline_missed, 0U);
  EXPECT_EQ(qos_.liveliness_lost, 0U);
  EXPECT_FALSE(IsLost(*table_->Find(VehicleId{2}), Fresh(2, milliseconds(900))));
}

TEST_F(PeerTableTest, AFullTableRefusesTheNextAndSaysSo) {
  for (std::uint32_t id = 2; id < 2 + kMaxPeers; ++id) Hear(id, 99, milliseconds(0));
  EXPECT_EQ(counters_.rejected_table_full, 0U);
  Hear(5000, 99, milliseconds(0));
  EXPECT_EQ(counters_.rejected_table_full, 1U);
  EXPECT_EQ(table_->Peers().size(), kMaxPeers);
}

TEST_F(PeerTableTest, AForgottenPeerLeavesItsPlace) {
  Hear(2, 99, milliseconds(0));
  Hear(3, 99, milliseconds(20'000));
  table_->Advance(milliseconds(30'001), Tick{700});
  ASSERT_EQ(table_->Peers().size(), 1U);
  EXPECT_EQ(table_->Peers()[0].id, VehicleId{3});
  EXPECT_EQ(table_->Find(VehicleId{2}), nullptr);
  EXPECT_EQ(table_->Find(VehicleId{3}), &table_->Peers()[0]);
}

}  // namespace
}  // namespace giveway
