#include "services/fleetctl/stopwatch/stopwatch_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "services/config/impair.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::IsEmpty;

const Limits kLimits{.beacon_period = milliseconds(50),
                     .beacon_age = milliseconds(200),
                     .deadline = milliseconds(150),
                     .liveliness = milliseconds(250),
                     .lease = seconds(10)};

std::vector<Wave> Plan(Fault fault, std::uint32_t trials, std::uint32_t vehicles) {
  return PlanWaves(fault, trials, StopwatchVehicles(vehicles), kLimits, 7);
}

TEST(StopwatchPlan, EveryTrialIsPlannedAndHalfTheFleetWatches) {
  std::size_t injections = 0;
  for (const Wave& wave : Plan(Fault::kKill, 10, 8)) {
    std::set<VehicleId> targets;
    for (const FaultInjection& injection : wave.injections) targets.insert(injection.target);
    EXPECT_EQ(targets.size(), wave.injections.size());  // no vehicle is faulted twice
    EXPECT_LE(targets.size(), 4U);
    EXPECT_TRUE(std::ranges::is_sorted(wave.injections, {}, &FaultInjection::after));
    injections += wave.injections.size();
  }
  EXPECT_EQ(injections, 10U);
}

TEST(StopwatchPlan, OfTwoOneWatches) {
  for (const Wave& wave : Plan(Fault::kPause, 3, 2)) EXPECT_EQ(wave.injections.size(), 1U);
}

TEST(StopwatchPlan, ASeedRepeatsAndAnotherDoesNot) {
  const auto fleet = StopwatchVehicles(8);
  const auto plan = [&](std::uint64_t seed) {
    return BlackoutsOf(VehicleId{1}, Fault::kCut, PlanWaves(Fault::kCut, 4, fleet, kLimits, seed),
                       fleet);
  };
  EXPECT_EQ(plan(3), plan(3));
  EXPECT_NE(plan(3), plan(4));
}

// Whether a blackout makes `hearer` miss `sender` right after the fault is injected.
bool IsDeafTo(VehicleId hearer, VehicleId sender, Fault fault, const Wave& wave,
              const FaultInjection& injection) {
  const auto fleet = StopwatchVehicles(4);
  const std::string rules = BlackoutsOf(hearer, fault, std::vector<Wave>{wave}, fleet);
  if (rules.empty()) return false;
  const auto parsed = ParseImpairment(rules);
  EXPECT_THAT(parsed.problems, IsEmpty());
  const double at_s = Seconds(wave.begin + injection.after) + 0.001;
  const auto rule =
      std::ranges::find(parsed.impairment.rules, sender, &ImpairmentRule::from_vehicle);
  return rule != parsed.impairment.rules.end() &&
         std::ranges::any_of(rule->blackouts, [at_s](const Blackout& blackout) {
           return blackout.from_s <= at_s && at_s < blackout.to_s;
         });
}

TEST(StopwatchPlan, ACutIsBothWaysAndALossIsOneWay) {
  const Wave wave{seconds(5), seconds(20), {{VehicleId{3}, milliseconds(120)}}};
  const FaultInjection& injection = wave.injections.front();
  for (const Fault fault : {Fault::kCut, Fault::kOneWay}) {
    EXPECT_TRUE(IsDeafTo(VehicleId{1}, VehicleId{3}, fault, wave, injection));
    EXPECT_FALSE(IsDeafTo(VehicleId{1}, VehicleId{2}, fault, wave, injection));
    EXPECT_EQ(IsDeafTo(VehicleId{3}, VehicleId{1}, fault, wave, injection), fault == Fault::kCut);
  }
  EXPECT_THAT(
      BlackoutsOf(VehicleId{1}, Fault::kKill, std::vector<Wave>{wave}, StopwatchVehicles(4)),
      IsEmpty());
}

TEST(StopwatchPlan, ABlackoutOutlastsTheLongestPromise) {
  const std::vector<Wave> waves = Plan(Fault::kOneWay, 4, 8);
  ASSERT_EQ(waves.size(), 1U);
  const Nanoseconds last = waves[0].begin + waves[0].injections.back().after;
  EXPECT_GT(waves[0].end - last, PromisedWithin(Mechanism::kLease, kLimits) + seconds(1));
}

TEST(StopwatchPlan, TheScenarioIsOneThatTheServicesTake) {
  for (const std::uint32_t vehicles : {2U, 8U, 31U}) {
    const Scenario scenario = Load(StopwatchScenario(StopwatchVehicles(vehicles)));
    EXPECT_EQ(scenario.vehicles.size(), vehicles);
    EXPECT_EQ(scenario.start_with, vehicles);
    EXPECT_EQ(scenario.spawns.size(), 1U);
  }
}

}  // namespace
}  // namespace giveway::fleetctl
