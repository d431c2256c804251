#include "sim_world/run/run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "services/types/math/math.h"
#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

// Two on parallel lanes 2 m apart, each with a goal 2 m ahead.
Scenario TwoLanes() {
  Scenario scenario = ScenarioOf({VehicleAt(1, {{0, 0}, 0}), VehicleAt(2, {{0, 2}, 0})});
  for (VehicleOptions& options : scenario.vehicles) {
    options.goal = {.set = true, .at_world = options.start_world.position_world + Vec2{2, 0}};
  }
  scenario.expect.arrived = {kOne, kTwo};
  scenario.remove_after_s = 2;
  return scenario;
}

class Driver {
 public:
  explicit Driver(const Scenario& scenario) : run(scenario, kEpoch) {
    for (const VehicleOptions& options : scenario.vehicles) {
      run.Join(options.id);
      speaking.insert(options.id);
    }
  }
  void Advance(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      std::vector<MotorCommand> commands;
      for (const VehicleId vehicle : speaking) {
        const double wheels_rad_s = IsThere(vehicle) ? 0 : 4;
        commands.push_back(Drive(Number(vehicle), run.Now(), wheels_rad_s, wheels_rad_s));
      }
      run.Advance(commands);
      events.insert(events.end(), run.Events().begin(), run.Events().end());
    }
  }
  // Near enough to its goal to brake.
  bool IsThere(VehicleId vehicle) const {
    constexpr double kBraking_m = 0.15;
    const Body* const body = run.BodyOf(vehicle);
    return body != nullptr && body->goal.set &&
           Norm(body->goal.at_world - body->world_from_body.position_world) <= kBraking_m;
  }
  void AdvanceToEnd() {
    for (int i = 0; i < 4000 && run.State() != RunState::kEnded; ++i) Advance(1);
  }
  std::vector<EventKind> Kinds() const {
    std::vector<EventKind> kinds;
    for (const WorldEvent& event : events) kinds.push_back(event.kind);
    return kinds;
  }
  const WorldEvent* Find(EventKind kind) const {
    const auto event = std::ranges::find(events, kind, &WorldEvent::kind);
    return event == events.end() ? nullptr : &*event;
  }

  Run run;
  std::set<VehicleId> speaking;
  std::vector<WorldEvent> events;
};

TEST(Run, WaitsWithTicksScansAndStandingBodies) {
  Driver driver(TwoLanes());
  EXPECT_EQ(driver.run.Now(), kNoTick);
  driver.Advance(30);
  EXPECT_EQ(driver.run.Now(), Tick{30});
  EXPECT_EQ(driver.run.State(), RunState::kWaiting);
  EXPECT_EQ(driver.run.TimeSeconds(), 0);
  ASSERT_EQ(driver.run.Scans().size(), 2U);
  EXPECT_EQ(driver.run.Scans()[0].run_state, RunState::kWaiting);
  EXPECT_EQ(driver.run.Scans()[0].tick, Tick{30});
  EXPECT_EQ(driver.run.Scans()[0].epoch, kEpoch);
  EXPECT_LT(driver.run.Truths()[0].time_s, 0);
  EXPECT_EQ(driver.run.Truths()[0].world_from_body.position_world, Vec2{});
  EXPECT_TRUE(driver.events.empty());
}

TEST(Run, EveryoneJoinedOnceTheLastOneIsThere) {
  sim::Run run(TwoLanes(), kEpoch);
  run.Join(kTwo);
  EXPECT_FALSE(run.EveryoneJoined());
  run.Advance({});
  EXPECT_EQ(run.Scans().size(), 1U);
  run.Join(kOne);
  EXPECT_TRUE(run.EveryoneJoined());
}

