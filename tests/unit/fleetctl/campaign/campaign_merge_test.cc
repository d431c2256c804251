// Results of shards: one campaign whatever the shards were, and what is refused.
#include "services/fleetctl/campaign/campaign_merge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <utility>

#include "services/fleetctl/campaign/campaign_json.h"
#include "services/fleetctl/campaign/campaign_report.h"
#include "tests/unit/fleetctl/campaign/campaign_plans.h"

namespace giveway::fleetctl {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::vector<NamedShard> ShardsOf(const CampaignPlan& plan, std::uint32_t of) {
  std::vector<NamedShard> shards;
  for (std::uint32_t index = 0; index < of; ++index) {
    // As they come back from files.
    ReadShard read = ShardFromJson(ToJson(PretendedShard(plan, {index, of})));
    EXPECT_EQ(read.complaint, "");
    shards.push_back({"r" + std::to_string(index), std::move(read.result)});
  }
  return shards;
}

std::string Refusal(const std::vector<NamedShard>& shards) {
  return Format(MergeShards(shards).problems);
}

TEST(CampaignShardJson, ComesBackAsItWas) {
  const std::string json = ToJson(PretendedShard(SmallCampaign(), {1, 4}));
  const ReadShard read = ShardFromJson(json);
  ASSERT_EQ(read.complaint, "");
  EXPECT_EQ(ToJson(read.result), json);
  EXPECT_EQ(json.find('\n'), std::string::npos);
}

TEST(CampaignShardJson, SaysAllThatIsWrong) {
  ShardResult edited = PretendedShard(SmallCampaign(), {1, 4});
  edited.shard.index = 4;
  edited.plan = "xyz";
  edited.generators[0].generator = "crosing";
  edited.generators[1].failed_runs = 1000;
  EXPECT_THAT(ShardFromJson(ToJson(edited)).complaint,
              AllOf(HasSubstr("index 4 of 4"), HasSubstr("plan is not 16"),
                    HasSubstr("\"crosing\" is no generator"), HasSubstr("swarm: more failed")));
  for (const char* text : {"", "{", "[]", "{\"format\":2}", "{}", "{\"format\":1,\"of\":\"x\"}"}) {
    EXPECT_NE(ShardFromJson(text).complaint, "") << text;
    EXPECT_THAT(ShardFromJson(text).complaint, Not(HasSubstr("\n"))) << text;
  }
}

// Each value of a result is covered: that of any other would pass for this one.
TEST(CampaignShardJson, RefusesWhatWasEdited) {
  const std::string json = ToJson(PretendedShard(SmallCampaign(), {1, 4}));
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {R"("index":1)", R"("index":2)"},
           {R"("plan":")", R"("plan":"0)"},
           {R"("contact":)", R"("contact":1)"},
           {R"("flags":" )", R"("flags":"  )"},
           {R"("delays":[)", R"("delays":[1)"},
           {R"("min_separation_m":0)", R"("min_separation_m":1)"},
           {R"("checksum":")", R"("checksum":"0)"}}) {
    std::string edited = json;
    const std::size_t at = edited.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    edited.replace(at, from.size(), to);
    EXPECT_THAT(ShardFromJson(edited).complaint, HasSubstr("damaged or edited")) << from;
  }
  EXPECT_THAT(ShardFromJson(R"({"format":1})").complaint, HasSubstr("it has no checksum"));
}

// As jq -c writes it again.
TEST(CampaignShardJson, MayBePrintedInAnotherForm) {
  std::string json = ToJson(PretendedShard(SmallCampaign(), {1, 4}));
  json.insert(json.find(",\"of\""), "  ");
  EXPECT_EQ(ShardFromJson(json).complaint, "");
}

TEST(CampaignShardJson, RefusesTheSumsOfAnotherShard) {
  // Of 69 runs shard 0 has 6, 6 and 6, shard 3 has 5, 6 and 6.
  ShardResult mixed = PretendedShard(SmallCampaign(), {0, 4});
  mixed.generators = PretendedShard(SmallCampaign(), {3, 4}).generators;
  EXPECT_THAT(ShardFromJson(ToJson(mixed)).complaint, HasSubstr("crossing: 5 runs; shard 0 of 4"));
  mixed = PretendedShard(SmallCampaign(), {0, 4});
  mixed.planned_runs += 1;
  EXPECT_THAT(ShardFromJson(ToJson(mixed)).complaint, HasSubstr("not the same number"));
}

RC_GTEST_PROP(CampaignMerge, IsTheSameHoweverItWasCutAndInWhateverOrder, ()) {
  const CampaignPlan plan = SmallCampaign();
  const MergedCampaign whole = MergeShards(ShardsOf(plan, 1));
  std::vector<NamedShard> shards = ShardsOf(plan, *rc::gen::inRange<std::uint32_t>(1, 40));
  std::rotate(shards.begin(),
              shards.begin() +
                  *rc::gen::inRange<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(shards.size())),
              shards.end());
  const MergedCampaign merged = MergeShards(shards);
  RC_ASSERT(merged.problems.empty());
  RC_ASSERT(ReportJson(merged.result) == ReportJson(whole.result));
  RC_ASSERT(ReportText(merged.result) == ReportText(whole.result));
}

