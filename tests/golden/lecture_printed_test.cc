// The ten flaws of the printed scripts, in the lecture's order, one row each: a scenario, and how
// the flaw shows in it. The printed behaviour has it. lecture_yield and cooperative drive the same
// scenario without it: no two bodies touch, and every vehicle that lives arrives.
#include <gtest/gtest.h>

#include <map>
#include <ostream>
#include <utility>

#include "tests/support/crossing.h"

namespace giveway {
namespace {

using test::Crossing;
using test::ScenarioOf;
using test::VehicleAt;
using Ids = std::set<std::uint32_t>;
using Pair = std::pair<std::uint32_t, std::uint32_t>;

// What is observed of a run. It ends with the first contact.
struct Story {
  std::uint32_t contacts = 0;
  Ids arrived;
  Ids halted;                  // stood still to give way
  Ids deaf;                    // stopped for something that came near unheard
  std::set<Pair> gave_way;     // {the vehicle that gives way, its peer}, driving or standing
  bool both_at_once = false;   // two gave way to each other in one tick
  double last_for_dead_s = 0;  // the last time a vehicle gave way to one that had died
  std::map<std::uint32_t, double> fastest_m_s;
  std::map<std::uint32_t, double> turned_rad;  // to either side, in all

  friend void PrintTo(const Story& story, std::ostream* out) {
    *out << "contacts " << story.contacts << ", arrived " << testing::PrintToString(story.arrived)
         << ", halted " << testing::PrintToString(story.halted) << ", gave way "
         << testing::PrintToString(story.gave_way) << ", to the dead until "
         << story.last_for_dead_s << " s, fastest " << testing::PrintToString(story.fastest_m_s)
         << ", turned " << testing::PrintToString(story.turned_rad);
  }
};

bool IsDead(std::uint32_t vehicle, const sim::VirtualFleet& fleet) {
  const auto& faults = fleet.TheScenario().faults;
  return std::any_of(faults.begin(), faults.end(), [&](const PlannedFault& fault) {
    return Number(fault.vehicle) == vehicle && fleet.World().TimeSeconds() > *fault.at_s;
  });
}

// The pairs of vehicles in this tick of which the first gives way to the second.
std::set<Pair> GivingWay(const sim::VirtualFleet& fleet) {
  std::set<Pair> pairs;
  for (std::size_t i = 0; i < fleet.Size(); ++i) {
    const Decision& decision = fleet.OutputsOf(i).command.decision;
    if (!fleet.Answered(i) || decision.rule != Rule::kGiveWay) continue;
    pairs.insert({Number(fleet.OutputsOf(i).command.vehicle), Number(decision.peer)});
  }
  return pairs;
}

void WatchMotion(const sim::VirtualFleet& fleet, Story* story) {
  for (const Truth& truth : fleet.World().Truths()) {
    const std::uint32_t id = Number(truth.vehicle);
    const double turn = TwistFromWheels(PioneerP3dx().drive, truth.wheels).turn_rad_s;
    story->turned_rad[id] += (turn < 0 ? -turn : turn) * Seconds(fleet.TheScenario().tick_period);
    story->fastest_m_s[id] = std::max(story->fastest_m_s[id], truth.forward_m_s);
  }
}

void WatchDecisions(const sim::VirtualFleet& fleet, Story* story) {
  for (std::size_t i = 0; i < fleet.Size(); ++i) {
    const MotorCommand& command = fleet.OutputsOf(i).command;
    if (command.decision.rule == Rule::kUnidentifiedMotion)
      story->deaf.insert(Number(command.vehicle));
  }
  const std::set<Pair> now = GivingWay(fleet);
  for (const auto& [who, to_whom] : now) {
    story->gave_way.insert({who, to_whom});
    story->both_at_once |= now.contains({to_whom, who});
    if (IsDead(to_whom, fleet)) story->last_for_dead_s = fleet.World().TimeSeconds();
  }
}

void WatchEvents(const sim::VirtualFleet& fleet, Story* story) {
  for (const WorldEvent& event : fleet.World().Events()) {
    if (event.kind == EventKind::kArrived) story->arrived.insert(Number(event.vehicle));
    if (event.kind == EventKind::kHalted) story->halted.insert(Number(event.vehicle));
    if (event.kind == EventKind::kContact) ++story->contacts;
  }
}

Story RunStory(const Scenario& scenario) {
  sim::VirtualFleet fleet(scenario);
  Story story;
  for (bool goes_on = true; goes_on && story.contacts == 0;) {
    goes_on = fleet.Advance();
    WatchMotion(fleet, &story);
    WatchDecisions(fleet, &story);
    WatchEvents(fleet, &story);
  }
  return story;
}

Scenario Unequal(Behaviour behaviour) { return Crossing(behaviour, 0.4, 0.3); }

Scenario Equal(Behaviour behaviour) { return Crossing(behaviour, 0.3, 0.3); }

// Before a crossing, near each other, at standstill.
Scenario StandingAtACrossing(Behaviour behaviour) {
  return ScenarioOf({VehicleAt(1, behaviour, 0.4, {-0.9, 0}, 0, 4),
                     VehicleAt(2, behaviour, 0.3, {0, -0.9}, 90, 4)});
}

// The third is heard last, drives well away from the others, and stands by then.
Scenario WithAThird(Behaviour behaviour) {
  Scenario scenario = Unequal(behaviour);
  scenario.vehicles.push_back(VehicleAt(3, behaviour, 0.2, {-2.5, 2}, 180, 1));
  return scenario;
}

// Vehicle 2 dies at its cruise speed, far from vehicle 1, and is towed away. Half a minute later
// vehicle 1 comes past a wall.
Scenario DeadLongAgo(Behaviour behaviour) {
  Scenario scenario = ScenarioOf({VehicleAt(1, behaviour, 0.3, {0, 0}, 0, 14),
                                  VehicleAt(2, behaviour, 0.4, {0, 2.5}, 180, 3)});
  scenario.walls = {{{12, -0.7}, {13, -0.7}}};
  scenario.faults = {{.kind = FaultKind::kKill, .vehicle = VehicleId{2}, .at_s = 3}};
  return scenario;
}

// Vehicle 2 turns on the spot to the goal behind it while vehicle 1 comes past.
Scenario PastOneThatTurns(Behaviour behaviour) {
  Scenario scenario = ScenarioOf({VehicleAt(1, behaviour, 0.1, {-1.2, 1.1}, 0, 3),
                                  VehicleAt(2, behaviour, 0.4, {0, 0}, 90, 2)});
  scenario.vehicles[1].goal.at_world = {0, -2};
  return scenario;
}

// Vehicle 2 is only within radio range.
Scenario AlongAWall(Behaviour behaviour) {
  Scenario scenario = ScenarioOf(
      {VehicleAt(1, behaviour, 0.3, {0, 0}, 0, 4), VehicleAt(2, behaviour, 0.4, {0, 2.5}, 180, 3)});
  scenario.walls = {{{1, -0.7}, {3, -0.7}}};
  return scenario;
}

Scenario NoseToNose(Behaviour behaviour) {
  return ScenarioOf({VehicleAt(1, behaviour, 0.4, {-0.5, 0}, 0, 3),
                     VehicleAt(2, behaviour, 0.3, {0.5, 0}, 180, 3)});
}

// 0.6 m from centre to centre: 0.1 m from shell to shell.
Scenario ShortRadio(Behaviour behaviour) {
  Scenario scenario = Unequal(behaviour);
  for (VehicleOptions& vehicle : scenario.vehicles) vehicle.emission_radius_m = 0.6;
  return scenario;
}

Scenario DeadAhead(Behaviour behaviour) {
  return ScenarioOf({VehicleAt(1, behaviour, 0.195, {-1.5, 0}, 0, 4),
                     VehicleAt(2, behaviour, 0.195, {1.5, 0}, 180, 4)});
}

bool MatchesSpeed(const Story& s) {
  return s.contacts > 0 && s.gave_way.contains({2, 1}) && s.halted.empty() &&
         s.fastest_m_s.at(2) > 0.35;  // its cruise is 0.3
}

bool BothGiveWayAndMeet(const Story& s) { return s.contacts > 0 && s.both_at_once; }

bool BothStandForEver(const Story& s) {
  return s.both_at_once && s.halted == Ids{1, 2} && s.arrived.empty();
}

// Without the third it would at least react: MatchesSpeed.
bool GivesWayToNobody(const Story& s) { return s.contacts > 0 && s.gave_way.empty(); }

bool BelievesTheDead(const Story& s) { return s.last_for_dead_s > 3 + 30; }

bool TurnsAlong(const Story& s) {
  return s.gave_way.contains({1, 2}) && s.turned_rad.at(1) > 0.3;  // its path is straight
}

bool GivesWayBecauseOfTheWall(const Story& s) { return s.gave_way == std::set<Pair>{{1, 2}}; }

bool DrivesOnDeaf(const Story& s) { return s.contacts > 0 && s.deaf.empty(); }

bool Rams(const Story& s) { return s.contacts > 0; }

struct Flaw {
  const char* name;
  Scenario (*scenario)(Behaviour);
  bool (*shows)(const Story&);
  Ids arrive = {1, 2};  // where it is settled
  Behaviour printed = Behaviour::kLecturePrinted;

