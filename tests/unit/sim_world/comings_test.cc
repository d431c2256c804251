// What vehicles that join and leave, and those that only ask, may cost a world.
#include <gmock/gmock.h>

#include <chrono>

#include "services/runtime/line_budget.h"
#include "tests/unit/sim_world/door.h"

namespace giveway::sim {
namespace {

// Issue 21, number 12: 30 000 requests in 6 s.
TEST(Comings, AFloodOfRequestsCostsATickNoMoreThanTheWaitingListHolds) {
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
  // The vehicles in the run stay known throughout, and a vehicle that asks after the flood gets its
  // turn.
  EXPECT_TRUE(door.Join(Ask(2)).accepted);
  door.Tick(61);
  door.Leave(2);
  EXPECT_TRUE(door.Join(Ask(3)).accepted);
}

TEST(Comings, WhoNeverSpeaksLosesItsPlaceSoonerThanWhoFellSilent) {
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

// Issue 21, number 11: every vehicle that ever joined left a body behind, and a truth was sent for
// it each tick.
TEST(Comings, OfVehiclesThatLeftNothingIsKeptOrTold) {
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
  // One of them rejoins, and is reported at once.
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
