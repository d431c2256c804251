// Batches of virtual runs: what a seed means, and that the number of threads means nothing.
#include "services/fleetctl/virtual_batch.h"

#include <gtest/gtest.h>

#include <set>

#include "services/app/scenario_file.h"

namespace giveway::fleetctl {
namespace {

const BatchProgress kGoOn = [](const BatchTotals& /*so_far*/) { return true; };

CaseOptions Lossy(const std::string& generator) {
  CaseOptions options;
  options.scenario = generator;
  options.vehicles = WholeRange{2, 5};
  options.loss_percent = {0, 20};
  options.jitter_ms = 60;
  options.pauses = 1;
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
  }
  EXPECT_NE(RunBatch(maker, {2, 13}, 2, kGoOn).hash, one.hash);
}

// Four of these had vehicles that stood for good before one whose process had been paused.
TEST(VirtualBatch, PausedProcessesHoldNobodyUpForGood) {
  CaseOptions options;
  options.scenario = "crossing";
  options.vehicles = WholeRange{8, 8};
  options.pauses = 4;
  const BatchTotals totals = RunBatch(CaseMaker(options), {1, 40}, 2, kGoOn);
  EXPECT_TRUE(totals.failing_seeds.empty()) << totals.failing_seeds.size() << " failed";
}

TEST(VirtualBatch, StopsWhenItIsToldTo) {
  const CaseMaker maker(Lossy("convoy"));
  const BatchTotals stopped =
      RunBatch(maker, {1, 1'000'000}, 2, [](const BatchTotals& /*so_far*/) { return false; });
  EXPECT_LT(stopped.runs, 1'000'000U);
}

TEST(VirtualBatch, NamesTheSeedsThatFailed) {
  BatchTotals totals;
  sim::VirtualOutcome good;
  good.held = true;
  sim::VirtualOutcome bad;
  bad.violations[0] = 2;
  totals.Add(1, good, false);
  totals.Add(2, bad, false);
  totals.Add(3, good, true);  // did not meet its expectations
  EXPECT_EQ(totals.failing_seeds, (std::vector<std::uint32_t>{2, 3}));
  EXPECT_EQ(totals.violations[0], 2U);
  EXPECT_EQ(totals.unmet, 1U);
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

TEST(VirtualCaseOfASeed, RefusesWhatIsNeitherFileNorGenerator) {
  EXPECT_THROW(CaseMaker({.scenario = "no_such_place"}), app::InputError);
}

}  // namespace
}  // namespace giveway::fleetctl