TEST(CampaignMerge, AddsUp) {
  const CampaignPlan plan = SmallCampaign();
  const CampaignResult result = MergeShards(ShardsOf(plan, 4)).result;
  ASSERT_EQ(result.generators.size(), 3U);
  CampaignSums expected;
  for (std::uint32_t seed = plan.seeds.low; seed <= plan.seeds.high; ++seed) {
    expected.Add(PretendedRun(seed));
  }
  for (const CampaignSums& sums : result.generators) {
    EXPECT_EQ(sums.runs, 23U);
    EXPECT_EQ(sums.hash, expected.hash);
    EXPECT_EQ(sums.vehicle_ms, 23 * 50 * 116);
    EXPECT_EQ(sums.failing_seeds, (std::vector<std::uint32_t>{9, 18, 27}));
    EXPECT_EQ(sums.violations[0], 6U);
    EXPECT_DOUBLE_EQ(*sums.separation_m, 0.033333);
  }
  EXPECT_FALSE(AllHeld(result));
  const std::string report = ReportJson(result);
  EXPECT_THAT(report, HasSubstr(R"("verdict":"failed","reason":"contact")"));
  EXPECT_THAT(report, HasSubstr("fleetctl virtual swarm --seed 18 --vehicles 2..8 --loss 0..20\""));
}

TEST(CampaignMerge, KeepsTheFirstFailingSeedsOfAll) {
  CampaignSums odd;
  CampaignSums even;
  for (std::uint32_t seed = 400; seed-- > 0;) {
    BatchTotals failed;
    failed.failing_seeds = {seed};
    (seed % 2 == 0 ? even : odd).Add(failed);
  }
  odd.Merge(even);
  EXPECT_EQ(odd.failed_runs, 400U);
  ASSERT_EQ(odd.failing_seeds.size(), CampaignSums::kFailingKept);
  EXPECT_EQ(odd.failing_seeds.front(), 0U);
  EXPECT_EQ(odd.failing_seeds.back(), 99U);
}

TEST(CampaignMerge, SaysHowManyFailingSeedsAreLeftOut) {
  CampaignResult result;
  result.generators.resize(2);
  for (std::uint32_t seed = 0; seed < 130; ++seed) {
    BatchTotals failed;
    failed.runs = 1;
    failed.failing_seeds = {seed};
    result.generators[0].Add(failed);
    if (seed < 103) result.generators[1].Add(failed);
  }
  EXPECT_THAT(ReportJson(result), HasSubstr(R"("failing_left_out":33)"));
  EXPECT_THAT(ReportText(result), HasSubstr("and 30 more of"));
}

TEST(CampaignMerge, SaysWhichShardsLack) {
  std::vector<NamedShard> shards = ShardsOf(SmallCampaign(), 12);
  shards.erase(shards.begin() + 5, shards.begin() + 8);
  shards.erase(shards.begin() + 1);
  EXPECT_THAT(Refusal(shards),
              AllOf(HasSubstr("index = 1,5-7: "), HasSubstr("4 of 12"),
                    HasSubstr("--of 12 --index 1; PLAN is that of the name small and hash " +
                              PlanHash(SmallCampaign()))));
}

TEST(CampaignMerge, RefusesAShardTwice) {
  std::vector<NamedShard> shards = ShardsOf(SmallCampaign(), 3);
  shards.push_back(shards[1]);
  shards.back().where = "again";
  EXPECT_THAT(Refusal(shards), AllOf(HasSubstr("again"), HasSubstr("stands in r1 too")));
}

TEST(CampaignMerge, RefusesWhatIsOfAnotherPlanProgramOrCut) {
  const std::vector<NamedShard> shards = ShardsOf(SmallCampaign(), 3);
  std::vector<NamedShard> edited = shards;
  CampaignPlan other = SmallCampaign();
  other.seeds.high += 1;
  edited[1].result = PretendedShard(other, {1, 3});
  EXPECT_THAT(Refusal(edited), AllOf(HasSubstr("r1: plan = "), HasSubstr("in r0")));
  edited = shards;
  edited[2].result.program = "ffff";
  EXPECT_THAT(Refusal(edited), AllOf(HasSubstr("r2: program = ffff"), HasSubstr("in r0")));
  edited = shards;
  edited[2].result = PretendedShard(SmallCampaign(), {2, 4});
  EXPECT_THAT(Refusal(edited), AllOf(HasSubstr("r2: of = 4"), HasSubstr("missing: 1 of 3")));
  edited = shards;
  edited[1].result.flags = " --vehicles 3";
  EXPECT_THAT(Refusal(edited), HasSubstr("r1: has the plan of r0, but another"));
  edited = shards;
  edited[1].result.generators[0].runs += 1;
  EXPECT_THAT(Refusal(edited), HasSubstr("the plan has 69"));
}

