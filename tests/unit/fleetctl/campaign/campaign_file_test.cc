// Campaign files: what they contain, and that all problems are reported together.
#include "services/config/campaign/campaign_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/config/problem.h"
#include "sim_world/virtual/generators.h"
#include "tests/unit/config/problem_matcher.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

CampaignPlan LoadCampaignText(const std::string& text) {
  std::vector<std::string_view> generators;
  for (const sim::Generator& generator : sim::Generators()) generators.push_back(generator.name);
  const TempFolder folder;
  return LoadCampaign(folder.Write("c.textproto", text), generators);
}

std::vector<Problem> ProblemsOfCampaign(const std::string& text) {
  try {
    LoadCampaignText(text);
  } catch (const InputError& error) {
    return error.Problems();
  }
  return {};
}

constexpr const char* kLeast = "name: \"a\"\ngenerator: \"swarm\"\nseeds: [3, 9]\n";

TEST(CampaignFile, SaysEverythingThereIs) {
  const CampaignPlan plan = LoadCampaignText(R"(name: "all-1"
description: "everything"
generator: ["crossing", "swarm"]
seeds: [7, 9]
vehicles: [3, 20]
loss_percent: [1.5, 20]
burst: true delay_ms: 10 jitter_ms: 20 reorder_percent: 3 duplicate_percent: 4 loopback: true
crashes: 1 pauses: 2 restarts: 3
faults: "calm" skip_unsupported: true
shards: 12)");
  EXPECT_EQ(plan.name, "all-1");
  EXPECT_THAT(plan.generators, ElementsAre("crossing", "swarm"));
  EXPECT_EQ(plan.Runs(), 6U);
  EXPECT_EQ(plan.vehicles->low, 3U);
  EXPECT_EQ(plan.vehicles->high, 20U);
  EXPECT_EQ(plan.loss_percent.low, 1.5);
  EXPECT_EQ(plan.loss_percent.high, 20);
  EXPECT_TRUE(plan.burst && plan.loops_back && plan.skip_unsupported);
  EXPECT_THAT((std::vector<double>{plan.delay_ms, plan.jitter_ms, plan.reorder_percent,
                                   plan.duplicate_percent}),
              ElementsAre(10, 20, 3, 4));
  EXPECT_THAT((std::vector<std::uint32_t>{plan.crashes, plan.pauses, plan.restarts, plan.shards}),
              ElementsAre(1, 2, 3, 12));
  EXPECT_EQ(plan.fault_file, "calm");
  EXPECT_NE(plan.fault_text.find("random"), std::string::npos);
}

TEST(CampaignFile, NeedsLittle) {
  const CampaignPlan plan = LoadCampaignText(kLeast);
  EXPECT_EQ(plan.seeds.low, 3U);
  EXPECT_EQ(plan.seeds.high, 9U);
  EXPECT_EQ(plan.vehicles->low, 6U);
  EXPECT_EQ(plan.vehicles->high, 6U);
  EXPECT_THAT(plan.scenario_text, IsEmpty());
  EXPECT_EQ(plan.loss_percent.high, 0);
  EXPECT_EQ(plan.shards, 1U);
  EXPECT_THAT(plan.fault_file, IsEmpty());
}

TEST(CampaignFile, SaysAllThatIsWrongAtOnce) {
  EXPECT_THAT(
      ProblemsOfCampaign(R"(name: "No Name"
generator: "crosing"
generator: "swarm"
generator: "swarm"
seeds: [9, 3]
vehicles: [1, 8]
loss_percent: 100
jitter_ms: nan
crashes: 1001
skip_unsupported: true
shards: 0
vehicle: 3)"),
      ElementsAre(Is(1, "name", "a-z 0-9"), Is(2, "generator[0]", "is no generator"),
                  Is(4, "generator[2]", "stands there already"), Is(5, "seeds", "lowest is above"),
                  Is(6, "vehicles[0]", "between 2"), Is(7, "loss_percent[0]", "between 0 and 99"),
                  Is(8, "jitter_ms", "not a finite"), Is(9, "crashes", "1000"),
                  Is(10, "skip_unsupported", "without faults"), Is(11, "shards", "between 1"),
                  Is(12, "vehicle", "")));
}

