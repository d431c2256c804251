#include "services/fleetctl/campaign/campaign.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "services/config/campaign/campaign_file.h"
#include "services/config/problem.h"
#include "services/config/text_file.h"
#include "services/fleetctl/campaign/campaign_identity.h"
#include "services/fleetctl/campaign/campaign_index.h"
#include "services/fleetctl/campaign/campaign_json.h"
#include "services/fleetctl/campaign/campaign_merge.h"
#include "services/fleetctl/campaign/campaign_report.h"
#include "services/fleetctl/campaign/campaign_results.h"
#include "services/fleetctl/campaign/campaign_run.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/output/terminal_text.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/process/program_id.h"
#include "services/runtime/process.h"
#include "sim_world/virtual/generators.h"

namespace giveway::fleetctl {
namespace {

std::optional<std::string> FromEnvironment(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr || *value == '\0') return std::nullopt;
  return value;
}

CampaignPlan LoadPlan(const std::string& path) {
  std::vector<std::string_view> generators;
  for (const sim::Generator& generator : sim::Generators()) generators.push_back(generator.name);
  return LoadCampaign(path, generators);
}

int PrintLine(const std::string& line, bool held) {
  fmt::print("{}\n", line);
  const int code = held ? 0 : 1;
  if (std::fflush(stdout) == 0) return code;
  std::fprintf(stderr, "cannot write the result to stdout\n");
  return 1;
}

bool ShardHeld(const ShardResult& result) {
  return AllHeld({.campaign = result.campaign,
                  .plan = result.plan,
                  .program = result.program,
                  .flags = result.flags,
                  .generators = result.generators});
}

std::string FileOf(const std::string& folder, const CampaignPlan& plan, const ShardOf& shard) {
  return (std::filesystem::path(folder) /
          fmt::format("{}.{}-of-{}.json", plan.name, shard.index, shard.of))
      .string();
}

// The file's content, if it is exactly this shard of this plan by this program; any other content
// is reported, and will be replaced.
std::optional<ShardResult> ThereAlready(const std::string& file, const CampaignPlan& plan,
                                        const ShardOf& shard) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return std::nullopt;
  std::string complaint;
  try {
    ReadShard read = ShardFromJson(ReadTextFile(file));
    const ShardResult& there = read.result;
    if (read.complaint.empty() && there.plan == PlanHash(plan) && there.program == ProgramId() &&
        there.shard.of == shard.of && there.shard.index == shard.index) {
      return std::move(read.result);
    }
    complaint = read.complaint.empty() ? "is of another plan or program" : read.complaint;
  } catch (const InputError& unreadable) {
    complaint = unreadable.what();
  }
  fmt::print(stderr, "{}: {}; the shard is run again and the file replaced\n", file, complaint);
  return std::nullopt;
}

bool ShowDone(std::uint32_t done, std::uint32_t of, double gone_s) {
  if (::isatty(STDERR_FILENO) == 1) {
    const std::string text = fmt::format("{} of {} runs, {}", done, of, TimeLeft(done, of, gone_s));
    fmt::print(stderr, "\r{}\x1b[K{}", ProgressLine(done, of, text, StderrColumns()),
               done == of ? "\r\x1b[K" : "");
    std::fflush(stderr);
  }
  return Interrupts::Count() == 0;
}

}  // namespace

int RunCampaignShard(const CampaignShardOptions& options) {
  const CampaignPlan plan = LoadPlan(options.plan);
  ShardOf shard;
  shard.of = options.of.value_or(plan.shards);
  shard.index = ShardIndex(options.index, shard.of, FromEnvironment);
  if (ProgramId().empty()) {
    throw InputError({{.file = "fleetctl",
                       .message = "was linked without a build id",
                       .remedy = "link it with -Wl,--build-id"}});
  }
  std::string file;
  if (!options.out_folder.empty()) {
    CheckFolder(options.out_folder);
    file = FileOf(options.out_folder, plan, shard);
    if (const auto there = ThereAlready(file, plan, shard)) {
      return PrintLine(ToJson(*there), ShardHeld(*there));
    }
    CheckWritable(file);
  }
  const CampaignMaker maker(plan);
  std::fputs(maker.Remark().c_str(), stderr);
  const Interrupts interrupts(Silence::kComputes);
  const SteadyTime start = SteadyNow();
  const auto show = [start](std::uint32_t done, std::uint32_t of) {
    return ShowDone(done, of, std::chrono::duration<double>(SteadyNow() - start).count());
  };
  const auto result = RunShard(maker, shard, options.jobs, show);
  if (!result) {
    fmt::print(stderr, "shard {} of {} was interrupted and has no result\n", shard.index, shard.of);
    return kShardInterrupted;
  }
  const std::string line = ToJson(*result);
  const int code = PrintLine(line, ShardHeld(*result));
  const CampaignSums all = SumOf(result->generators);
  fmt::print(stderr, "shard {} of {}: {} runs, {} failed, {:.1f} s\n", shard.index, shard.of,
             all.runs, all.failed_runs, Seconds(SteadyNow() - start));
  if (file.empty()) return code;
  return WriteAfterVerdict(code, [&] { WriteFile(file, line + "\n"); });
}

int RunCampaignMerge(const CampaignMergeOptions& options) {
  std::vector<NamedShard> shards;
  ProblemList unreadable;
  for (const std::string& file : options.files) ReadResults(file, &shards, &unreadable);
  MergedCampaign merged = MergeShards(shards);
  for (const Problem& problem : merged.problems) unreadable.Add(problem);
  if (!unreadable.Empty()) throw InputError(unreadable.Sorted());
  const std::string text =
      options.json ? ReportJson(merged.result) + "\n" : ForTerminal(ReportText(merged.result));
  std::fputs(text.c_str(), stdout);
  const int code = AllHeld(merged.result) ? 0 : 1;
  if (std::fflush(stdout) == 0) return code;
  std::fprintf(stderr, "cannot write the report to stdout\n");
  return std::max(code, 1);
}

}  // namespace giveway::fleetctl