TEST(Run, TimeCountsFromTheStartSignal) {
  Driver driver(TwoLanes());
  driver.Advance(10);
  driver.run.Start();
  driver.Advance(1);
  EXPECT_EQ(driver.run.State(), RunState::kRunning);
  EXPECT_DOUBLE_EQ(driver.run.TimeSeconds(), 0.05);
  EXPECT_DOUBLE_EQ(driver.run.Truths()[0].time_s, 0.05);
  ASSERT_EQ(driver.events.size(), 1U);
  EXPECT_EQ(driver.events[0].kind, EventKind::kStarted);
  EXPECT_EQ(driver.events[0].value, 2);
  EXPECT_GT(driver.run.Truths()[0].forward_m_s, 0);
}

TEST(Run, EndsWhenEveryoneHasArrivedAndPasses) {
  Driver driver(TwoLanes());
  driver.run.Start();
  driver.AdvanceToEnd();
  EXPECT_EQ(driver.run.EndReason(), "all_arrived");
  EXPECT_EQ(driver.Kinds(),
            (std::vector{EventKind::kStarted, EventKind::kArrived, EventKind::kArrived,
                         EventKind::kClosest, EventKind::kEnded, EventKind::kVerdict}));
  const RunFigures figures = driver.run.Figures();
  EXPECT_TRUE(figures.passed);
  EXPECT_EQ(figures.reason, "expectations_met");
  EXPECT_DOUBLE_EQ(figures.min_separation_m.value(), 1.5);
  EXPECT_DOUBLE_EQ(figures.time_to_clear_s.value(), driver.run.TimeSeconds());
  EXPECT_EQ(figures.state_hash, driver.run.Hash());
  EXPECT_EQ(driver.events.back().value, 1);
  EXPECT_EQ(driver.events.back().text, "expectations_met");
  EXPECT_EQ(driver.run.Scans()[0].run_state, RunState::kEnded);
}

TEST(Run, AnExpectationNotMetFailsWithItsName) {
  Scenario scenario = TwoLanes();
  scenario.expect.halted = {kTwo};
  Driver driver(scenario);
  driver.run.Start();
  driver.AdvanceToEnd();
  EXPECT_FALSE(driver.run.Figures().passed);
  EXPECT_EQ(driver.run.Figures().reason, "halted: expected 2, got none");
  EXPECT_EQ(driver.events.back().value, 0);
}

TEST(Run, EventsAreNumberedThroughTheEpoch) {
  Driver driver(TwoLanes());
  driver.run.Start();
  driver.AdvanceToEnd();
  for (std::size_t i = 0; i < driver.events.size(); ++i) {
    EXPECT_EQ(driver.events[i].seq, i + 1);
    EXPECT_EQ(driver.events[i].epoch, kEpoch);
  }
}

TEST(Run, AVehicleWithoutAGoalRunsForTheDuration) {
  Scenario scenario = TwoLanes();
  scenario.vehicles[1].goal.set = false;
  scenario.expect.arrived = {kOne};
  scenario.duration_s = 12;
  Driver driver(scenario);
  driver.run.Start();
  driver.AdvanceToEnd();
  EXPECT_EQ(driver.run.EndReason(), "duration_over");
  EXPECT_DOUBLE_EQ(driver.run.TimeSeconds(), 12);
  EXPECT_TRUE(driver.run.Figures().passed);
}

TEST(Run, OneWithoutAnEndGoesOnUntilItIsStopped) {
  Scenario scenario = TwoLanes();
  scenario.vehicles[1].goal.set = false;
  scenario.duration_s = 0;
  Driver driver(scenario);
  driver.run.Start();
  driver.Advance(100);
  EXPECT_EQ(driver.run.State(), RunState::kRunning);
  driver.run.End("interrupted");
  driver.Advance(1);
  EXPECT_EQ(driver.run.EndReason(), "interrupted");
}

TEST(Run, WhoDoesNotArriveInTimeIsNamed) {
  Scenario scenario = TwoLanes();
  scenario.duration_s = 1;
  Driver driver(scenario);
  driver.run.Start();
  driver.AdvanceToEnd();
  EXPECT_EQ(driver.run.Figures().reason, "arrived: expected 1 2, got none");
  EXPECT_FALSE(driver.run.Figures().time_to_clear_s.has_value());
}

