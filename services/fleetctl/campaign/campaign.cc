#include "services/fleetctl/campaign/campaign.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <set>
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
#include "services/fleetctl/process/exit_codes.h"
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

// By fputs, since fmt::print throws where stderr is full or closed, which must not change what the
// shard ends with.
void PrintError(const std::string& text) { std::fputs(text.c_str(), stderr); }

// False, with a message, unless stdout took all of it. By fputs, since fmt::print throws where a
// line longer than the buffer is not written.
bool Print(const std::string& text, const char* what) {
  if (PrintAll(text)) return true;
  PrintError(fmt::format("cannot write {} to stdout\n", what));
  return false;
}

bool IsWritten(const std::string& file, const std::string& text) {
  try {
    WriteFile(file, text);
    return true;
  } catch (const OutputError& error) {
    PrintError(std::string(error.what()) + "\n");
    return false;
  }
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

// Both places are tried, the file first: what was computed is lost only if neither takes it.
int Deliver(const ShardResult& result, const std::string& file) {
  const std::string line = ToJson(result) + "\n";
  const bool is_written = file.empty() || IsWritten(file, line);
  const bool is_printed = Print(line, "the result");
  if (!is_written || !is_printed) return kShardNotDone;
  return ShardHeld(result) ? 0 : 1;
}

// What an earlier process left in place of the shard's file.
struct EarlierFile {
  std::optional<ShardResult> result;  // exactly this shard of this plan by this program
  std::string complaint;              // why it is not; empty: nothing is there
};

EarlierFile ReadEarlier(const std::string& file, const CampaignPlan& plan, const ShardOf& shard) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (std::filesystem::is_directory(status)) {
    throw OutputError(file + ": is a folder; remove it, or name another place with --out");
  }
  if (!std::filesystem::is_regular_file(status)) return {};
  try {
    ReadShard read = ShardFromJson(ReadTextFile(file));
    if (!read.complaint.empty()) return {{}, read.complaint};
    const ShardResult& there = read.result;
    if (there.plan == PlanHash(plan) && there.program == ProgramId() &&
        there.shard.of == shard.of && there.shard.index == shard.index) {
      return {std::move(read.result), {}};
    }
    return {{}, "is of another plan or program"};
  } catch (const InputError& unreadable) {
    // Without its remedy, which is for those who wrote the file.
    return {{}, unreadable.Problems().front().message};
  }
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

// Only for a person. Runtimes of containers read stdout and stderr apart from each other, and cut a
// long line into pieces: a line on stderr next to the result would land inside it in the pod's log,
// which would then have no result.
void ShowEnd(const ShardResult& result, double took_s) {
  if (::isatty(STDERR_FILENO) != 1) return;
  const CampaignSums all = SumOf(result.generators);
  fmt::print(stderr, "shard {} of {}: {} runs, {} failed, {:.1f} s\n", result.shard.index,
             result.shard.of, all.runs, all.failed_runs, took_s);
}

int RunNow(const CampaignMaker& maker, const ShardOf& shard, std::uint32_t jobs,
           const std::string& file) {
  PrintError(maker.Remark());
  const SteadyTime start = SteadyNow();
  const auto gone_s = [start] { return Seconds(SteadyNow() - start); };
  const auto show = [&](std::uint32_t done, std::uint32_t of) {
    return ShowDone(done, of, gone_s());
  };
  const auto result = RunShard(maker, shard, jobs, show);
  if (!result) {
    PrintError(
        fmt::format("shard {} of {} was interrupted and has no result\n", shard.index, shard.of));
    return Interrupts::SignalCode();
  }
  ShowEnd(*result, gone_s());
  return Deliver(*result, file);
}

int FindOrRun(const CampaignShardOptions& options) {
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
    const EarlierFile earlier = ReadEarlier(file, plan, shard);
    if (earlier.result) return Deliver(*earlier.result, {});
    CheckWritable(file);
    if (!earlier.complaint.empty()) {
      PrintError(fmt::format("{}: {}; the shard is run again and the file replaced\n", file,
                             earlier.complaint));
    }
  }
  return RunNow(CampaignMaker(plan), shard, options.jobs, file);
}

// The files without those that are named again, however spelt: each of their shards would be
// reported as standing there twice.
std::vector<std::string> EachOnce(const std::vector<std::string>& files, ProblemList* problems) {
  std::set<std::filesystem::path> known;
  std::vector<std::string> once;
  for (const std::string& file : files) {
    std::error_code error;
    const auto path = std::filesystem::weakly_canonical(file, error);
    if (error || known.insert(path).second) {
      once.push_back(file);
    } else {
      problems->Add(
          {.file = file, .message = "is given twice", .remedy = "name each file of results once"});
    }
  }
  return once;
}

}  // namespace

int RunCampaignShard(const CampaignShardOptions& options) {
  // From the start: as the first process of a container it would not be stopped without a handler.
  const Interrupts interrupts(Silence::kComputes, HardExit::kAsSignal);
  try {
    return FindOrRun(options);
  } catch (const InputError&) {
    throw;
  } catch (const OutputError& error) {
    if (!error.MayPass()) throw;
    PrintError(std::string(error.what()) + "; then run the shard again\n");
    return kShardNotDone;
  } catch (const std::exception& lacking) {  // no thread, no memory: main would exit with 2
    PrintError(fmt::format("the shard cannot be run now: {}; run it again\n", lacking.what()));
    return kShardNotDone;
  }
}

int RunCampaignMerge(const CampaignMergeOptions& options) {
  std::vector<NamedShard> shards;
  ProblemList problems;
  for (const std::string& file : EachOnce(options.files, &problems)) {
    ReadResults(file, &shards, &problems);
  }
  const MergedCampaign merged = MergeShards(shards);
  for (const Problem& problem : merged.problems) problems.Add(problem);
  if (!problems.Empty()) throw InputError(problems.Sorted());
  const std::string text =
      options.json ? ReportJson(merged.result) + "\n" : ForTerminal(ReportText(merged.result));
  // Without its report it has no verdict, whatever the results say.
  if (!Print(text, "the report")) return kCouldNotRun;
  return AllHeld(merged.result) ? 0 : 1;
}

}  // namespace giveway::fleetctl
