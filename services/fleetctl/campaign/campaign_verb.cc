#include <memory>

#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/campaign/campaign.h"
#include "services/fleetctl/campaign/campaign_runs.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kShardFooter = R"(
Runs one of the K shards of the campaign and prints one JSON object. PLAN is a file, or the name of a shipped
one; idl/campaign.proto documents each field. Without --index the engine that started it says which shard:
JOB_COMPLETION_INDEX (Kubernetes), SLURM_ARRAY_TASK_ID, or PARALLEL_SEQ - 1 (GNU parallel). With --out DIR
the object is also a file there, NAME.I-of-K.json, written whole or not at all; where that is there already,
of the same plan and program, it is printed and nothing is run. Unless it is a terminal, nothing is written
on stderr around the object, where it would mix with it in the log of a container.

Examples
  fleetctl campaign shard nightly --of 200 --index 0 --out results
  seq 200 | parallel -N0 fleetctl campaign shard nightly --of 200 > nightly.log
  parallel fleetctl campaign shard nightly --of 200 --index ::: 17 40 >> nightly.log  # the missing ones

Exit code: 0 all held, 1 something did not, 2 could not run. Of what may end otherwise the next time:
75 no thread or memory, or the object could not be written to the file or to stdout, or its folder
not be made, of a full disk, say; 130 interrupted by Ctrl-C, 143 by SIGTERM: no result.
)";

constexpr const char* kMergeFooter = R"(
Adds up the results of all shards of a campaign, each once, all of one plan and one program. A RESULT is a
file of --out, or the log of shards: lines that do not start with { are skipped. Each failing run, of
a generator the first 100, is shown with the command that runs it again. The JSON object is the same whatever the shards were.

Examples
  fleetctl campaign merge results/*.json
  fleetctl campaign merge results/*.json --json | jq -r '.failing[].command'

Exit code: 0 all held, 1 something did not, 2 no result: a shard is missing, given twice, damaged or
of another campaign, or the report could not be written.
)";

constexpr const char* kCampaignFooter = R"(
Examples
  fleetctl campaign shard nightly --of 200 --index 0 --out results
  fleetctl campaign merge results/*.json

More: fleetctl campaign shard --help
)";

void AddShard(CLI::App* group, int* exit_code) {
  const auto options = std::make_shared<CampaignShardOptions>();
  CLI::App* verb = group->add_subcommand("shard", "Run one shard of a campaign");
  verb->footer(kShardFooter);
  verb->add_option("PLAN", options->plan, "A campaign file, or the name of a shipped one")
      ->required();
  verb->add_option("--of", options->of, "Into how many shards it is cut; default as the plan says")
      ->check(CLI::Range(1U, kMostShards));
  verb->add_option("--index", options->index, "Which shard, from 0; default as the engine says")
      ->check(CLI::Range(0U, kMostShards - 1));
  verb->add_option("--jobs", options->jobs, "Runs at a time")
      ->default_str("1")
      ->check(CLI::Range(1U, 1024U));
  verb->add_option("--out", options->out_folder, "Folder for the result; made if it is missing");
  verb->callback([options, exit_code] { *exit_code = RunCampaignShard(*options); });
}

void AddMerge(CLI::App* group, int* exit_code) {
  const auto options = std::make_shared<CampaignMergeOptions>();
  CLI::App* verb = group->add_subcommand("merge", "Add up the results of all shards");
  verb->footer(kMergeFooter);
  verb->add_option("RESULT", options->files, "Files or logs of shards")->required();
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else");
  verb->callback([options, exit_code] { *exit_code = RunCampaignMerge(*options); });
}

}  // namespace

void AddCampaignVerb(CLI::App* fleetctl, int* exit_code) {
  CLI::App* verb = fleetctl->add_subcommand(
      "campaign", "Many virtual runs cut into shards, which any number of machines run");
  verb->require_subcommand(1);
  verb->footer(kCampaignFooter);
  AddShard(verb, exit_code);
  AddMerge(verb, exit_code);
}

}  // namespace giveway::fleetctl
