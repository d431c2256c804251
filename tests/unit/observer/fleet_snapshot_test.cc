#include "services/observer/fleet/fleet_snapshot.h"

#include <gtest/gtest.h>

namespace giveway {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr VehicleId kOne{1};
constexpr VehicleId kTwo{2};
constexpr WorldEpoch kWorld{7};

ReceivedBeacon BeaconOf(VehicleId vehicle) {
  ReceivedBeacon received{.crc_valid = true, .name_valid = true, .writer = 1};
  received.beacon.vehicle = vehicle;
  return received;
}

VehicleStatus StatusOf(VehicleId vehicle, bool final = false) {
  VehicleStatus status;
  status.vehicle = vehicle;
  status.final = final;
  return status;
}

Truth TruthOf(VehicleId vehicle, double time_s, WorldEpoch epoch = kWorld) {
  return {.vehicle = vehicle, .epoch = epoch, .time_s = time_s};
}

Truth GoneOf(VehicleId vehicle) {
  return {.vehicle = vehicle, .epoch = kWorld, .time_s = 2, .present = false};
}

RosterEntry EntryOf(RunState state, WorldEpoch epoch = kWorld) {
  RosterEntry entry;
  entry.epoch = epoch;
  entry.run_state = state;
  entry.fleet_size = 2;
  return entry;
}

Liveness LivenessOf(const FleetSnapshot& fleet, VehicleId vehicle, SteadyTime now) {
  return fleet.Vehicles().at(vehicle).LivenessAt(now);
}

TEST(FleetSnapshot, NobodyIsThereUntilSomebodyIsHeard) {
  FleetSnapshot fleet;
  fleet.Fold({}, seconds(3));
  EXPECT_FALSE(fleet.IsAnyHeard());
  fleet.Fold({.beacons = {BeaconOf(kOne)}}, seconds(3));
  EXPECT_TRUE(fleet.IsAnyHeard());
}

TEST(FleetSnapshot, AVehicleFallsSilentASecondAfterItsLastWordByEitherTopic) {
  FleetSnapshot fleet;
  fleet.Fold({.beacons = {BeaconOf(kOne)}}, seconds(1));
  fleet.Fold({.statuses = {StatusOf(kOne)}}, milliseconds(1500));
  EXPECT_EQ(LivenessOf(fleet, kOne, milliseconds(2500)), Liveness::kHeard);
  EXPECT_EQ(LivenessOf(fleet, kOne, milliseconds(2501)), Liveness::kSilent);
}

TEST(FleetSnapshot, ASilentVehicleStaysAndIsHeardAgainWhenItSpeaks) {
  FleetSnapshot fleet;
  fleet.Fold({.statuses = {StatusOf(kOne)}}, seconds(1));
  fleet.Fold({}, seconds(60));
  EXPECT_EQ(LivenessOf(fleet, kOne, seconds(60)), Liveness::kSilent);
  fleet.Fold({.statuses = {StatusOf(kOne)}}, seconds(61));
  EXPECT_EQ(LivenessOf(fleet, kOne, seconds(61)), Liveness::kHeard);
}

TEST(FleetSnapshot, OneThatSaidItsLastWordsHasLeftUntilItComesBack) {
  FleetSnapshot fleet;
  fleet.Fold({.statuses = {StatusOf(kOne, true)}, .beacons = {BeaconOf(kOne)}}, seconds(1));
  EXPECT_EQ(LivenessOf(fleet, kOne, seconds(1)), Liveness::kLeft);
  EXPECT_EQ(LivenessOf(fleet, kOne, seconds(60)), Liveness::kLeft);
  fleet.Fold({.statuses = {StatusOf(kOne)}}, seconds(61));
  EXPECT_EQ(LivenessOf(fleet, kOne, seconds(61)), Liveness::kHeard);
}

// A crashed vehicle comes back under another id; its old one stayed silent until the observer was
// restarted, and the alert for it never resolved.
TEST(FleetSnapshot, ASilentVehicleIsDroppedMinutesAfterTheWorldHasTakenItsBodyOut) {
  const SteadyTime late = seconds(1) + FleetSnapshot::kDroppedAfter;
  FleetSnapshot fleet;
  fleet.Fold({.truths = {TruthOf(kOne, 1)}, .statuses = {StatusOf(kOne)}}, seconds(1));
  fleet.Fold({.truths = {TruthOf(kOne, 2)}}, late + seconds(1));
  EXPECT_TRUE(fleet.Vehicles().contains(kOne)) << "its body stands in the world";
  fleet.Fold({.truths = {GoneOf(kOne)}}, late);
  EXPECT_TRUE(fleet.Vehicles().contains(kOne)) << "the alert has not fired yet";
  fleet.Fold({}, late + seconds(1));
  EXPECT_FALSE(fleet.Vehicles().contains(kOne));
}

TEST(FleetSnapshot, OneThatWasNeverHeardIsDroppedWithItsBody) {
  FleetSnapshot fleet;
  fleet.Fold({.truths = {TruthOf(kOne, 1), TruthOf(kTwo, 1)}}, seconds(1));
  fleet.Fold({.truths = {GoneOf(kOne)}}, seconds(2));
  EXPECT_FALSE(fleet.Vehicles().contains(kOne));
  EXPECT_TRUE(fleet.Vehicles().contains(kTwo));
}

TEST(FleetSnapshot, BodiesOfAnEarlierWorldHoldNoSilentVehicle) {
  FleetSnapshot fleet;
  fleet.Fold({.truths = {TruthOf(kOne, 1)}, .statuses = {StatusOf(kOne)}}, seconds(1));
  fleet.Fold({.truths = {TruthOf(kTwo, 1, WorldEpoch{8})}}, seconds(500));
  EXPECT_FALSE(fleet.Vehicles().contains(kOne));
}

constexpr std::uint64_t kParticipant = 5;

// The alert WorldSilent fired for it.
TEST(FleetSnapshot, AWorldThatIsThereWithoutBodiesIsHeardAlthoughItPublishesNothing) {
  FleetSnapshot fleet;
  EXPECT_FALSE(fleet.World().IsHeard(seconds(1)));
  fleet.Fold({.world = kParticipant}, seconds(1));
  EXPECT_TRUE(fleet.World().IsHeard(seconds(9)));
  EXPECT_FALSE(fleet.IsSettled(seconds(9))) << "nothing is known of its vehicles";
  fleet.Fold({.truths = {TruthOf(kOne, 1)}, .world = kParticipant}, seconds(10));
  fleet.Fold({.truths = {GoneOf(kOne)}, .world = kParticipant}, seconds(11));
  EXPECT_TRUE(fleet.World().IsHeard(seconds(19))) << "its last vehicle has left";
  fleet.Fold({}, seconds(20));
  EXPECT_FALSE(fleet.World().IsHeard(seconds(20))) << "it has left, too";
}

TEST(FleetSnapshot, AWorldWithBodiesIsHeardOnlyWhileItPublishes) {
  FleetSnapshot fleet;
  fleet.Fold({.truths = {TruthOf(kOne, 1)}, .world = kParticipant}, seconds(1));
  fleet.Fold({.world = kParticipant}, seconds(3));
  EXPECT_FALSE(fleet.World().IsHeard(seconds(3)));
  fleet.Fold({.world = kParticipant + 1}, seconds(12));
  EXPECT_TRUE(fleet.World().IsHeard(seconds(12))) << "the next one, which has none yet";
}

TEST(FleetSnapshot, OneThatClaimsIdsWithoutEndTakesNoMoreThanSoMany) {
  FleetSnapshot fleet;
  for (std::uint32_t id = 1; id <= FleetSnapshot::kMostVehicles + 10; ++id) {
    fleet.Fold({.beacons = {BeaconOf(VehicleId{id})}}, SteadyTime{id});
  }
  EXPECT_EQ(fleet.Vehicles().size(), FleetSnapshot::kMostVehicles);
  EXPECT_FALSE(fleet.Vehicles().contains(VehicleId{10}))
      << "the first to fall silent is dropped first";
  EXPECT_TRUE(fleet.Vehicles().contains(VehicleId{11}));
}

TEST(FleetSnapshot, ABodyThatSaysNothingIsKnownAndNeverHeard) {
  FleetSnapshot fleet;
  fleet.Fold({.truths = {TruthOf(kTwo, 1)}}, seconds(1));
  EXPECT_EQ(LivenessOf(fleet, kTwo, seconds(1)), Liveness::kNever);
}

TEST(FleetSnapshot, WhatIsBrokenOrUnderAWrongNameIsNoVehicle) {
  FleetSnapshot fleet;
  ReceivedBeacon broken = BeaconOf(kOne);
  broken.crc_valid = false;
  ReceivedBeacon false_name = BeaconOf(kTwo);
  false_name.name_valid = false;
  fleet.Fold({.beacons = {broken, false_name}}, seconds(1));
  EXPECT_TRUE(fleet.Vehicles().empty());
}

TEST(FleetSnapshot, TheWorldsStateIsTheLatestThatAnybodyTold) {
  FleetSnapshot fleet;
  fleet.Fold({.truths = {TruthOf(kOne, -1)}}, seconds(1));
  EXPECT_FALSE(fleet.World().state.has_value());
  fleet.Fold({.roster = {EntryOf(RunState::kRunning), EntryOf(RunState::kWaiting)}}, seconds(1));
  EXPECT_EQ(fleet.World().state, RunState::kRunning);
  fleet.Fold({.events = {{.kind = EventKind::kEnded, .epoch = kWorld, .time_s = 9}}}, seconds(2));
  EXPECT_EQ(fleet.World().state, RunState::kEnded);
  EXPECT_EQ(fleet.World().time_s, 9);
}

TEST(FleetSnapshot, AnotherWorldBeginsAnew) {
  FleetSnapshot fleet;
  fleet.Fold({.truths = {TruthOf(kOne, 12)}, .roster = {EntryOf(RunState::kEnded)}}, seconds(1));
  fleet.Fold({.truths = {TruthOf(kOne, 1, WorldEpoch{8})}}, seconds(2));
  EXPECT_EQ(fleet.World().epoch, WorldEpoch{8});
  EXPECT_FALSE(fleet.World().state.has_value());
  EXPECT_EQ(fleet.World().time_s, 1);
}

TEST(FleetSnapshot, SettlesASecondAfterTheLastNewcomer) {
  FleetSnapshot fleet;
  EXPECT_FALSE(fleet.IsSettled(seconds(100)));
  fleet.Fold({.statuses = {StatusOf(kOne)}, .beacons = {BeaconOf(kOne)}}, seconds(1));
  fleet.Fold({.statuses = {StatusOf(kTwo)}, .beacons = {BeaconOf(kOne), BeaconOf(kTwo)}},
             milliseconds(1900));
  EXPECT_FALSE(fleet.IsSettled(milliseconds(2899)));
  EXPECT_TRUE(fleet.IsSettled(milliseconds(2900)));
}

// Its status is another writer's, and may be found later than its beacons.
TEST(FleetSnapshot, DoesNotSettleWhileAVehicleWhoseBeaconsComeMayStillTellItsStatus) {
  FleetSnapshot fleet;
  fleet.Fold({.beacons = {BeaconOf(kOne)}}, seconds(1));
  EXPECT_FALSE(fleet.IsSettled(milliseconds(4999)));
  EXPECT_TRUE(fleet.IsSettled(seconds(5)));  // it has none
  fleet.Fold({.statuses = {StatusOf(kOne)}}, milliseconds(2500));
  EXPECT_TRUE(fleet.IsSettled(milliseconds(2500)));
}

TEST(FleetSnapshot, DoesNotSettleWhileABodyHasNotSpoken) {
  FleetSnapshot fleet;
  fleet.Fold({.truths = {TruthOf(kOne, 1)}}, seconds(1));
  EXPECT_FALSE(fleet.IsSettled(seconds(10)));
  fleet.Fold({.statuses = {StatusOf(kOne)}}, seconds(10));
  EXPECT_TRUE(fleet.IsSettled(seconds(10)));
}

}  // namespace
}  // namespace giveway