TEST(Run, AnUnplannedSilenceEndsTheRunAfterASecond) {
  Driver driver(TwoLanes());
  driver.run.Start();
  driver.Advance(20);
  driver.speaking.erase(kTwo);
  driver.Advance(19);
  EXPECT_EQ(driver.run.State(), RunState::kRunning);
  driver.Advance(1);
  EXPECT_EQ(driver.run.State(), RunState::kEnded);
  EXPECT_EQ(driver.run.EndReason(), "process_died");
  EXPECT_FALSE(driver.run.Figures().passed);
  EXPECT_EQ(driver.run.Figures().reason, "process_died");
  ASSERT_NE(driver.Find(EventKind::kSilent), nullptr);
  EXPECT_EQ(driver.Find(EventKind::kSilent)->vehicle, kTwo);
}

TEST(Run, SilenceBeforeTheStartSignalIsNoSilence) {
  Driver driver(TwoLanes());
  driver.speaking.clear();
  driver.Advance(100);
  driver.run.Start();
  driver.Advance(19);
  EXPECT_EQ(driver.run.State(), RunState::kRunning);
  driver.Advance(1);
  EXPECT_EQ(driver.run.EndReason(), "process_died");
}

TEST(Run, AnInvalidCommandIsNoSignOfLife) {
  Driver driver(TwoLanes());
  driver.run.Start();
  driver.speaking.erase(kTwo);
  for (int i = 0; i < 20; ++i) {
    MotorCommand broken = Drive(2, driver.run.Now(), 4, 4);
    broken.target.left_rad_s = std::numeric_limits<double>::quiet_NaN();
    const MotorCommand commands[] = {Drive(1, driver.run.Now(), 4, 4), broken};
    driver.run.Advance(commands);
  }
  EXPECT_EQ(driver.run.EndReason(), "process_died");
}

Scenario PlannedDeath() {
  Scenario scenario = TwoLanes();
  scenario.faults = {{.vehicle = kTwo, .at_s = 1}};
  scenario.expect.arrived = {kOne};
  scenario.vehicles[0].goal.at_world = {5, 0};
  return scenario;
}

TEST(Run, APlannedDeathIsNotWaitedForAndItsBodyIsRemoved) {
  Driver driver(PlannedDeath());
  driver.run.Start();
  driver.Advance(20);
  ASSERT_NE(driver.Find(EventKind::kFaultDue), nullptr);
  EXPECT_EQ(driver.Find(EventKind::kFaultDue)->time_s, 1);
  driver.speaking.erase(kTwo);
  driver.Advance(20 + 39);
  ASSERT_NE(driver.Find(EventKind::kSilent), nullptr);
  EXPECT_TRUE(driver.run.Truths()[1].present);
  EXPECT_EQ(driver.run.Truths()[1].forward_m_s, 0);  // braked by the world
  EXPECT_EQ(driver.run.Scans().size(), 2U);
  driver.Advance(1);
  ASSERT_NE(driver.Find(EventKind::kRemoved), nullptr);
  EXPECT_EQ(driver.Find(EventKind::kRemoved)->vehicle, kTwo);
  EXPECT_FALSE(driver.run.Truths()[1].present);
  EXPECT_EQ(driver.run.Scans().size(), 1U);
  driver.AdvanceToEnd();
  EXPECT_EQ(driver.run.EndReason(), "all_arrived");
  EXPECT_TRUE(driver.run.Figures().passed) << driver.run.Figures().reason;
  EXPECT_TRUE(driver.run.Figures().time_to_clear_s.has_value());
}

