#include "sim_world/admission.h"

#include <gmock/gmock.h>

#include <chrono>
#include <set>

#include "sim_world/line_budget.h"
#include "tests/unit/sim_scenario.h"

namespace giveway::sim {
namespace {

VehicleOptions SpawnAt(double x_m) {
  VehicleOptions options = VehicleAt(0, {{x_m, 0}, 0});
  options.id = kNobody;
  return options;
}

// Vehicle 2 is named; two places for whoever comes.
Scenario OpenScenario() {
  Scenario scenario = ScenarioOf({VehicleAt(2, {{0, 10}, 0})});
  scenario.spawns = {SpawnAt(0), SpawnAt(10)};
  scenario.remove_after_s = 2;
  return scenario;
}

Scenario ClosedScenario() {
  Scenario scenario = ScenarioOf({VehicleAt(1, {{0, 0}, 0}), VehicleAt(2, {{0, 10}, 0})});
  scenario.faults = {{.kind = FaultKind::kKill, .vehicle = VehicleId{1}, .at_s = 0.5}};
  scenario.remove_after_s = 2;
  return scenario;
}

JoinRequest Ask(std::uint32_t session, std::uint32_t wanted = 0) {
  return {.session = {session, 0, 0, 1}, .wanted = VehicleId{wanted}};
}

// A world, its door, and vehicles that drive straight on as soon as they are in.
class Door {
 public:
  explicit Door(const Scenario& scenario, WorldEpoch epoch = kEpoch)
      : run(scenario, epoch), admission(scenario, epoch, &run), epoch_(epoch) {}

  void Tick(int ticks = 1) {
    for (int i = 0; i < ticks; ++i) {
      answers.clear();
      for (const RosterEntry& entry : admission.Answer()) answers.push_back(entry);
      std::vector<MotorCommand> commands;
      for (const auto& [vehicle, entry] : admission.Told()) {
        if (dead.contains(vehicle)) continue;
        commands.push_back(Drive(Number(vehicle), run.Now(), speed_rad_s, speed_rad_s));
        commands.back().epoch = epoch_;
      }
      run.Advance(commands);
      admission.FollowRun();
      for (const WorldEvent& event : run.Events()) events.push_back(event);
    }
  }
  // The answer of the tick in which it asks.
  RosterEntry Join(const JoinRequest& request) {
    admission.Take(request);
    Tick();
    for (const RosterEntry& entry : answers) {
      if (entry.session == request.session) return entry;
    }
    return {};
  }
  void Leave(std::uint32_t session) {
    JoinRequest request = Ask(session);
    request.leaving = true;
    admission.Take(request);
  }
  std::size_t Count(EventKind kind) const {
    return static_cast<std::size_t>(std::ranges::count(events, kind, &WorldEvent::kind));
  }

  Run run;
  Admission admission;
  std::set<VehicleId> dead;
  double speed_rad_s = 3;
  std::vector<RosterEntry> answers;  // of the last tick
  std::vector<WorldEvent> events;