TEST(CampaignFile, NeedsNameGeneratorAndSeeds) {
  EXPECT_THAT(ProblemsOfCampaign("shards: 2\n"),
              ElementsAre(Is(1, "name", ""), Is(1, "generator", ""), Is(1, "seeds", "")));
}

TEST(CampaignFile, MayRunAScenario) {
  const std::string text = "name: \"a\"\nscenario: \"four_way\"\nseeds: 3\n";
  const CampaignPlan plan = LoadCampaignText(text);
  EXPECT_THAT(plan.generators, ElementsAre("four_way"));
  EXPECT_NE(plan.scenario_text.find("vehicle"), std::string::npos);
  EXPECT_EQ(plan.Runs(), 1U);
  EXPECT_FALSE(plan.vehicles || plan.duration_s);
  EXPECT_EQ(LoadCampaignText(text + "duration_s: 20").duration_s, 20);
}

// Regression: what LoadFaults reads, 64 MiB, was refused as larger than 8 MiB.
TEST(CampaignFile, TakesAFaultFileAsLargeAsAnyOtherReaderDoes) {
  const TempFolder folder;
  std::string faults = "description: \"long\"\n";
  while (faults.size() < (9U << 20)) faults += "# " + std::string(1000, '-') + "\n";
  const std::string file = folder.Write("f.textproto", faults);
  const CampaignPlan plan = LoadCampaignText(std::string(kLeast) + "faults: \"" + file + "\"\n");
  EXPECT_EQ(plan.fault_text.size(), faults.size());
}

TEST(CampaignFile, SaysWhatIsWrongWithItsScenario) {
  const std::string least = "name: \"a\"\nseeds: 3\n";
  EXPECT_THAT(
      ProblemsOfCampaign(least + "scenario: \"convoy\"\nduration_s: 0\ngenerator: \"swarm\""),
      ElementsAre(Is(3, "scenario", "is a generator too"), Is(4, "duration_s", "between 1"),
                  Is(5, "generator", "together with a scenario")));
  EXPECT_THAT(ProblemsOfCampaign(least + "scenario: \"-x\""),
              ElementsAre(Is(3, "scenario", "no name")));
  EXPECT_THAT(ProblemsOfCampaign(std::string(kLeast) + "duration_s: 9"),
              ElementsAre(Is(4, "duration_s", "without a scenario")));
  const TempFolder folder;
  const std::string file = folder.Write("s.textproto", "seed: 3\nspeed: 4\n");
  const auto problems = ProblemsOfCampaign(least + "scenario: \"" + file + "\"\nshards: 0");
  ASSERT_GE(problems.size(), 2U);
  EXPECT_EQ(problems.front().field, "shards");
  EXPECT_EQ(problems.back().file, file);
}

TEST(CampaignFile, IsBounded) {
  EXPECT_THAT(ProblemsOfCampaign("name: \"a\" generator: [\"swarm\", \"crossing\"]\n"
                                 "seeds: [0, 50000000]"),
              ElementsAre(Is(2, "seeds", "100000002 runs")));
  EXPECT_THAT(ProblemsOfCampaign("name: \"a\" generator: \"swarm\"\nseeds: [1, 2, 3]"),
              ElementsAre(Is(2, "seeds", "at most 2")));
}

TEST(CampaignFile, SaysWhatIsWrongWithItsFaultFileToo) {
  const TempFolder folder;
  const std::string faults = folder.Write("f.textproto", "at { name: \"a\" kind: \"puase\" }\n");
  const auto problems =
      ProblemsOfCampaign(std::string(kLeast) + "faults: \"" + faults + "\"\nshards: 0\n");
  ASSERT_GE(problems.size(), 2U);
  EXPECT_EQ(problems.front().field, "shards");
  EXPECT_EQ(problems.back().file, faults);
  EXPECT_EQ(ProblemsOfCampaign(std::string(kLeast) + "faults: \"no_such\"").size(), 1U);
  EXPECT_THAT(ProblemsOfCampaign(std::string(kLeast) + "faults: \"-x\""),
              ElementsAre(Is(4, "faults", "no name")));
}

}  // namespace
}  // namespace giveway