TEST(Run, ADeathBeforeItsPlannedTimeIsUnplanned) {
  Scenario scenario = PlannedDeath();
  scenario.faults[0].at_s = 4;
  Driver driver(scenario);
  driver.run.Start();
  driver.speaking.erase(kTwo);
  driver.AdvanceToEnd();
  EXPECT_EQ(driver.run.EndReason(), "process_died");
}

TEST(Run, OnceSilentACommandBringsNobodyBack) {
  Driver driver(PlannedDeath());
  driver.run.Start();
  driver.Advance(20);
  driver.speaking.erase(kTwo);
  driver.Advance(30);
  driver.speaking.insert(kTwo);
  driver.Advance(5);
  EXPECT_EQ(driver.run.Truths()[1].forward_m_s, 0);
}

TEST(Run, AnEndAskedForComesWithTheNextAdvanceAndHasNotPassed) {
  Driver driver(TwoLanes());
  driver.run.Start();
  driver.Advance(5);
  driver.run.End("interrupted");
  EXPECT_EQ(driver.run.State(), RunState::kRunning);
  driver.Advance(1);
  EXPECT_EQ(driver.run.State(), RunState::kEnded);
  EXPECT_EQ(driver.run.EndReason(), "interrupted");
  EXPECT_FALSE(driver.run.Figures().passed);
  EXPECT_EQ(driver.run.Figures().reason, "interrupted");
  EXPECT_EQ(driver.Find(EventKind::kEnded)->text, "interrupted");
}

TEST(Run, AnEndBeforeTheStartHasNoFigures) {
  Driver driver(TwoLanes());
  driver.Advance(5);
  driver.run.End("start_timeout");
  driver.Advance(1);
  EXPECT_EQ(driver.run.State(), RunState::kEnded);
  EXPECT_EQ(driver.run.Figures().ticks, 0U);
  EXPECT_FALSE(driver.run.Figures().min_separation_m.has_value());
  EXPECT_EQ(driver.Kinds(), (std::vector{EventKind::kEnded, EventKind::kVerdict}));
}

TEST(Run, AfterTheEndBodiesBrakeAndNothingIsJudged) {
  Driver driver(TwoLanes());
  driver.run.Start();
  driver.AdvanceToEnd();
  const std::size_t events = driver.events.size();
  const double time_s = driver.run.TimeSeconds();
  driver.Advance(40);
  EXPECT_EQ(driver.events.size(), events);
  EXPECT_EQ(driver.run.Truths()[0].forward_m_s, 0);
  EXPECT_EQ(driver.run.TimeSeconds(), time_s);
  EXPECT_EQ(driver.run.Scans()[0].run_state, RunState::kEnded);
}

TEST(Run, AContactIsAnEventAndCounts) {
  Scenario scenario = ScenarioOf({VehicleAt(1, {}), VehicleAt(2, {{0.8, 0}, kPi})});
  scenario.duration_s = 5;
  Driver driver(scenario);
  driver.run.Start();
  driver.AdvanceToEnd();
  EXPECT_EQ(driver.run.Figures().contacts, 1U);
  EXPECT_EQ(driver.run.Figures().reason, "contacts: expected 0, got 1");
  EXPECT_EQ(driver.run.Figures().min_separation_m, 0.0);
  ASSERT_NE(driver.Find(EventKind::kContact), nullptr);
  EXPECT_EQ(driver.Find(EventKind::kContact)->vehicle, kOne);
  EXPECT_EQ(driver.Find(EventKind::kContact)->other, kTwo);
}

TEST(Run, TheHashDoesNotCountTheWaiting) {
  Driver patient(TwoLanes());
  patient.Advance(17);
  Driver hasty(TwoLanes());
  hasty.Advance(1);
  for (Driver* driver : {&patient, &hasty}) {
    driver->run.Start();
    driver->Advance(50);
  }
  EXPECT_EQ(patient.run.Hash(), hasty.run.Hash());
  hasty.Advance(1);
  EXPECT_NE(patient.run.Hash(), hasty.run.Hash());
}

}  // namespace
}  // namespace giveway::sim
