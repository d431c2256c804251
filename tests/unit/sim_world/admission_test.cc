#include "sim_world/run/admission.h"

#include <gtest/gtest.h>

#include "tests/unit/sim_world/door.h"

namespace giveway::sim {
namespace {

TEST(Admission, WhoeverComesToAnOpenFleetGetsTheLowestFreeIdAndTheFirstFreePlace) {
  Door door(OpenScenario());
  door.speed_rad_s = 0;
  const RosterEntry first = door.Join(Ask(1));
  EXPECT_EQ(first.vehicle, VehicleId{1});
  EXPECT_EQ(first.spawn, 1U);
  EXPECT_EQ(first.start_world, (Pose{{0, 0}, 0}));
  const RosterEntry second = door.Join(Ask(2));
  EXPECT_EQ(second.vehicle, VehicleId{3});  // 2 is named
  EXPECT_EQ(second.spawn, 2U);
  const RosterEntry named = door.Join(Ask(3, 2));
  EXPECT_EQ(named.vehicle, VehicleId{2});
  EXPECT_EQ(named.spawn, 0U);
}

TEST(Admission, WhoFindsNoFreePlaceWaitsAndIsLetInWhenOneComesFree) {
  Door door(OpenScenario());
  door.speed_rad_s = 0;
  door.Join(Ask(1));
  door.Join(Ask(2));
  const RosterEntry third = door.Join(Ask(3));
  EXPECT_FALSE(third.accepted);
  EXPECT_TRUE(third.waiting);
  EXPECT_EQ(third.reason, "no start place is free");
  for (int second = 0; second < 10; ++second) {
    door.admission.Take(Ask(3));  // it keeps asking, and is answered once
    door.Tick(20);
    EXPECT_TRUE(door.answers.empty());
  }
  door.run.Start();
  door.speed_rad_s = 5;
  for (int second = 0; second < 3; ++second) {
    door.admission.Take(Ask(3));
    door.Tick(20);
  }
  EXPECT_TRUE(door.admission.Informed().contains(VehicleId{4}));
  EXPECT_EQ(door.Count(EventKind::kJoined), 1U);
}

TEST(Admission, WhoAsksNoMoreIsForgotten) {
  Door door(OpenScenario());
  door.speed_rad_s = 0;
  door.Join(Ask(1));
  door.Join(Ask(2));
  door.Join(Ask(3));
  door.Tick(100);
  door.Leave(1);
  door.Tick(2);
  EXPECT_EQ(door.admission.Informed().size(), 1U);
}

TEST(Admission, WhoLeavesIsGoneAtOnceAndItsIdAndPlaceAreFree) {
  Door door(OpenScenario());
  door.Join(Ask(1));
  door.run.Start();
  door.Tick(5);
  door.Leave(1);
  EXPECT_EQ(door.run.BodyOf(VehicleId{1}), nullptr);
  EXPECT_EQ(door.admission.TakeGone(), std::vector{VehicleId{1}});
  door.Tick();
  EXPECT_EQ(door.Count(EventKind::kLeft), 1U);
  const RosterEntry next = door.Join(Ask(2));
  EXPECT_EQ(next.vehicle, VehicleId{1});
  EXPECT_EQ(next.start_world, (Pose{{0, 0}, 0}));
}

TEST(Admission, ARestartedVehicleGetsItsIdBackOnceTheOldOneIsSilentWhereItsBodyStands) {
  Door door(OpenScenario());
  door.Join(Ask(1));
  door.run.Start();
  door.Tick(40);
  door.dead.insert(VehicleId{1});
  const RosterEntry early = door.Join(Ask(9, 1));
  EXPECT_TRUE(early.waiting);
  EXPECT_EQ(early.reason, "id 1 is taken by another session");
  int ticks = 0;
  while (door.admission.Informed().at(VehicleId{1}).session != Ask(9).session && ticks < 60) {
    door.Tick();
    ++ticks;
  }
  EXPECT_LE(ticks, 21);  // a second after its last command
  ASSERT_EQ(door.answers.size(), 2U);
  const RosterEntry back = door.answers.front();
  EXPECT_TRUE(back.accepted);
  EXPECT_EQ(back.vehicle, VehicleId{1});
  EXPECT_EQ(back.spawn, 1U);
  EXPECT_GT(back.start_world.position_world.x, 0.2);
  EXPECT_EQ(back.start_world, door.run.BodyOf(VehicleId{1})->world_from_body);
  // The old session, if it still exists, is answered that it is out.
  EXPECT_EQ(door.answers.back().session, Ask(1).session);
  EXPECT_FALSE(door.answers.back().accepted);
  EXPECT_FALSE(door.answers.back().waiting);
  door.dead.clear();
  door.Tick(40);
  EXPECT_GT(door.run.BodyOf(VehicleId{1})->ForwardSpeed(), 0.1);
  EXPECT_EQ(door.Count(EventKind::kRemoved), 0U);
}

TEST(Admission, AnIdWhoseOwnerGoesOnSpeakingIsRefusedForGood) {
  Door door(OpenScenario());
  door.Join(Ask(1, 2));
  door.run.Start();
  EXPECT_TRUE(door.Join(Ask(9, 2)).waiting);
  RosterEntry last;
  for (int i = 0; i < 70 && door.answers.size() != 1; ++i) door.Tick();
  for (int i = 0; i < 70; ++i) {
    door.Tick();
    if (!door.answers.empty()) last = door.answers.front();
  }
  EXPECT_EQ(last.session, Ask(9).session);
  EXPECT_FALSE(last.waiting);
  EXPECT_FALSE(last.accepted);
  EXPECT_EQ(last.reason, "id 2 is taken by another session");
}

TEST(Admission, ASilentVehicleOfAnOpenFleetIsRemovedInTimeAndTheRunGoesOn) {
  Door door(OpenScenario());
  door.Join(Ask(1));
  door.Join(Ask(2));
  door.run.Start();
  door.Tick(20);
  door.dead.insert(VehicleId{1});
  door.Tick(22);
  EXPECT_EQ(door.Count(EventKind::kSilent), 1U);
  EXPECT_NE(door.run.BodyOf(VehicleId{1}), nullptr);
  for (int i = 0; i < 45 && door.admission.Informed().contains(VehicleId{1}); ++i) door.Tick();
  EXPECT_EQ(door.run.BodyOf(VehicleId{1}), nullptr);
  EXPECT_EQ(door.admission.TakeGone(), std::vector{VehicleId{1}});
  door.Tick();
  ASSERT_EQ(door.answers.size(), 1U);
  EXPECT_EQ(door.answers[0].session, Ask(1).session);
  EXPECT_FALSE(door.answers[0].accepted);
  EXPECT_TRUE(door.answers[0].waiting);  // should it be there after all, it may ask again
  EXPECT_EQ(door.run.State(), RunState::kRunning);
  EXPECT_EQ(door.Join(Ask(3)).vehicle, VehicleId{1});
}

TEST(Admission, ASilentVehicleOfAnOpenFleetThatSpeaksAgainIsBack) {
  Door door(OpenScenario());
  door.Join(Ask(1));
  door.run.Start();
  door.Tick(20);
  door.dead.insert(VehicleId{1});
  door.Tick(30);
  door.dead.clear();
  door.Tick(60);
  EXPECT_EQ(door.Count(EventKind::kSilent), 1U);
  EXPECT_EQ(door.Count(EventKind::kJoined), 1U);
  EXPECT_EQ(door.Count(EventKind::kRemoved), 0U);
  EXPECT_GT(door.run.BodyOf(VehicleId{1})->ForwardSpeed(), 0.1);
}

TEST(Admission, AVehicleKilledByPlanMayComeBackIntoAClosedRun) {
  Door door(ClosedScenario());
  door.Join(Ask(1, 1));
  door.Join(Ask(2, 2));
  door.run.Start();
  door.Tick(12);
  ASSERT_EQ(door.Count(EventKind::kFaultDue), 1U);
  door.dead.insert(VehicleId{1});
  door.Tick(25);
  EXPECT_TRUE(door.Join(Ask(9, 1)).accepted);
  door.dead.clear();
  door.Tick(30);
  EXPECT_EQ(door.run.State(), RunState::kRunning);
  EXPECT_GT(door.run.BodyOf(VehicleId{1})->ForwardSpeed(), 0.1);
  door.dead.insert(VehicleId{1});  // this death is not planned
  door.Tick(25);
  EXPECT_EQ(door.run.EndReason(), "process_died");
}

TEST(Admission, WhoAsksAgainWithItsSessionHasTimeForItsFirstWords) {
  Door door(ClosedScenario());
  door.Join(Ask(1, 1));
  door.Join(Ask(2, 2));
  door.run.Start();
  door.Tick(5);
  door.dead.insert(VehicleId{2});  // it restarts itself
  door.Tick(10);
  EXPECT_TRUE(door.Join(Ask(2, 2)).accepted);
  door.Tick(80);  // four seconds; without the question one is the end of a closed run
  EXPECT_EQ(door.run.State(), RunState::kRunning);
  door.Tick(25);  // but not for ever
  EXPECT_EQ(door.run.EndReason(), "process_died");
}

TEST(Admission, AskingAgainDoesNotBringBackWhoWasSilentForTooLong) {
  Door door(ClosedScenario());
  door.Join(Ask(1, 1));
  door.Join(Ask(2, 2));
  door.run.Start();
  door.Tick(5);
  door.dead.insert(VehicleId{2});
  door.Tick(25);
  door.Join(Ask(2, 2));
  EXPECT_EQ(door.run.EndReason(), "process_died");
}

TEST(Admission, AGoodByeEndsAClosedRun) {
  Door door(ClosedScenario());
  door.Join(Ask(1, 1));
  door.Join(Ask(2, 2));
  door.run.Start();
  door.Tick(5);
  door.Leave(2);
  door.Tick();
  EXPECT_EQ(door.run.EndReason(), "vehicle_left");
}

TEST(Admission, AnOpenRunLastsForItsDurationWhoeverArrives) {
  Scenario scenario = OpenScenario();
  scenario.duration_s = 5;
  scenario.spawns[0].goal = {.set = true, .at_world = {0.5, 0}, .radius_m = 0.2};
  scenario.expect.arrived = {VehicleId{1}};
  Door door(scenario);
  door.Join(Ask(1));
  door.run.Start();
  door.Tick(40);
  door.speed_rad_s = 0;
  door.Tick(59);
  EXPECT_EQ(door.Count(EventKind::kArrived), 1U);
  EXPECT_EQ(door.run.State(), RunState::kRunning);
  door.Tick();
  EXPECT_EQ(door.run.EndReason(), "duration_over");
  EXPECT_TRUE(door.run.Figures().passed) << door.run.Figures().reason;
}

TEST(Admission, AWorldThatStartsAnewGivesARunningVehicleOfAnOpenFleetItsIdBack) {
  Door door(OpenScenario());
  EXPECT_EQ(door.Join(Ask(1, 7)).vehicle, VehicleId{7});
  EXPECT_EQ(door.Join(Ask(2)).vehicle, VehicleId{1});
}

// The vehicles keep their sessions and ask again; the answer is where they stand.
TEST(Admission, ARestoredWorldKnowsItsSessionsAndWhereTheyStandOnceTheyStand) {
  constexpr WorldEpoch kNext{8};
  Door before(OpenScenario());
  before.Join(Ask(1));
  before.Join(Ask(2, 2));
  before.run.Start();
  before.Tick(40);
  Door after(OpenScenario(), kNext);
  ASSERT_TRUE(after.admission.Restore(before.admission.Save(5)));
  EXPECT_EQ(after.admission.Expected(), (std::vector{VehicleId{1}, VehicleId{2}}));
  EXPECT_TRUE(after.admission.Informed().empty());
  EXPECT_EQ(after.Join(Ask(1, 1)).epoch, kNoEpoch);  // it still rolls: no answer yet
  after.Tick(40);
  const auto& informed = after.admission.Informed();
  ASSERT_TRUE(informed.contains(VehicleId{1}));
  const RosterEntry& entry = informed.at(VehicleId{1});
  EXPECT_EQ(entry.epoch, kNext);
  EXPECT_EQ(entry.spawn, 1U);
  EXPECT_EQ(entry.start_world, after.run.BodyOf(VehicleId{1})->world_from_body);
  EXPECT_GT(entry.start_world.position_world.x,
            before.run.BodyOf(VehicleId{1})->world_from_body.position_world.x);
  EXPECT_FALSE(informed.contains(VehicleId{2}));
  EXPECT_DOUBLE_EQ(after.run.TimeSeconds(), before.run.TimeSeconds());  // it waits
}

}  // namespace
}  // namespace giveway::sim
