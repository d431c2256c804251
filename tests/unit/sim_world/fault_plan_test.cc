#include "sim_world/run/fault_plan.h"

#include <gtest/gtest.h>

#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

class FaultPlanTest : public testing::Test {
 protected:
  FaultPlan PlanOf(PlannedFault fault) {
    scenario_.faults = {fault};
    return FaultPlan(scenario_);
  }
  std::size_t EventsAt(FaultPlan* plan, double time_s, Vec2 position_world, bool present = true) {
    EventLog log(kEpoch);
    Body body;
    body.vehicle = kTwo;
    body.present = present;
    body.world_from_body.position_world = position_world;
    plan->Observe(time_s, {&body, 1}, &log);
    for (const WorldEvent& event : log.Events()) {
      EXPECT_EQ(event.kind, EventKind::kFaultDue);
      EXPECT_EQ(event.vehicle, kTwo);
      EXPECT_EQ(event.text, "kill");
    }
    return log.Events().size();
  }

  Scenario scenario_;
};

TEST_F(FaultPlanTest, AFaultIsDueAtItsTimeAndOnlyOnce) {
  FaultPlan plan = PlanOf({.vehicle = kTwo, .at_s = 4});
  EXPECT_EQ(EventsAt(&plan, 3.95, {}), 0U);
  EXPECT_FALSE(plan.IsKilled(kTwo));
  EXPECT_EQ(EventsAt(&plan, 4, {}), 1U);
  EXPECT_TRUE(plan.IsKilled(kTwo));
  EXPECT_EQ(EventsAt(&plan, 4.05, {}), 0U);
}

TEST_F(FaultPlanTest, AFaultIsDueWhereTheTruePoseIsNearEnoughToTheCrossing) {
  scenario_.crossing_world = {1, 1};
  FaultPlan plan = PlanOf({.vehicle = kTwo, .before_crossing_m = 1.5});
  EXPECT_EQ(EventsAt(&plan, 1, {1, -0.51}), 0U);
  EXPECT_EQ(EventsAt(&plan, 1, {1, -0.49}), 1U);
  EXPECT_EQ(EventsAt(&plan, 1, {1, -0.48}), 0U);
}

TEST_F(FaultPlanTest, EveryConditionGivenMustHold) {
  FaultPlan plan = PlanOf({.vehicle = kTwo, .at_s = 4, .before_crossing_m = 1.5});
  EXPECT_EQ(EventsAt(&plan, 3, {1, 0}), 0U);
  EXPECT_EQ(EventsAt(&plan, 5, {3, 0}), 0U);
  EXPECT_EQ(EventsAt(&plan, 5, {1, 0}), 1U);
}

TEST_F(FaultPlanTest, AVehicleThatIsNotThereIsNotKilled) {
  FaultPlan plan = PlanOf({.vehicle = kTwo, .at_s = 4});
  EXPECT_EQ(EventsAt(&plan, 5, {}, false), 0U);
  EXPECT_EQ(EventsAt(&plan, 6, {}), 1U);
}

}  // namespace
}  // namespace giveway::sim