 private:
  WorldEpoch epoch_;
};

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
    door.admission.Take(Ask(3));  // it goes on asking, and is told once
    door.Tick(20);
    EXPECT_TRUE(door.answers.empty());
  }
  door.run.Start();
  door.speed_rad_s = 5;
  for (int second = 0; second < 3; ++second) {
    door.admission.Take(Ask(3));
    door.Tick(20);
  }
  EXPECT_TRUE(door.admission.Told().contains(VehicleId{4}));
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
  EXPECT_EQ(door.admission.Told().size(), 1U);
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
  while (door.admission.Told().at(VehicleId{1}).session != Ask(9).session && ticks < 60) {
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
  // The old session, should it still be there, is told that it is out.
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
  for (int i = 0; i < 45 && door.admission.Told().contains(VehicleId{1}); ++i) door.Tick();
  EXPECT_EQ(door.run.BodyOf(VehicleId{1}), nullptr);
  EXPECT_EQ(door.admission.TakeGone(), std::vector{VehicleId{1}});
  door.Tick();
  ASSERT_EQ(door.answers.size(), 1U);
  EXPECT_EQ(door.answers[0].session, Ask(1).session);
  EXPECT_FALSE(door.answers[0].accepted);
  EXPECT_TRUE(door.answers[0].waiting);  // should it be there after all, it may ask anew
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

// The vehicles know their sessions and ask again; what they are told is where they stand.
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
  EXPECT_TRUE(after.admission.Told().empty());
  EXPECT_EQ(after.Join(Ask(1, 1)).epoch, kNoEpoch);  // it still rolls: no answer yet
  after.Tick(40);
  const auto& told = after.admission.Told();
  ASSERT_TRUE(told.contains(VehicleId{1}));
  const RosterEntry& entry = told.at(VehicleId{1});
  EXPECT_EQ(entry.epoch, kNext);
  EXPECT_EQ(entry.spawn, 1U);
  EXPECT_EQ(entry.start_world, after.run.BodyOf(VehicleId{1})->world_from_body);
  EXPECT_GT(entry.start_world.position_world.x,
            before.run.BodyOf(VehicleId{1})->world_from_body.position_world.x);
  EXPECT_FALSE(told.contains(VehicleId{2}));
  EXPECT_DOUBLE_EQ(after.run.TimeSeconds(), before.run.TimeSeconds());  // it waits
}

// Issue 21, number 12: 30 000 requests in 6 s.
TEST(Admission, AFloodOfRequestsCostsATickNoMoreThanTheWaitingListHolds) {
  Door door(OpenScenario());
  door.speed_rad_s = 0;
  ASSERT_TRUE(door.Join(Ask(1)).accepted);
  ASSERT_TRUE(door.Join(Ask(2)).accepted);
  std::size_t answers = 0;
  for (std::uint32_t tick = 0; tick < 120; ++tick) {
    for (std::uint32_t i = 0; i < 250; ++i) door.admission.Take(Ask(1000 + tick * 250 + i));
    door.Tick();
    EXPECT_LE(door.answers.size(), Admission::kMostWaiting);
    answers += door.answers.size();
  }
  EXPECT_LE(answers, 4 * Admission::kMostWaiting) << "each once in the three seconds it waits";
  EXPECT_GE(door.admission.PassedOver(), 29'000U);
  // Who is in is known all the while, and who comes after the flood has its turn.
  EXPECT_TRUE(door.Join(Ask(2)).accepted);
  door.Tick(61);
  door.Leave(2);
  EXPECT_TRUE(door.Join(Ask(3)).accepted);
}

TEST(Admission, WhoNeverSpeaksLosesItsPlaceSoonerThanWhoFellSilent) {
  Scenario scenario = OpenScenario();
  scenario.remove_after_s = 30;
  Door door(scenario);
  door.run.Start();
  door.dead = {VehicleId{1}};
  ASSERT_TRUE(door.Join(Ask(1)).accepted);
  door.Tick(198);
  EXPECT_NE(door.run.BodyOf(VehicleId{1}), nullptr);
  door.Tick(6);
  EXPECT_EQ(door.run.BodyOf(VehicleId{1}), nullptr);
}

// Issue 21, number 11: of every vehicle that ever was, a body stayed, and a truth was sent each
// tick.
TEST(Admission, OfVehiclesThatLeftNothingIsKeptOrTold) {
  Door door(OpenScenario());
  door.run.Start();
  door.speed_rad_s = 0;
  for (std::uint32_t id = 100; id < 400; ++id) {
    ASSERT_TRUE(door.Join(Ask(id, id)).accepted);
    door.Tick();
    door.Leave(id);
    door.Tick();
  }
  EXPECT_LE(door.run.Truths().size(), 12U) << "those that left within the last second";
  door.Tick(20);
  EXPECT_THAT(door.run.Forgotten(), ::testing::ElementsAre(VehicleId{399}));
  door.Tick();
  EXPECT_THAT(door.run.Truths(), ::testing::IsEmpty());
  // One of them comes again, and is told of at once.
  ASSERT_TRUE(door.Join(Ask(7, 399)).accepted);
  EXPECT_THAT(door.run.Truths(), ::testing::SizeIs(1));
}

TEST(LineBudget, LeavesOutWhatIsTooMuchForASecondAndSaysHowMany) {
  LineBudget budget(2);
  const SteadyTime start = std::chrono::seconds(5);
  EXPECT_TRUE(budget.Take(start));
  EXPECT_TRUE(budget.Take(start));
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(budget.Take(start + std::chrono::milliseconds(500)));
  EXPECT_EQ(budget.TakeLeftOut(start + std::chrono::milliseconds(999)), 0U);
  EXPECT_TRUE(budget.Take(start + std::chrono::milliseconds(1000)));
  EXPECT_EQ(budget.TakeLeftOut(start + std::chrono::milliseconds(1001)), 10U);
  EXPECT_EQ(budget.TakeLeftOut(start + std::chrono::milliseconds(1002)), 0U);
}

}  // namespace
}  // namespace giveway::sim
