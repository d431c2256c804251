// The ten flaws of the printed scripts (the lecture's order), one row each: a scenario in which
// the printed behaviour shows the flaw, and what it looks like. lecture_yield and cooperative drive
// the same scenario without it: no contact, and everyone who can arrives.
#include <gtest/gtest.h>

#include <functional>
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

// What can be told of a run from outside.
struct Story {
  std::uint32_t contacts = 0;
  Ids arrived;
  Ids halted;                  // stood still to give way
  Ids deaf;                    // said that it stops for something it cannot hear
  std::set<Pair> gave_way;     // {vehicle, for whom}, driving or standing
  bool both_at_once = false;   // two gave way to each other in one tick
  double last_for_dead_s = 0;  // when somebody last gave way to one that had died
  std::map<std::uint32_t, double> fastest_m_s;
  std::map<std::uint32_t, double> turned_rad;  // to either side, in all
};

struct Flaw {
  int number;
  const char* name;
  Behaviour printed;
  std::function<Scenario(Behaviour)> scenario;
  std::function<bool(const Story&)> shows;  // true of the printed behaviour, of no other
  Ids arrive;                               // with the other behaviours

  friend void PrintTo(const Flaw& flaw, std::ostream* out) { *out << flaw.number << flaw.name; }
};

void Watch(const sim::VirtualFleet& fleet, Story* story) {
  const double dt_s = Seconds(fleet.TheScenario().tick_period);
  for (const Truth& truth : fleet.World().Truths()) {
    double& fastest = story->fastest_m_s[Number(truth.vehicle)];
    fastest = std::max(fastest, truth.forward_m_s);
  }
  std::set<Pair> now;
  for (std::size_t i = 0; i < fleet.Size(); ++i) {
    if (!fleet.Answered(i)) continue;
    const std::uint32_t id = Number(fleet.TheScenario().vehicles[i].id);
    const Outputs& said = fleet.Said(i);
    const Decision& decision = said.command.decision;
    const VehicleOptions& options = fleet.TheScenario().vehicles[i];
    const double turn = TwistFromWheels(options.profile.drive, said.beacon.wheels).turn_rad_s;
    story->turned_rad[id] += dt_s * (turn < 0 ? -turn : turn);
    if (decision.rule == Rule::kDeaf) story->deaf.insert(id);
    if (decision.rule == Rule::kGiveWay) now.insert({id, Number(decision.peer)});
  }
  for (const Pair& pair : now) {
    story->gave_way.insert(pair);
    story->both_at_once |= now.contains({pair.second, pair.first});
    for (const PlannedFault& fault : fleet.TheScenario().faults) {
      const bool dead = fault.at_s && fleet.World().TimeSeconds() > *fault.at_s;
      if (dead && pair.second == Number(fault.vehicle)) {
        story->last_for_dead_s = fleet.World().TimeSeconds();
      }
    }
  }
}

Story Tell(const Scenario& scenario) {
  sim::VirtualFleet fleet(scenario);
  Story story;
  while (fleet.Advance()) Watch(fleet, &story);
  for (const WorldEvent& event : fleet.History()) {
    if (event.kind == EventKind::kArrived) story.arrived.insert(Number(event.vehicle));
    if (event.kind == EventKind::kHalted) story.halted.insert(Number(event.vehicle));
  }
  story.contacts = fleet.World().Figures().contacts;
  return story;
}

std::vector<Flaw> Flaws();

class PrintedFlaw : public testing::TestWithParam<Flaw> {};

TEST_P(PrintedFlaw, IsShownByThePrintedScripts) {
  const Flaw& flaw = GetParam();
  const Story story = Tell(flaw.scenario(flaw.printed));
  EXPECT_TRUE(flaw.shows(story)) << testing::PrintToString(story.gave_way) << " contacts "
                                 << story.contacts << " arrived "
                                 << testing::PrintToString(story.arrived) << " halted "
                                 << testing::PrintToString(story.halted);
}

TEST_P(PrintedFlaw, IsSettledByTheOtherBehaviours) {
  const Flaw& flaw = GetParam();
  for (const Behaviour behaviour : {Behaviour::kLectureYield, Behaviour::kCooperative}) {
    SCOPED_TRACE(Name(behaviour));
    const Story story = Tell(flaw.scenario(behaviour));
    EXPECT_FALSE(flaw.shows(story));
    EXPECT_EQ(story.contacts, 0U);
    EXPECT_EQ(story.arrived, flaw.arrive);
  }
}

Scenario WithThird(Behaviour behaviour) {
  Scenario scenario = Crossing(behaviour, 0.4, 0.3);
  scenario.vehicles.push_back(VehicleAt(3, behaviour, 0.2, {-4, 2}, 180, 1.5));
  return scenario;
}

