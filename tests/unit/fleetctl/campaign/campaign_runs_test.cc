// How runs are divided among shards: each run belongs to one, and all shards take about as long.
#include "services/fleetctl/campaign/campaign_runs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "services/config/problem.h"
#include "services/fleetctl/campaign/campaign_index.h"
#include "services/fleetctl/campaign/campaign_run.h"
#include "tests/unit/fleetctl/campaign/campaign_plans.h"

namespace giveway::fleetctl {
namespace {

using ::testing::HasSubstr;

RC_GTEST_PROP(CampaignRuns, HoldEveryRunExactlyOnce, ()) {
  CampaignPlan plan = SmallCampaign();
  plan.generators.resize(*rc::gen::inRange<std::size_t>(1, 4));
  plan.seeds.low = *rc::gen::inRange<std::uint32_t>(0, 1000);
  plan.seeds.high = plan.seeds.low + *rc::gen::inRange<std::uint32_t>(0, 60);
  const auto of = *rc::gen::inRange<std::uint32_t>(1, 80);
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  for (std::uint32_t index = 0; index < of; ++index) {
    const ShardRuns runs(plan, {index, of});
    std::vector<std::uint32_t> counts(plan.generators.size());
    for (std::uint32_t place = 0; place < runs.Count(); ++place) {
      const CampaignRun run = runs.At(place);
      ++counts[run.generator];
      RC_ASSERT(run.generator < plan.generators.size());
      RC_ASSERT(run.seed >= plan.seeds.low && run.seed <= plan.seeds.high);
      RC_ASSERT(seen.emplace(run.generator, run.seed).second);
    }
    for (std::size_t i = 0; i < counts.size(); ++i) RC_ASSERT(runs.CountOf(i) == counts[i]);
  }
  RC_ASSERT(seen.size() == plan.Runs());
}

TEST(CampaignRuns, TakeAboutAsLongInEveryShard) {
  CampaignPlan plan = SmallCampaign();
  plan.seeds = {1, 100};
  for (const std::uint32_t of : {2U, 3U, 7U, 8U}) {
    for (std::uint32_t index = 0; index < of; ++index) {
      const ShardRuns runs(plan, {index, of});
      std::vector<std::uint32_t> of_generator(plan.generators.size());
      for (std::uint32_t place = 0; place < runs.Count(); ++place) {
        ++of_generator[runs.At(place).generator];
      }
      const auto [least, most] = std::ranges::minmax(of_generator);
      EXPECT_LE(most - least, 1U) << index << " of " << of;
      EXPECT_LE(runs.Count(), 300 / of + 1) << index << " of " << of;
      EXPECT_GE(runs.Count(), 300 / of) << index << " of " << of;
    }
  }
}

TEST(CampaignRuns, GoToTheEndOfWhatASeedCanBe) {
  CampaignPlan plan = SmallCampaign();
  plan.seeds = {4294967290U, 4294967295U};
  const ShardRuns runs(plan, {0, 1});
  ASSERT_EQ(runs.Count(), 18U);
  EXPECT_EQ(runs.At(17).seed, 4294967295U);
}

// Its one run takes longer than it takes to notice the stop, so only a run that is cut ends without
// a result.
TEST(CampaignRun, IsCutShortWithinARun) {
  CampaignPlan plan = SmallCampaign();
  plan.generators = {"swarm"};
  plan.seeds = {1, 1};
  plan.vehicles = CampaignWholes{50, 50};
  const auto stop = [](std::uint32_t, std::uint32_t) { return false; };
  EXPECT_FALSE(RunShard(CampaignMaker(plan), {0, 1}, 1, stop));
}

Environment Says(std::vector<std::pair<std::string, std::string>> variables) {
  return [variables](const char* name) -> std::optional<std::string> {
    for (const auto& [known, value] : variables) {
      if (known == name) return value;
    }
    return std::nullopt;
  };
}

std::string RefusalOf(std::uint32_t of, const Environment& environment) {
  try {
    return std::to_string(ShardIndex(std::nullopt, of, environment));
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(CampaignIndex, IsTakenFromWhicheverEngineStartedTheShard) {
  EXPECT_EQ(ShardIndex(std::nullopt, 4, Says({{"JOB_COMPLETION_INDEX", "3"}})), 3U);
  EXPECT_EQ(ShardIndex(std::nullopt, 4, Says({{"SLURM_ARRAY_TASK_ID", "0"}})), 0U);
  EXPECT_EQ(ShardIndex(std::nullopt, 4, Says({{"PARALLEL_SEQ", "1"}})), 0U);
  EXPECT_EQ(ShardIndex(std::nullopt, 4, Says({{"PARALLEL_SEQ", "4"}})), 3U);
  EXPECT_EQ(ShardIndex(2U, 4, Says({{"PARALLEL_SEQ", "4"}})), 2U) << "--index goes first";
}

TEST(CampaignIndex, IsRefusedInWordsUnlessExactlyOneEngineNamesOneOfThem) {
  EXPECT_THAT(RefusalOf(4, Says({})), HasSubstr("--index 0 to 3"));
  EXPECT_THAT(RefusalOf(4, Says({{"PARALLEL_SEQ", "1"}, {"SLURM_ARRAY_TASK_ID", "0"}})),
              HasSubstr("SLURM_ARRAY_TASK_ID (0), PARALLEL_SEQ (1)"));
  for (const char* wrong : {"4", "-1", "x", "1 ", "99999999999", ""}) {
    EXPECT_THAT(RefusalOf(4, Says({{"JOB_COMPLETION_INDEX", wrong}})), HasSubstr("from 0 to 3"))
        << wrong;
  }
  EXPECT_THAT(RefusalOf(4, Says({{"PARALLEL_SEQ", "0"}})), HasSubstr("from 1 to 4"));
  EXPECT_THAT(RefusalOf(4, Says({{"PARALLEL_SEQ", "5"}})), HasSubstr("from 1 to 4"));
  EXPECT_THROW(ShardIndex(4U, 4, Says({})), InputError);
}

}  // namespace
}  // namespace giveway::fleetctl
