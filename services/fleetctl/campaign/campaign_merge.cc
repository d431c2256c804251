#include "services/fleetctl/campaign/campaign_merge.h"

#include <fmt/format.h>

#include <map>
#include <utility>

namespace giveway::fleetctl {
namespace {

// Some pages of a terminal: enough to run all of them again in any cut but the oddest.
constexpr std::size_t kMostPieces = 1000;

// Why `other` cannot be of the same campaign as `first`; nothing if it can.
void CompareIdentity(const NamedShard& first, const NamedShard& other, ProblemList* problems) {
  const ShardResult& a = first.result;
  const ShardResult& b = other.result;
  const auto differs = [&](const char* field, const auto& wanted, const auto& value,
                           const char* remedy) {
    if (wanted == value) return;
    problems->Add({.file = other.where,
                   .field = field,
                   .value = fmt::format("{}", value),
                   .message = fmt::format("is {} in {}", wanted, first.where),
                   .remedy = remedy});
  };
  differs("plan", a.plan, b.plan, "merge results of one plan, fault file included");
  differs("program", a.program, b.program, "run all shards by one fleetctl");
  differs("of", a.shard.of, b.shard.of, "cut all shards alike: one --of");
}

bool IsOfOneCampaign(const ShardResult& a, const ShardResult& b) {
  return a.plan == b.plan && a.program == b.program && a.shard.of == b.shard.of;
}

std::vector<std::string> NamesOf(const ShardResult& result) {
  std::vector<std::string> names;
  for (const CampaignSums& sums : result.generators) names.push_back(sums.generator);
  return names;
}

// Two of one plan agree on these, unless they were edited.
void CompareContents(const NamedShard& first, const NamedShard& other, ProblemList* problems) {
  const ShardResult& a = first.result;
  const ShardResult& b = other.result;
  if (a.campaign == b.campaign && a.flags == b.flags && a.planned_runs == b.planned_runs &&
      NamesOf(a) == NamesOf(b)) {
    return;
  }
  problems->Add({.file = other.where,
                 .message = "has the plan of " + first.where +
                            ", but another name, generators, flags or number of runs",
                 .remedy = "remove it and run the shard again"});
}

// The shards of `of` that are missing.
void FindLacking(const NamedShard& first, const std::map<std::uint32_t, std::string>& brought,
                 ProblemList* problems) {
  const std::uint32_t of = first.result.shard.of;
  std::vector<std::uint32_t> lacking;
  for (std::uint32_t index = 0; index < of; ++index) {
    if (!brought.contains(index)) lacking.push_back(index);
  }
  if (lacking.empty()) return;
  problems->Add(
      {.file = first.result.campaign,
       .field = "index",
       .value = NumberRanges(lacking),
       .message = fmt::format("missing: {} of {} shards", lacking.size(), of),
       .remedy = fmt::format("run each of them by the same fleetctl: campaign shard PLAN "
                             "--of {} --index {}; PLAN is that of the name {} and hash {}",
                             of, lacking.front(), first.result.campaign, first.result.plan)});
}

void AddShard(const ShardResult& shard, CampaignResult* result) {
  if (result->generators.empty()) {
    *result = {shard.campaign, shard.plan, shard.program, shard.flags, shard.generators};
    return;
  }
  for (std::size_t i = 0; i < result->generators.size(); ++i) {
    result->generators[i].Merge(shard.generators[i]);
  }
}

void CheckRuns(const CampaignResult& result, std::uint32_t planned, ProblemList* problems) {
  const std::uint32_t runs = SumOf(result.generators).runs;
  if (runs == planned) return;
  problems->Add({.file = result.campaign,
                 .field = "runs",
                 .value = std::to_string(runs),
                 .message = fmt::format("of all shards; the plan has {}", planned),
                 .remedy = "a result is damaged: remove them and run the shards again"});
}

}  // namespace

std::string NumberRanges(const std::vector<std::uint32_t>& ascending) {
  std::string text;
  std::size_t pieces = 0;
  for (std::size_t i = 0; i < ascending.size();) {
    std::size_t last = i;
    while (last + 1 < ascending.size() && ascending[last + 1] == ascending[last] + 1) ++last;
    if (++pieces > kMostPieces) return text + fmt::format(" and {} more", ascending.size() - i);
    text += text.empty() ? "" : ",";
    text += last == i ? fmt::format("{}", ascending[i])
                      : fmt::format("{}-{}", ascending[i], ascending[last]);
    i = last + 1;
  }
  return text;
}

MergedCampaign MergeShards(const std::vector<NamedShard>& shards) {
  MergedCampaign merged;
  if (shards.empty()) return merged;
  ProblemList problems;
  const NamedShard& first = shards.front();
  std::map<std::uint32_t, std::string> brought;
  std::vector<const ShardResult*> added;
  for (const NamedShard& shard : shards) {
    CompareIdentity(first, shard, &problems);
    if (!IsOfOneCampaign(first.result, shard.result)) continue;
    CompareContents(first, shard, &problems);
    const auto [known, is_new] = brought.emplace(shard.result.shard.index, shard.where);
    if (!is_new) {
      problems.Add({.file = shard.where,
                    .field = "index",
                    .value = std::to_string(shard.result.shard.index),
                    .message = "stands in " + known->second + " too",
                    .remedy = "name each shard once"});
    }
    added.push_back(&shard.result);
  }
  FindLacking(first, brought, &problems);
  if (problems.Empty()) {
    for (const ShardResult* shard : added) AddShard(*shard, &merged.result);
    CheckRuns(merged.result, first.result.planned_runs, &problems);
  }
  merged.problems = problems.Sorted();
  return merged;
}

}  // namespace giveway::fleetctl
