// Which senders are believed, and what of them: sessions and their participants, possible ticks,
// entries and samples in range.
#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <limits>

#include "services/auth/digest.h"
#include "services/link/inbox/entry_check.h"
#include "services/link/inbox/sample_check.h"
#include "services/link/inbox/session_owners.h"
#include "services/link/inbox/tick_gate.h"
#include "services/link/inbox/world_binding.h"

namespace giveway::link {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Verdict = SessionOwners::Verdict;

constexpr SteadyTime kBegun = seconds(100);
constexpr VehicleId kSeven{7};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

JoinRequest Ask(std::uint32_t session) { return {.session = {session, 0, 0, 1}}; }

// Participant p asks by the writer 100 + p.
class Sessions : public ::testing::Test {
 protected:
  Verdict AskBy(std::uint64_t participant, std::uint32_t session, SteadyTime now = kBegun) {
    return owners_.MayAsk(Ask(session), participant, 100 + participant, now,
                          [this](std::uint64_t writer) { return writer == left_; });
  }
  SessionOwners owners_;
  std::uint64_t left_ = 0;
};

TEST_F(Sessions, ASessionIsOfTheParticipantThatAskedFirstWhileItIsHeard) {
  EXPECT_EQ(AskBy(1, 5), Verdict::kYes);
  EXPECT_EQ(AskBy(2, 5), Verdict::kOfAnother);
  EXPECT_EQ(AskBy(1, 5), Verdict::kYes);
  owners_.Accept(kSeven, Ask(5).session);
  EXPECT_EQ(owners_.OwnerOf(kSeven), 1U);
  for (int i = 1; i <= 40; ++i) {
    const SteadyTime now = kBegun + i * milliseconds(50);
    owners_.Heard(kSeven, now);
    EXPECT_EQ(AskBy(2, 5, now), Verdict::kOfAnother) << i;
  }
}

TEST_F(Sessions, ASessionGoesToAnotherParticipantOnceItsOwnHasLeftOrIsSilent) {
  AskBy(1, 5);
  owners_.Accept(kSeven, Ask(5).session);
  owners_.Heard(kSeven, kBegun);
  EXPECT_EQ(AskBy(2, 5, kBegun + SessionOwners::kSilence), Verdict::kOfAnother);
  EXPECT_EQ(AskBy(2, 5, kBegun + SessionOwners::kSilence + milliseconds(1)), Verdict::kYes);
  EXPECT_EQ(owners_.OwnerOf(kSeven), 2U);
  left_ = 102;
  EXPECT_EQ(AskBy(3, 5, kBegun + seconds(1)), Verdict::kYes);
  EXPECT_EQ(owners_.OwnerOf(kSeven), 3U);
}

// It was 0.75 s from the moment it got its place, during which it may not have discovered its
// scans.
TEST_F(Sessions, OneThatJustGotItsPlaceIsGivenTimeUntilItsFirstCommand) {
  AskBy(1, 5);
  owners_.Accept(kSeven, Ask(5).session);
  const SteadyTime later = kBegun + SessionOwners::kSilenceBeforeCommands;
  EXPECT_EQ(AskBy(2, 5, later), Verdict::kOfAnother);
  owners_.Heard(kSeven, later);
  EXPECT_EQ(AskBy(2, 5, later + SessionOwners::kSilence), Verdict::kOfAnother);
  AskBy(1, 5, later + SessionOwners::kSilence);
  EXPECT_EQ(AskBy(2, 5, later + SessionOwners::kSilenceBeforeCommands), Verdict::kOfAnother)
      << "asking again restarts the time";
  EXPECT_EQ(AskBy(2, 5, later + seconds(4)), Verdict::kYes);
}

TEST_F(Sessions, OfSlowTicksAFewMayGoByInSilence) {
  SessionOwners owners(milliseconds(200));
  const auto stays = [](std::uint64_t) { return false; };
  owners.MayAsk(Ask(5), 1, 101, kBegun, stays);
  owners.Accept(kSeven, Ask(5).session);
  owners.Heard(kSeven, kBegun);
  EXPECT_EQ(owners.MayAsk(Ask(5), 2, 102, kBegun + seconds(1), stays), Verdict::kOfAnother);
  EXPECT_EQ(owners.MayAsk(Ask(5), 2, 102, kBegun + milliseconds(1001), stays), Verdict::kYes);
}

TEST_F(Sessions, OnlyTheOwnerLeavesOrWhoKnowsTheSecret) {
  const SessionId secret{1, 2, 3, 4};
  JoinRequest request{.session = auth::SessionOf(secret)};
  owners_.MayAsk(request, 1, 101, kBegun, [](std::uint64_t) { return false; });
  request.leaving = true;
  EXPECT_EQ(owners_.MayLeave(request, 2), Verdict::kOfAnother);
  request.secret = {4, 3, 2, 1};
  EXPECT_EQ(owners_.MayLeave(request, 2), Verdict::kOfAnother);
  request.secret = secret;
  EXPECT_EQ(owners_.MayLeave(request, 2), Verdict::kYes);
  EXPECT_EQ(owners_.MayLeave(Ask(9), 1), Verdict::kOfAnother) << "never asked with";
}

TEST_F(Sessions, AnOwnerMayLeaveTwice) {
  AskBy(1, 5);
  EXPECT_EQ(owners_.MayLeave(Ask(5), 1), Verdict::kYes);
  EXPECT_EQ(owners_.MayLeave(Ask(5), 1), Verdict::kYes);
  EXPECT_EQ(owners_.MayLeave(Ask(5), 2), Verdict::kOfAnother);
}

TEST_F(Sessions, OfOneParticipantAFewAreHeardAndAsManyAgainOnceTheyLeft) {
  for (std::uint32_t i = 0; i < SessionOwners::kMostOfOne; ++i) {
    EXPECT_EQ(AskBy(1, i), Verdict::kYes);
  }
  EXPECT_EQ(AskBy(1, 1000), Verdict::kTooMany);
  EXPECT_EQ(AskBy(2, 1000), Verdict::kYes);
  owners_.MayLeave(Ask(0), 1);
  EXPECT_EQ(AskBy(1, 1001), Verdict::kYes);
  EXPECT_EQ(AskBy(1, 1002), Verdict::kTooMany);
}

TEST_F(Sessions, AreBoundedAndTheOldestWithoutAPlaceGoFirst) {
  AskBy(1, 1);
  owners_.Accept(kSeven, Ask(1).session);
  AskBy(2, 2);
  for (std::uint32_t i = 10; owners_.Sessions() < SessionOwners::kMostSessions; ++i) {
    AskBy(1000 + i, 1000 + i);
  }
  AskBy(3, 3);
  EXPECT_EQ(owners_.Sessions(), SessionOwners::kMostSessions);
  EXPECT_EQ(owners_.OwnerOf(kSeven), 1U);
  EXPECT_EQ(AskBy(4, 2), Verdict::kYes) << "it was evicted: any participant may ask with it";
}

TEST_F(Sessions, OfOneEveryVehicleIsKnownUntilItsPlaceEnds) {
  AskBy(1, 5);
  AskBy(2, 6);
  owners_.Accept(kSeven, Ask(5).session);
  owners_.Accept(VehicleId{8}, Ask(5).session);
  owners_.Accept(kSeven, Ask(5).session);
  EXPECT_THAT(owners_.VehiclesOf(Ask(5).session), ::testing::ElementsAre(kSeven, VehicleId{8}));
  owners_.Accept(VehicleId{8}, Ask(6).session);
  owners_.Close(kSeven);
  owners_.Close(kSeven);
  EXPECT_THAT(owners_.VehiclesOf(Ask(5).session), ::testing::IsEmpty());
  EXPECT_THAT(owners_.VehiclesOf(Ask(6).session), ::testing::ElementsAre(VehicleId{8}));
  EXPECT_EQ(owners_.OwnerOf(VehicleId{8}), 2U);
}

// Regression: with 256 vehicles the world searched all of them, for each session, every 32 ticks.
TEST_F(Sessions, WithAPlaceAreNotLookedAtToBeForgotten) {
  for (std::uint32_t i = 1; i <= 256; ++i) {
    AskBy(i, i);
    owners_.Accept(VehicleId{i}, Ask(i).session);
  }
  AskBy(1000, 1000);
  AskBy(1001, 1001);
  std::vector<std::uint64_t> asked;
  owners_.Forget([&](std::uint64_t writer) {
    asked.push_back(writer);
    return writer == 1100;
  });
  EXPECT_THAT(asked, ::testing::ElementsAre(1100U, 1101U));
  EXPECT_EQ(owners_.Sessions(), 257U);
  owners_.Close(kSeven);
  owners_.Forget([](std::uint64_t) { return true; });
  EXPECT_EQ(owners_.Sessions(), 255U);
}

TEST(TickGate, RefusesTicksThatNoTimeHasPassedFor) {
  TickGate gate(milliseconds(50));
  const WorldEpoch epoch{1};
  EXPECT_TRUE(gate.Passes(epoch, Tick{1000}, kBegun));
  EXPECT_FALSE(gate.Passes(epoch, Tick{0x8000'0000}, kBegun));
  EXPECT_TRUE(gate.Passes(epoch, Tick{1001}, kBegun + milliseconds(50)));
  EXPECT_FALSE(gate.Passes(epoch, Tick{1001 + TickGate::kAhead + 1}, kBegun + milliseconds(50)));
  EXPECT_TRUE(gate.Passes(epoch, Tick{1020 + TickGate::kAhead}, kBegun + milliseconds(1000)));
  EXPECT_TRUE(gate.Passes(epoch, Tick{900}, kBegun + milliseconds(1000))) << "late is not ahead";
  EXPECT_TRUE(gate.Passes(WorldEpoch{2}, Tick{5}, kBegun + milliseconds(1050)));
  EXPECT_FALSE(gate.Passes(WorldEpoch{2}, Tick{500}, kBegun + milliseconds(1100)));
}

TEST(TickGate, BelievesTheNextAfterALongTimeWithoutOne) {
  TickGate gate(milliseconds(50));
  gate.Passes(WorldEpoch{1}, Tick{1}, kBegun);
  const SteadyTime later = kBegun + TickGate::kForgets;
  EXPECT_FALSE(gate.Passes(WorldEpoch{1}, Tick{1'000'000}, later));
  EXPECT_TRUE(gate.Passes(WorldEpoch{1}, Tick{1'000'000}, later + milliseconds(1)));
}

TEST(WorldBinding, IsFollowedOnlyWhenItLeftOrIsSilent) {
  WorldBinding world;
  EXPECT_TRUE(world.MayBeFollowed(kBegun, false)) << "there is none";
  world.Bind(1, 11, kBegun);
  EXPECT_TRUE(world.IsWorld(1));
  EXPECT_FALSE(world.MayBeFollowed(kBegun + WorldBinding::kSilenceToAWaiting, false));
  EXPECT_TRUE(world.MayBeFollowed(kBegun, true));
  world.ExpectScans(kBegun);
  EXPECT_FALSE(world.MayBeFollowed(kBegun + WorldBinding::kSilence, false));
  EXPECT_TRUE(world.MayBeFollowed(kBegun + WorldBinding::kSilence + milliseconds(1), false));
  world.Heard(kBegun + seconds(9));
  EXPECT_FALSE(world.MayBeFollowed(kBegun + seconds(10), false));
}

RosterEntry Sound() {
  return {.session = {1, 2, 3, 4},
          .vehicle = kSeven,
          .accepted = true,
          .epoch = WorldEpoch{1},
          .start_world = {{1, 2}, 0.5}};
}

std::string FieldOf(const std::optional<FieldFault>& fault) { return fault ? fault->field : ""; }

TEST(EntryCheck, NamesTheFieldThatCannotBeBelieved) {
  EXPECT_EQ(FieldOf(FaultOf(Sound(), kSeven)), "");
  EXPECT_EQ(FieldOf(FaultOf(Sound(), kNoVehicle)), "");
  EXPECT_EQ(FieldOf(FaultOf(Sound(), VehicleId{8})), "vehicle");
  RosterEntry entry = Sound();
  entry.epoch = kNoEpoch;
  EXPECT_EQ(FieldOf(FaultOf(entry, kSeven)), "world_epoch");
  entry = Sound();
  entry.vehicle = kNoVehicle;
  EXPECT_EQ(FieldOf(FaultOf(entry, kNoVehicle)), "vehicle");
  entry = Sound();
  entry.start_world.position_world.x = kNan;
  EXPECT_EQ(FieldOf(FaultOf(entry, kSeven)), "start_world.x_m");
  entry = Sound();
  entry.start_world.position_world.y = 1e6;
  EXPECT_EQ(FieldOf(FaultOf(entry, kSeven)), "start_world.y_m");
  entry = Sound();
  entry.start_world.heading_rad = 4;
  EXPECT_EQ(FieldOf(FaultOf(entry, kSeven)), "start_world.heading_rad");
  entry = Sound();
  entry.counted.right_rad = std::numeric_limits<double>::infinity();
  EXPECT_EQ(FieldOf(FaultOf(entry, kSeven)), "counted_right_rad");
  entry = Sound();
  entry.accepted = false;
  entry.vehicle = VehicleId{99};
  EXPECT_EQ(FieldOf(FaultOf(entry, kSeven)), "") << "a refusal says why, and nothing else";
}

RangeScan SoundScan() {
  RangeScan scan;
  scan.vehicle = kSeven;
  scan.epoch = WorldEpoch{1};
  scan.tick = Tick{10};
  return scan;
}

TEST(SampleCheck, NamesTheFieldOfAScanThatCannotBeBelieved) {
  EXPECT_EQ(FieldOf(FaultOf(SoundScan())), "");
  RangeScan scan = SoundScan();
  scan.tick = kNoTick;
  EXPECT_EQ(FieldOf(FaultOf(scan)), "tick");
  scan = SoundScan();
  scan.wheels.left_rad_s = kNan;
  EXPECT_EQ(FieldOf(FaultOf(scan)), "left_rad_s");
  scan = SoundScan();
  scan.counted.left_rad = 1e10;
  EXPECT_EQ(FieldOf(FaultOf(scan)), "counted_left_rad");
  scan = SoundScan();
  scan.readings[3] = {Echo::kEcho, -1, Tick{9}, 0};
  EXPECT_EQ(FieldOf(FaultOf(scan)), "range_m");
  scan = SoundScan();
  scan.readings[3].tick = Tick{11};
  EXPECT_EQ(FieldOf(FaultOf(scan)), "fired_tick");
}

TEST(SampleCheck, NamesTheFieldOfOtherSamplesThatCannotBeBelieved) {
  RadarScan radar;
  radar.epoch = WorldEpoch{1};
  radar.tick = Tick{1};
  radar.count = 1;
  EXPECT_EQ(FieldOf(FaultOf(radar)), "");
  radar.detections[0].bearing_rad = 7;
  EXPECT_EQ(FieldOf(FaultOf(radar)), "detections.bearing_rad");
  SignalState signal;
  signal.id = SignalId{1};
  signal.epoch = WorldEpoch{1};
  signal.tick = Tick{1};
  EXPECT_EQ(FieldOf(FaultOf(signal)), "");
  signal.to_change_s = -1;
  EXPECT_EQ(FieldOf(FaultOf(signal)), "to_change_s");
  MotorCommand command;
  EXPECT_EQ(FieldOf(FaultOf(command)), "");
  command.target.right_rad_s = 1e9;
  EXPECT_EQ(FieldOf(FaultOf(command)), "right_rad_s");
}

}  // namespace
}  // namespace giveway::link
