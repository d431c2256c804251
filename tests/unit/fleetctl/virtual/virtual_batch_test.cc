// Batches of virtual runs: what a seed means, and that the number of threads makes no difference.
#include "services/fleetctl/virtual/virtual_batch.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway::fleetctl {
namespace {

const BatchProgress kGoOn = [](const BatchTotals& /*so_far*/) { return true; };

CaseOptions Lossy(const std::string& generator) {
  CaseOptions options;
  options.scenario = generator;
  options.vehicles = WholeRange{2, 5};
  options.loss_percent = {0, 20};
  options.jitter_ms = 60;
  options.pauses = {1, 1};
  return options;
}

// What tests/virtual/campaign.sh draws from.
CaseOptions AsInTheCampaign(const std::string& generator) {
  CaseOptions options;
  options.scenario = generator;
  options.vehicles = WholeRange{2, 50};
  options.loss_percent = {0, 20};
  return options;
}

TEST(VirtualBatch, ComesToTheSameWithAnyNumberOfThreads) {
  const CaseMaker maker(Lossy("swarm"));
  const BatchTotals one = RunBatch(maker, {1, 12}, 1, kGoOn);
  for (const std::uint32_t jobs : {2U, 5U}) {
    const BatchTotals many = RunBatch(maker, {1, 12}, jobs, kGoOn);
    EXPECT_EQ(many.hash, one.hash);
    EXPECT_EQ(many.runs, 12U);
    EXPECT_EQ(many.delays_s, one.delays_s);
    EXPECT_EQ(many.failing_seeds, one.failing_seeds);
    EXPECT_EQ(many.violations, one.violations);
    EXPECT_EQ(many.traffic.by_rule_ns, one.traffic.by_rule_ns);
    EXPECT_EQ(many.traffic.stops, one.traffic.stops);
  }
  EXPECT_GT(one.traffic.by_rule_ns[static_cast<std::size_t>(Rule::kCruise)], 0U);
  EXPECT_NE(RunBatch(maker, {2, 13}, 2, kGoOn).hash, one.hash);
}

TEST(VirtualBatch, StockAvoidDrivesWithTheStockScriptsWeights) {
  for (const char* scenario : {"crossing", "four_way", "open_fleet"}) {
    CaseOptions options;
    options.scenario = scenario;
    options.behaviour = Behaviour::kStockAvoid;
    for (const VehicleOptions& vehicle : CaseMaker(options).Make(1).scenario.vehicles) {
      EXPECT_EQ(vehicle.behaviour, Behaviour::kStockAvoid);
      EXPECT_EQ(vehicle.braitenberg.left, StockWeights().left) << scenario;
      EXPECT_EQ(vehicle.braitenberg.right, StockWeights().right) << scenario;
      EXPECT_EQ(vehicle.braitenberg.far_gate_m, StockWeights().far_gate_m) << scenario;
    }
  }
}

TEST(VirtualBatch, ARunInWhichEveryVehicleCrashesAtOnceDoesNotPass) {
  CaseOptions options;
  options.scenario = "crossing";
  options.vehicles = WholeRange{3, 3};
  for (const std::uint32_t id : {1U, 2U, 3U}) {
    options.faults.push_back({.vehicle = VehicleId{id}, .at_s = 0});
  }
  const BatchTotals totals = RunBatch(CaseMaker(options), {1, 2}, 1, kGoOn);
  EXPECT_EQ(totals.failing_seeds, (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(totals.violations[static_cast<std::size_t>(sim::Invariant::kArrival)], 2U);
  options.faults.pop_back();
  EXPECT_TRUE(RunBatch(CaseMaker(options), {1, 2}, 1, kGoOn).failing_seeds.empty());
}

// Regression: the list was cut off after a hundred entries of the first seeds, and the only contact
// of a batch was not among them.
TEST(VirtualBatch, TheOnlyContactOfManyRunsIsListed) {
  BatchTotals totals;
  for (std::uint32_t seed = 1; seed <= 1000; ++seed) {
    sim::VirtualOutcome outcome;
    outcome.noted = {{.invariant = sim::Invariant::kDelay}, {.invariant = sim::Invariant::kClaim}};
    if (seed == 900) outcome.first = {{.invariant = sim::Invariant::kContact, .tick = Tick{7}}};
    totals.Add(seed, outcome, false);
  }
  ASSERT_FALSE(totals.first_violations.empty());
  EXPECT_LE(totals.first_violations.size(), 600U);
  EXPECT_TRUE(std::ranges::any_of(totals.first_violations, [](const SeedViolation& violation) {
    return violation.seed == 900 && violation.what.invariant == "contact";
  }));
}

// Regression: in open_fleet the vehicles after the eighth get the places, and so the goals, of
// those that have parked: `steer_round` for nine minutes, and "passed".
TEST(VirtualBatch, AVehicleBehindOneParkedOnItsGoalIsWedged) {
  Scenario scenario = LoadScenario("open_fleet", {});
  VehicleOptions first = scenario.spawns[0];
  VehicleOptions ninth = first;
  first.id = VehicleId{1};
  ninth.id = VehicleId{9};
  ninth.start_world.position_world.x -= 3;
  scenario.vehicles = {first, ninth};
  scenario.spawns.clear();
  scenario.duration_s = 120;
  const sim::VirtualOutcome outcome = sim::RunVirtually(scenario, {});
  EXPECT_EQ(outcome.violations[static_cast<std::size_t>(sim::Invariant::kProgress)], 1U);
  EXPECT_FALSE(outcome.held);
}

// In four of these, vehicles stood permanently behind one whose process had been paused.
TEST(VirtualBatch, PausedProcessesHoldNobodyUpForGood) {
  CaseOptions options;
  options.scenario = "crossing";
  options.vehicles = WholeRange{8, 8};
  options.pauses = {4, 4};
  const BatchTotals totals = RunBatch(CaseMaker(options), {1, 40}, 2, kGoOn);
  EXPECT_TRUE(totals.failing_seeds.empty()) << totals.failing_seeds.size() << " failed";
}

// Nine of ten thousand swarms failed: in four, vehicles queued permanently behind one that had
// arrived; in five, all halted except one that still rolled to its goal. In 1130, found with a
// later brain, a vehicle found no exit between two bodies.
TEST(VirtualBatch, SwarmsThatBrokeHold) {
  const CaseMaker maker(AsInTheCampaign("swarm"));
  for (const std::uint32_t seed :
       {1130U, 1210U, 1730U, 1822U, 5464U, 7746U, 8151U, 8236U, 8547U, 8795U}) {
    EXPECT_TRUE(RunBatch(maker, {seed, seed}, 1, kGoOn).failing_seeds.empty()) << "seed " << seed;
  }
}

// Of four thousand corridors the first failed: a vehicle waited for one that it held up itself,
// over a third. The next three are from brains that fixed this in other ways: in 645 a queue turned
// across its lane, in 694 the third was part of a longer queue, and in 474 two that stood shell to
// shell found no heading between each other and the walls. The last are from ten thousand with the
// brain that passed these: oscillating between two headings, wedged between two others; in 6868, of
// the next, they only took longer than the time limit.
TEST(VirtualBatch, CorridorsThatBrokeHold) {
  const CaseMaker maker(AsInTheCampaign("corridor"));
  for (const std::uint32_t seed :
       {2833U, 645U, 694U, 474U, 3552U, 5957U, 7085U, 7354U, 9093U, 9507U, 9994U, 6868U}) {
    EXPECT_TRUE(RunBatch(maker, {seed, seed}, 1, kGoOn).failing_seeds.empty()) << "seed " << seed;
  }
}

TEST(VirtualBatch, StopsWhenItIsToldTo) {
  const CaseMaker maker(Lossy("convoy"));
  const BatchTotals stopped =
      RunBatch(maker, {1, 1'000'000}, 2, [](const BatchTotals& /*so_far*/) { return false; });
  EXPECT_LT(stopped.runs, 1'000'000U);
}

// One run of 200 vehicles took no notice of Ctrl-C for a quarter of a minute.
TEST(VirtualBatch, StopsARunAtItsNextTick) {
  const CaseMaker maker(Lossy("convoy"));
  const std::atomic<bool> stop = true;
  EXPECT_FALSE(RunUnlessStopped(maker.Make(1), stop));
  const BatchTotals stopped =
      RunBatch(maker, {1, 1}, 1, [](const BatchTotals& /*so_far*/) { return false; });
  EXPECT_LE(stopped.runs, 1U);
}

TEST(VirtualBatch, NamesTheSeedsThatFailed) {
  BatchTotals totals;
  sim::VirtualOutcome good;
  good.held = true;
  sim::VirtualOutcome bad;
  bad.violations[0] = 2;
  totals.Add(1, good, false);
  totals.Add(2, bad, false);
  good.unmet = "arrived: expected 1 2, got 1";
  totals.Add(5, good, true);
  good.unmet = "contacts: expected 0, got 1";
  totals.Add(3, good, true);
  EXPECT_EQ(totals.failing_seeds, (std::vector<std::uint32_t>{2, 5, 3}));
  EXPECT_EQ(totals.violations[0], 2U);
  EXPECT_EQ(totals.unmet, 2U);
  EXPECT_EQ(totals.first_unmet_seed, 3U);
  EXPECT_EQ(totals.first_unmet, "contacts: expected 0, got 1");
}

TEST(VirtualCaseOfASeed, DrawsFromTheWholeRange) {
  const CaseMaker maker(Lossy("crossing"));
  std::set<std::size_t> sizes;
  double least = 1;
  double most = 0;
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    const VirtualCase made = maker.Make(seed);
    sizes.insert(made.scenario.vehicles.size());
    least = std::min(least, made.plan.radio.loss);
    most = std::max(most, made.plan.radio.loss);
    ASSERT_EQ(made.plan.faults.size(), 1U);
  }
  EXPECT_EQ(sizes, (std::set<std::size_t>{2, 3, 4, 5}));
  EXPECT_GE(least, 0);
  EXPECT_LT(least, 0.01);
  EXPECT_LE(most, 0.2);
  EXPECT_GT(most, 0.19);
}

TEST(VirtualCaseOfASeed, IsTheSameWhateverElseWasMade) {
  const CaseMaker maker(Lossy("swarm"));
  const VirtualCase once = maker.Make(17);
  maker.Make(18);
  const VirtualCase again = maker.Make(17);
  EXPECT_EQ(once.plan.radio.loss, again.plan.radio.loss);
  EXPECT_EQ(once.plan.faults[0].at_s, again.plan.faults[0].at_s);
  EXPECT_EQ(once.scenario.vehicles[1].start_world, again.scenario.vehicles[1].start_world);
}

std::vector<std::uint32_t> IdsOf(const CaseOptions& options) {
  std::vector<std::uint32_t> ids;
  for (const VehicleOptions& vehicle : CaseMaker(options).Make(1).scenario.vehicles) {
    ids.push_back(Number(vehicle.id));
  }
  return ids;
}

// Regression: the run had no vehicles and passed; with faults it divided by zero.
TEST(VirtualCaseOfASeed, AnOpenFleetStandsOnItsPlaces) {
  using Ids = std::vector<std::uint32_t>;
  EXPECT_EQ(IdsOf({.scenario = "open_fleet"}), (Ids{1, 2}));
  EXPECT_EQ(
      IdsOf({.scenario = "open_fleet", .vehicles = WholeRange{5, 5}, .pauses = WholeRange{2, 2}}),
      (Ids{1, 2, 3, 4, 5}));
  EXPECT_EQ(IdsOf({.scenario = "fleet_20"}).size(), 20U);
  const VirtualCase made = CaseMaker({.scenario = "open_fleet"}).Make(1);
  EXPECT_TRUE(made.scenario.spawns.empty());
  EXPECT_GT(RunBatch(CaseMaker({.scenario = "open_fleet"}), {1, 1}, 1, kGoOn).vehicle_seconds, 30);
}

TEST(VirtualCaseOfASeed, RefusesMoreVehiclesThanThereArePlaces) {
  EXPECT_NO_THROW(CaseMaker({.scenario = "open_fleet", .vehicles = WholeRange{2, 8}}));
  EXPECT_THROW(CaseMaker({.scenario = "open_fleet", .vehicles = WholeRange{2, 9}}), InputError);
  EXPECT_THROW(CaseMaker({.scenario = "four_way", .vehicles = WholeRange{4, 4}}), InputError);
}

// Regression: vehicles that a seed put into each other are no contact as long as they do not close
// in: such a run passed, where `run` refuses the seed.
TEST(VirtualCaseOfASeed, IsRefusedWhereTheFileIsWithThatSeed) {
  const TempFolder folder;
  const std::string file =
      folder.Write("close.textproto", Edited("x_m: -4 y_m: 0", "x_m: 0.53 y_m: -3"));
  const CaseMaker maker({.scenario = file});
  std::uint32_t refused = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    ScenarioOverrides overrides;
    overrides.seed = seed;
    const auto takes = [](const auto& make) {
      try {
        make();
      } catch (const InputError&) {
        return false;
      }
      return true;
    };
    const bool loads = takes([&] { LoadScenario(file, overrides); });
    EXPECT_EQ(takes([&] { maker.Make(seed); }), loads) << "seed " << seed;
    refused += loads ? 0 : 1;
  }
  EXPECT_GT(refused, 2U);
  EXPECT_LT(refused, 38U);
}

TEST(VirtualCaseOfASeed, SaysThatLinksAreNotImpaired) {
  const TempFolder folder;
  const std::string file =
      folder.Write("impaired.textproto", kGoodScenario + "impair { loss: 1 }\n");
  EXPECT_EQ(CaseMaker({.scenario = "four_way"}).Remark(), "");
  EXPECT_EQ(CaseMaker({.scenario = "crossing"}).Remark(), "");
  EXPECT_NE(CaseMaker({.scenario = file}).Remark().find("not carried out"), std::string::npos);
}

TEST(VirtualCaseOfASeed, RefusesWhatIsNeitherFileNorGenerator) {
  EXPECT_THROW(CaseMaker({.scenario = "no_such_place"}), InputError);
}

// A file of the test's folder that is gone with it.
class FaultFile {
 public:
  explicit FaultFile(const std::string& text)
      : path_(testing::TempDir() + "/faults_" + std::to_string(getpid()) + ".textproto") {
    std::ofstream(path_) << text;
  }
  ~FaultFile() { std::filesystem::remove(path_); }
  FaultFile(const FaultFile&) = delete;
  FaultFile& operator=(const FaultFile&) = delete;
  const std::string& Path() const { return path_; }