  friend void PrintTo(const Flaw& flaw, std::ostream* out) { *out << flaw.name; }
};

// The tenth concerns the lecture's other behaviour, Braitenberg's vehicle 2a.
const Flaw kFlaws[] = {
    {"No1TheLoserCopiesThePeersSpeed", Unequal, MatchesSpeed},
    {"No2EqualSpeedsSendBothToGiveWay", Equal, BothGiveWayAndMeet},
    {"No3ComparingSpeedsOfTheMomentNobodyStartsAgain", StandingAtACrossing, BothStandForEver},
    {"No4AThirdsBeaconHidesTheNeighbour", WithAThird, GivesWayToNobody, {1, 2, 3}},
    {"No5ADeadPeerIsBelievedForEver", DeadLongAgo, BelievesTheDead, {1}},
    {"No6OneThatSpinsCountsAsFast", PastOneThatTurns, TurnsAlong},
    {"No7AWallTriggersTheRightOfWay", AlongAWall, GivesWayBecauseOfTheWall},
    {"No8TwoParkedNoseToNoseNeverLeave", NoseToNose, BothStandForEver},
    {"No9CriticalAndDeafItDrivesOn", ShortRadio, DrivesOnDeaf},
    {"No10TheAvoiderRamsWhatIsDeadAhead", DeadAhead, Rams, {1, 2}, Behaviour::kLectureAvoid},
};

class PrintedFlaw : public testing::TestWithParam<Flaw> {};

TEST_P(PrintedFlaw, IsShownAsPrinted) {
  const Story story = RunStory(GetParam().scenario(GetParam().printed));
  EXPECT_TRUE(GetParam().shows(story)) << testing::PrintToString(story);
}

TEST_P(PrintedFlaw, IsSettledByTheOtherBehaviours) {
  for (const Behaviour behaviour : {Behaviour::kLectureYield, Behaviour::kCooperative}) {
    SCOPED_TRACE(Name(behaviour));
    const Story story = RunStory(GetParam().scenario(behaviour));
    EXPECT_FALSE(GetParam().shows(story)) << testing::PrintToString(story);
    EXPECT_EQ(story.contacts, 0U);
    EXPECT_EQ(story.arrived, GetParam().arrive) << testing::PrintToString(story);
  }
}

INSTANTIATE_TEST_SUITE_P(Lecture, PrintedFlaw, testing::ValuesIn(kFlaws),
                         [](const auto& test) { return test.param.name; });

TEST(PrintedScripts, AreNeverADefault) {
  EXPECT_EQ(VehicleOptions{}.behaviour, Behaviour::kCooperative);
}

}  // namespace
}  // namespace giveway
