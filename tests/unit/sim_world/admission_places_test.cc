// What the world answers a joining vehicle about its pose and the progress of its task.
#include <gtest/gtest.h>

#include "sim_world/run/admission.h"
#include "tests/unit/sim_world/door.h"

namespace giveway::sim {
namespace {

// An open fleet of one place, whose vehicle drives straight on as soon as it has joined.
class OnePlace {
 public:
  explicit OnePlace(std::uint32_t waypoints = 0, WorldEpoch epoch = kEpoch)
      : run(ScenarioWith(waypoints), epoch),
        admission(ScenarioWith(waypoints), epoch, &run),
        epoch_(epoch) {}

  static Scenario ScenarioWith(std::uint32_t waypoints) {
    Scenario scenario = ScenarioOf({});
    scenario.spawns = {VehicleAt(0, {{0, 0}, 0})};
    scenario.spawns[0].route.count = waypoints;
    scenario.remove_after_s = 100;
    return scenario;
  }
  void Tick(int ticks = 1) {
    for (int i = 0; i < ticks; ++i) {
      answers = admission.Answer();
      MotorCommand command = Drive(1, run.Now(), 3, 3);
      command.epoch = epoch_;
      command.task = task;
      if (speaks) {
        run.Advance({{command}});
      } else {
        run.Advance({});
      }
      admission.FollowRun();
    }
  }
  // The answer of the tick in which it asks; given before the world moves on.
  RosterEntry Join(const JoinRequest& request) {
    admission.Take(request);
    Tick();
    for (const RosterEntry& entry : answers) {
      if (entry.session == request.session) return entry;
    }
    return {};
  }
  const Body& TheBody() const { return *run.BodyOf(VehicleId{1}); }

  Run run;
  Admission admission;
  bool speaks = true;
  TaskProgress task;
  std::vector<RosterEntry> answers;  // of the last tick

 private:
  WorldEpoch epoch_;
};

// Regression: it drove 3.6 m in four_way, restarted itself, and the answer gave its start pose.
TEST(AdmissionPlaces, EveryAnswerSaysWhereTheBodyIsNow) {
  OnePlace fleet;
  fleet.Join(Ask(1));
  fleet.run.Start();
  fleet.Tick(40);
  const Body at = fleet.TheBody();
  const Tick now = fleet.run.Now();
  const RosterEntry again = fleet.Join(Ask(1, 1));
  EXPECT_EQ(again.start_world, at.world_from_body);
  EXPECT_GT(again.start_world.position_world.x, 0.2);
  EXPECT_EQ(again.tick, now);
  EXPECT_EQ(again.counted, at.counted);
  fleet.Tick(10);
  for (const RosterEntry& entry : fleet.admission.InformAll("")) {
    EXPECT_EQ(entry.start_world, fleet.TheBody().world_from_body);
    EXPECT_EQ(entry.tick, fleet.run.Now());
  }
}

TEST(AdmissionPlaces, AReturnedVehicleIsToldHowFarItsTaskWas) {
  OnePlace fleet(4);
  EXPECT_EQ(fleet.Join(Ask(1)).task, TaskProgress{});
  fleet.run.Start();
  fleet.task = {3, 20};
  fleet.Tick(40);
  EXPECT_EQ(fleet.Join(Ask(1, 1)).task, fleet.task);
  // Killed, and back under its id.
  fleet.speaks = false;
  fleet.Tick(40);
  const RosterEntry back = fleet.Join(Ask(9, 1));
  EXPECT_EQ(back.task, fleet.task);
  EXPECT_EQ(back.start_world, fleet.TheBody().world_from_body);
  EXPECT_EQ(back.counted, fleet.TheBody().counted);
  // Then the same for its world, from a checkpoint.
  OnePlace after(4, WorldEpoch{8});
  const auto bytes = ToBytes(fleet.admission.Save(5));
  ASSERT_TRUE(after.admission.Restore(std::get<FleetCheckpoint>(FromBytes(bytes))));
  const RosterEntry in_next = after.Join(Ask(9, 1));
  EXPECT_EQ(in_next.epoch, WorldEpoch{8});
  EXPECT_EQ(in_next.task, fleet.task);
  EXPECT_EQ(in_next.start_world, fleet.TheBody().world_from_body);
}

TEST(AdmissionPlaces, WhoIsPutOnAPlaceThatWasGivenBackHasDoneNothingYet) {
  OnePlace fleet(4);
  fleet.Join(Ask(1));
  fleet.task = {3, 20};
  fleet.Tick(5);
  JoinRequest leaves = Ask(1);
  leaves.leaving = true;
  fleet.admission.Take(leaves);
  fleet.speaks = false;
  fleet.Tick();
  const RosterEntry next = fleet.Join(Ask(5));
  EXPECT_TRUE(next.accepted);
  EXPECT_EQ(next.task, TaskProgress{});
  EXPECT_EQ(next.counted, WheelAngles{});
}

TEST(AdmissionPlaces, AWaypointThatTheRouteDoesNotHaveIsNotHandedOn) {
  OnePlace fleet(2);
  fleet.Join(Ask(1));
  fleet.run.Start();
  fleet.task = {2, 0};  // on to the goal
  fleet.Tick(2);
  EXPECT_EQ(fleet.Join(Ask(1, 1)).task.waypoint, 2U);
  fleet.task = {3, 0};
  fleet.Tick(2);
  EXPECT_EQ(fleet.Join(Ask(1, 1)).task.waypoint, 0U);
}

}  // namespace
}  // namespace giveway::sim