 private:
  std::string path_;
};

constexpr const char* kTwoRules =
    "random { name: \"a\" kind: \"sonar_off\" mean_between_s: 5 for_s: 2 }\n"
    "random { name: \"b\" kind: \"pause\" mean_between_s: 5 for_s: 0.5 }\n";

CaseOptions WithFaults(const FaultFile& file) {
  CaseOptions options;
  options.scenario = "crossing";
  options.fault_file = file.Path();
  return options;
}

TEST(VirtualFaultFile, EachSeedDrawsItsOwnFaultsOfTheFile) {
  const FaultFile file(kTwoRules);
  const CaseMaker maker(WithFaults(file));
  const faults::Schedule once = maker.Make(1).plan.schedule;
  EXPECT_GT(once.size(), 3U);
  EXPECT_EQ(maker.Make(1).plan.schedule, once);
  EXPECT_NE(maker.Make(2).plan.schedule, once);
  EXPECT_EQ(maker.Make(1).scenario.vehicles.size(), 6U);
  EXPECT_TRUE(maker.Remark().empty());
}

TEST(VirtualFaultFile, WhatCannotBeVirtualIsRefusedOrLeftOutWithAWord) {
  const FaultFile file(
      std::string(kTwoRules) +
      "at { name: \"c\" kind: \"disk_full\" time_s: 3 for_s: 1 vehicle: 1 }\n"
      "at { name: \"d\" kind: \"restart\" time_s: 3 for_s: 1 target: \"world\" }\n");
  CaseOptions options = WithFaults(file);
  try {
    const CaseMaker maker(options);
    FAIL() << "taken";
  } catch (const InputError& error) {
    EXPECT_EQ(error.Problems().size(), 2U);
  }
  options.skip_unsupported = true;
  const CaseMaker maker(options);
  EXPECT_NE(maker.Remark().find("disk_full"), std::string::npos);
  EXPECT_NE(maker.Remark().find("restart"), std::string::npos);
  for (const faults::Fault& fault : maker.Make(1).plan.schedule) {
    EXPECT_TRUE(fault.rule == "a" || fault.rule == "b") << fault.rule;
  }
}

TEST(VirtualFaultFile, AVehicleThatIsNotThereIsRefused) {
  const FaultFile file("at { name: \"a\" kind: \"pause\" time_s: 3 for_s: 1 vehicle: 99 }\n");
  const CaseMaker maker(WithFaults(file));
  EXPECT_THROW(maker.Make(1), InputError);
}

// As `fleetctl shrink` leaves one: what comes after the end of the shortened run does not matter.
TEST(VirtualFaultFile, AListIsTakenAsItStands) {
  const FaultFile file(
      "at { name: \"a\" nth: 7 kind: \"pause\" time_s: 900 for_s: 100 vehicle: 1 }\n");
  const CaseMaker maker(WithFaults(file));
  const faults::Schedule schedule = maker.Make(1).plan.schedule;
  ASSERT_EQ(schedule.size(), 1U);
  EXPECT_EQ(schedule[0].nth, 7U);
}

}  // namespace
}  // namespace giveway::fleetctl
