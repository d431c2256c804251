#include <gmock/gmock.h>

#include <functional>

#include "services/qos/deployment.h"
#include "services/qos/profile_check.h"
#include "services/qos/request_offered.h"
#include "services/qos/rollout.h"
#include "tests/unit/qos/qos_files.h"

namespace giveway::qos {
namespace {

std::string Shipped(const std::string& name) {
  return BytesOf(std::filesystem::path(GIVEWAY_QOS_SETS) / (name + ".xml"));
}

ProfileSet SetOf(const std::string& text) { return ReadProfiles(*ReadXml(text, "x").root, "x"); }

std::vector<RolloutProcess> Fleet(const std::string& runs_with, int vehicles) {
  const ProfileSet set = SetOf(Shipped(runs_with));
  std::vector<RolloutProcess> processes;
  for (int i = 1; i <= vehicles; ++i) {
    processes.push_back({"vehicle " + std::to_string(i), Role::kVehicle, set});
  }
  processes.push_back({"the world", Role::kWorld, set});
  processes.push_back({"this operator", Role::kOperator, SetOf(Shipped("default")), false});
  return processes;
}

// Whether each writer that `from` makes matches the reader of its topic that `to` makes.
bool AllMatch(const RolloutProcess& from, const RolloutProcess& to) {
  for (const Profile& writer : from.set.profiles) {
    if (writer.owner != Owner::kWriter || !Concerns(from.role, writer.name)) continue;
    const std::string reader = writer.name.substr(0, writer.name.rfind('_')) + "_reader";
    const Profile* const other = to.set.Find(Owner::kReader, reader);
    if (other == nullptr || !Concerns(to.role, reader)) continue;
    if (!WillMatch(writer, *other)) return false;
  }
  return true;
}

// Takes the steps one by one and checks every pair after each.
void ExpectAllMatchedAllTheWay(std::vector<RolloutProcess> processes, const Rollout& rollout,
                               const std::string& wanted) {
  EXPECT_THAT(rollout.blocked, ::testing::IsEmpty());
  for (const RolloutStep& step : rollout.steps) {
    processes[step.process].set = SetOf(step.between ? rollout.between : wanted);
    for (const RolloutProcess& a : processes) {
      for (const RolloutProcess& b : processes) {
        EXPECT_TRUE(&a == &b || AllMatch(a, b)) << a.name << " to " << b.name;
      }
    }
  }
  for (const RolloutProcess& process : processes) {
    if (!process.moves) continue;
    EXPECT_TRUE(std::ranges::any_of(rollout.steps, [&](const RolloutStep& step) {
      return !step.between && processes[step.process].name == process.name;
    })) << process.name;
  }
}

TEST(Rollout, LeadsAFleetToEveryShippedSetAndBackWithEveryPairMatched) {
  for (const char* from : {"default", "lossy_radio", "same_host"}) {
    for (const char* to : {"default", "lossy_radio", "same_host"}) {
      const auto processes = Fleet(from, 3);
      const std::string wanted = Shipped(to);
      const Rollout rollout = PlanRollout(processes, wanted, to, std::nullopt);
      SCOPED_TRACE(std::string(from) + " to " + to);
      ExpectAllMatchedAllTheWay(processes, rollout, wanted);
      if (rollout.between.empty()) continue;
      EXPECT_EQ(WhyRefused({"between.xml", rollout.between}, {.vehicles = 3}), "");
    }
  }
}

TEST(Rollout, GoesByASetBetweenWhereTheOldAndTheNewDoNotMatch) {
  const Rollout rollout =
      PlanRollout(Fleet("default", 2), Shipped("lossy_radio"), "lossy_radio", std::nullopt);
  const ProfileSet between = SetOf(rollout.between);
  const auto lease = [&](Owner owner, const char* profile) {
    return between.Find(owner, profile)->Number(Policy::kLease);
  };
  EXPECT_EQ(lease(Owner::kReader, "fleet_beacon_reader"), 500'000'000);       // of lossy_radio
  EXPECT_EQ(lease(Owner::kWriter, "fleet_beacon_writer"), 250'000'000);       // of default
  EXPECT_EQ(std::ranges::count_if(rollout.steps, &RolloutStep::between), 1);  // then all fit
}

TEST(Rollout, LetsOneVehicleHaveTheNewSetBeforeTheOthers) {
  const auto processes = Fleet("default", 3);
  const std::string wanted = Shipped("lossy_radio");
  const Rollout rollout = PlanRollout(processes, wanted, "lossy_radio", 1);
  ExpectAllMatchedAllTheWay(processes, rollout, wanted);
  const auto is_last_of_a_vehicle = [&](const RolloutStep& step) {
    return !step.between && processes[step.process].role == Role::kVehicle;
  };
  const auto last = std::ranges::find_if(rollout.steps, is_last_of_a_vehicle);
  ASSERT_NE(last, rollout.steps.end());
  EXPECT_EQ(last->process, 1U);
}

TEST(Rollout, SaysWhichValueOfWhoKeepsItsSetForbidsIt) {
  auto processes = Fleet("lossy_radio", 2);
  processes[1].moves = false;  // its beacons are offered with a lease of 500 ms
  const Rollout rollout = PlanRollout(processes, Shipped("default"), "default", std::nullopt);
  EXPECT_THAT(rollout.steps, ::testing::IsEmpty());
  ASSERT_THAT(rollout.blocked, ::testing::Not(::testing::IsEmpty()));
  EXPECT_EQ(rollout.blocked[0].rule, "liveliness_lease_mismatch");
  EXPECT_THAT(rollout.blocked[0].subject, ::testing::HasSubstr("vehicle 1 and vehicle 2"));
  EXPECT_THAT(rollout.blocked[0].values, ::testing::HasSubstr("500 ms"));
}

TEST(Rollout, IsRefusedWhereProcessesWouldNoLongerFindEachOther) {
  const Rollout rollout =
      PlanRollout(Fleet("default", 2), Shipped("wan_discovery_server"), "wan", std::nullopt);
  ASSERT_THAT(rollout.blocked, ::testing::Not(::testing::IsEmpty()));
  EXPECT_EQ(rollout.blocked[0].rule, "discovery_mismatch");
}

// Of some hundred thousand pairs of processes only a few are of different sets.
TEST(Rollout, OfAHundredVehiclesHoldsEachPairOfSetsAgainstEachOtherOnce) {
  const auto processes = Fleet("default", 100);
  const Rollout rollout = PlanRollout(processes, Shipped("lossy_radio"), "lossy_radio", 3);
  EXPECT_THAT(rollout.blocked, ::testing::IsEmpty());
  EXPECT_EQ(std::ranges::count_if(rollout.steps, std::not_fn(&RolloutStep::between)), 101)
      << "vehicles and the world";
}

TEST(Rollout, LeavesDeadlinesThatNeverEndAsTheyAre) {
  auto processes = Fleet("default", 2);
  std::string open = Shipped("default");
  const std::string period = "<nanosec>150000000</nanosec>";
  const std::size_t at = open.find(period, open.find("fleet_beacon_reader"));
  const std::size_t begin = open.rfind("<period>", at) + 8;
  open.replace(begin, open.find("</period>", at) - begin, "DURATION_INFINITY");
  for (RolloutProcess& process : processes) {
    if (process.moves) process.set = SetOf(open);
  }
  const Rollout back = PlanRollout(processes, Shipped("default"), "default", std::nullopt);
  ExpectAllMatchedAllTheWay(processes, back, Shipped("default"));
  const Rollout there = PlanRollout(Fleet("default", 2), open, "open", std::nullopt);
  ExpectAllMatchedAllTheWay(Fleet("default", 2), there, open);
}

}  // namespace
}  // namespace giveway::qos