// Vehicle 2 dies before it has moved; vehicle 1 starts beside a wall, which echoes within the gate.
Scenario DeadAtTheStart(Behaviour behaviour) {
  Scenario scenario = ScenarioOf(
      {VehicleAt(1, behaviour, 0.3, {0, 0}, 0, 4), VehicleAt(2, behaviour, 0.4, {0, 2.5}, 180, 3)});
  scenario.walls = {{{-1, -0.7}, {3, -0.7}}};
  scenario.faults = {{FaultKind::kKill, VehicleId{2}, std::nullopt, 0.05}};
  return scenario;
}

// Vehicle 2 turns on the spot towards its goal behind it; vehicle 1 passes before its nose.
Scenario BesideOneThatTurns(Behaviour behaviour) {
  return ScenarioOf({VehicleAt(1, behaviour, 0.1, {-0.4, 1.0}, 0, 3),
                     VehicleAt(2, behaviour, 0.4, {0, 0}, 90, -2)});
}

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

// At a crossing, each within the other's gate, from standstill.
Scenario StandingAtACrossing(Behaviour behaviour) {
  return ScenarioOf({VehicleAt(1, behaviour, 0.4, {-0.9, 0}, 0, 4),
                     VehicleAt(2, behaviour, 0.3, {0, -0.9}, 90, 4)});
}

Scenario ShortRadio(Behaviour behaviour) {
  Scenario scenario = Crossing(behaviour, 0.4, 0.3);
  for (VehicleOptions& vehicle : scenario.vehicles) vehicle.emission_radius_m = 0.6;
  return scenario;
}

Scenario DeadAhead(Behaviour behaviour) {
  return ScenarioOf({VehicleAt(1, behaviour, 0.195, {-1.5, 0}, 0, 4),
                     VehicleAt(2, behaviour, 0.195, {1.5, 0}, 180, 4)});
}

std::vector<Flaw> Flaws() {
  constexpr Behaviour kPrinted = Behaviour::kLecturePrinted;
  return {
      {1,
       "CopiesThePeersSpeed",
       kPrinted,
       [](Behaviour b) { return Crossing(b, 0.4, 0.3); },
       [](const Story& s) {
         return s.gave_way.contains({2, 1}) && s.halted.empty() && s.fastest_m_s.at(2) > 0.35 &&
                s.contacts == 1;
       },
       {1, 2}},
      {2,
       "SendsBothOfEqualSpeedToGiveWay",
       kPrinted,
       [](Behaviour b) { return Crossing(b, 0.3, 0.3); },
       [](const Story& s) { return s.both_at_once && s.contacts == 1; },
       {1, 2}},
      {3,
       "NeverStartsAgainByComparingSpeedsOfTheMoment",
       kPrinted,
       StandingAtACrossing,
       [](const Story& s) {
         return s.halted == Ids{1, 2} && s.both_at_once && s.arrived.empty();
       },
       {1, 2}},
      {4,
       "LosesANeighbourToAThird",
       kPrinted,
       WithThird,
       [](const Story& s) {
         return !s.gave_way.contains({2, 1}) && s.contacts > 0;
       },
       {1, 2, 3}},
      {5,
       "BelievesTheDeadForEver",
       kPrinted,
       DeadAtTheStart,
       [](const Story& s) { return s.last_for_dead_s > 50 && s.arrived.empty(); },
       {1}},
      {6,
       "TakesOneThatSpinsForAFastOne",
       kPrinted,
       BesideOneThatTurns,
       [](const Story& s) { return s.turned_rad.at(1) > 2 * kPi; },
       {1, 2}},
      {7,
       "TakesAWallForThePeer",
       kPrinted,
       AlongAWall,
       [](const Story& s) {
         return s.gave_way == std::set<Pair>{{1, 2}};
       },
       {1, 2}},
      {8,
       "ParkedNoseToNoseNeverLeaves",
       kPrinted,
       NoseToNose,
       [](const Story& s) {
         return s.halted == Ids{1, 2} && s.arrived.empty();
       },
       {1, 2}},
      {9,
       "DrivesOnThoughCriticalAndDeaf",
       kPrinted,
       ShortRadio,
       [](const Story& s) { return s.deaf.empty() && s.contacts == 1; },
       {1, 2}},
      {10,
       "RamsWhatIsExactlyAhead",
       Behaviour::kLectureAvoid,
       DeadAhead,
       [](const Story& s) { return s.contacts == 1; },
       {1, 2}},
  };
}

INSTANTIATE_TEST_SUITE_P(Lecture, PrintedFlaw, testing::ValuesIn(Flaws()), [](const auto& test) {
  return "No" + std::to_string(test.param.number) + test.param.name;
});

TEST(PrintedScripts, AreNeverADefault) {
  EXPECT_EQ(VehicleOptions{}.behaviour, Behaviour::kCooperative);
}

}  // namespace
}  // namespace giveway