TEST(CampaignIdentity, IsOfWhatDecidesARun) {
  const CampaignPlan plan = SmallCampaign();
  CampaignPlan other = plan;
  other.shards = 77;
  EXPECT_EQ(PlanHash(other), PlanHash(plan)) << "the division into shards changes no run";
  const std::vector<void (*)(CampaignPlan*)> changes = {
      [](CampaignPlan* p) { p->name = "b"; },
      [](CampaignPlan* p) { p->generators.pop_back(); },
      [](CampaignPlan* p) { p->seeds.low = 6; },
      [](CampaignPlan* p) { p->seeds.high = 28; },
      [](CampaignPlan* p) { p->vehicles->low = 3; },
      [](CampaignPlan* p) { p->vehicles->high = 9; },
      [](CampaignPlan* p) { p->loss_percent.low = 0.1; },
      [](CampaignPlan* p) { p->loss_percent.high = 21; },
      [](CampaignPlan* p) { p->burst = true; },
      [](CampaignPlan* p) { p->delay_ms = 1; },
      [](CampaignPlan* p) { p->jitter_ms = 1; },
      [](CampaignPlan* p) { p->reorder_percent = 1; },
      [](CampaignPlan* p) { p->duplicate_percent = 1; },
      [](CampaignPlan* p) { p->loops_back = true; },
      [](CampaignPlan* p) { p->crashes = 1; },
      [](CampaignPlan* p) { p->pauses = 1; },
      [](CampaignPlan* p) { p->restarts = 1; },
      [](CampaignPlan* p) { p->vehicles.reset(); },
      [](CampaignPlan* p) { p->duration_s = 60; },
      [](CampaignPlan* p) { p->scenario_text = "name: 1"; },
      [](CampaignPlan* p) { p->fault_file = "calm"; },
      [](CampaignPlan* p) { p->fault_text = "at {}"; },
      [](CampaignPlan* p) { p->skip_unsupported = true; },
  };
  std::vector<std::string> hashes{PlanHash(plan)};
  for (const auto change : changes) {
    other = plan;
    change(&other);
    hashes.push_back(PlanHash(other));
  }
  std::ranges::sort(hashes);
  EXPECT_EQ(std::ranges::adjacent_find(hashes), hashes.end());
}

TEST(CampaignIdentity, GivesTheFlagsOfOneRun) {
  CampaignPlan plan = SmallCampaign();
  plan.vehicles = CampaignWholes{12, 12};
  plan.loss_percent = {2.5, 2.5};
  plan.burst = true;
  plan.pauses = 2;
  plan.fault_file = "my faults/it's.textproto";
  plan.skip_unsupported = true;
  EXPECT_EQ(FlagsOf(plan),
            " --vehicles 12 --loss 2.5 --burst --pauses 2 --faults 'my faults/it'\\''s.textproto' "
            "--skip-unsupported");
}

CampaignPlan OfAScenario() {
  CampaignPlan plan = SmallCampaign();
  plan.generators = {"my places/yard.textproto"};
  plan.scenario_text = "name: 1";
  plan.vehicles.reset();
  plan.duration_s = 60.5;
  return plan;
}

TEST(CampaignMerge, OfAScenarioShowsRunsThatMissWhatItExpects) {
  std::vector<NamedShard> shards = ShardsOf(OfAScenario(), 2);
  BatchTotals missed;
  missed.runs = 1;
  missed.unmet = 1;
  missed.failing_seeds = {1};
  for (NamedShard& shard : shards) {
    shard.result.generators[0].Add(missed);
    shard.result.planned_runs += 2;
    shard.result = ShardFromJson(ToJson(shard.result)).result;
  }
  const MergedCampaign merged = MergeShards(shards);
  EXPECT_EQ(Format(merged.problems), "");
  EXPECT_THAT(
      ReportJson(merged.result),
      AllOf(HasSubstr(R"("expectation":2)"), HasSubstr(R"("reason":"contact, expectation")"),
            HasSubstr("fleetctl virtual 'my places/yard.textproto' --seed 1 --duration 60.5"
                      " --loss 0..20\"")));
}

TEST(CampaignShardJson, HasAScenarioAlone) {
  EXPECT_EQ(ShardFromJson(ToJson(PretendedShard(OfAScenario(), {0, 2}))).complaint, "");
  CampaignPlan beside = OfAScenario();
  beside.generators.emplace_back("swarm");
  EXPECT_THAT(ShardFromJson(ToJson(PretendedShard(beside, {0, 2}))).complaint,
              HasSubstr("is no generator"));
}

TEST(CampaignNumbers, AreBounded) {
  std::vector<std::uint32_t> odd;
  for (std::uint32_t number = 1; number < 2200; number += 2) odd.push_back(number);
  EXPECT_THAT(NumberRanges(odd), HasSubstr(",1997,1999 and 100 more"));
  EXPECT_EQ(NumberRanges({0, 1, 2}), "0-2");
  EXPECT_EQ(NumberRanges({2, 5, 6, 7, 9}), "2,5-7,9");
  EXPECT_THAT(NumberRanges({}), IsEmpty());
  EXPECT_EQ(NumberRanges({3}), "3");
}

}  // namespace
}  // namespace giveway::fleetctl
