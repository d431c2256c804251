#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "services/config/byte_size.h"
#include "services/config/impair.h"
#include "services/fleetctl/args/duration_flag.h"
#include "services/fleetctl/args/flag_checks.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/process/domain_lock.h"
#include "services/fleetctl/run/run.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kRunFooter = R"(
Every flag but --html, --json, --picture and --logs has a twin in the environment: --domain is also
GIVEWAY_DOMAIN. The flag wins.

Examples
  fleetctl run intersection_yield
  fleetctl run intersection_equal --picture equal.svg
  fleetctl run intersection_yield --seed 7 --json | jq .min_separation_m
  fleetctl run open_fleet --vehicles 4 --restart
  fleetctl run intersection_yield --record tapes && fleetctl replay tapes/*
  fleetctl run intersection_yield --record-topics run.mcap && fleetctl report run.mcap
  fleetctl run intersection_yield --impair loss=0.1,delay=20ms,jitter=5ms
  fleetctl run my_crossing.textproto --behaviour lecture_yield --logs logs

Exit code: 0 passed, 1 failed or interrupted, or passed and a picture or recording could not be
written; 2 could not run.
)";

std::string CheckSplit(const std::string& text) {
  const std::optional<std::uint64_t> bytes = ParseByteSize(text);
  if (bytes && *bytes >= kLeastSplitBytes && *bytes <= kMostSplitBytes) return {};
  return "'" + text + "' is no size a recording is split by; " + kSplitRemedy;
}

void AddScenarioFlags(CLI::App* verb, RunOptions* options) {
  verb->add_option("SCENARIO", options->scenario, "A scenario file, or the name of a shipped one")
      ->required();
  AddTimeFlag(verb, "--duration", &options->fleet.duration_s, "End after this time")
      ->default_str("the scenario's")
      ->envname("GIVEWAY_DURATION");
  verb->add_option_function<std::string>(
          "--behaviour",
          [options](const std::string& name) { options->fleet.behaviour = ParseBehaviour(name); },
          "Every vehicle drives so: cooperative, lecture_avoid, stock_avoid, lecture_yield, or "
          "lecture_printed, which shows the flaws of the printed scripts: it collides")
      ->envname("GIVEWAY_BEHAVIOUR");
  verb->add_option("--seed", options->fleet.seed,
                   "Moves start poses and cruise speeds; 0 moves nothing")
      ->check(CLI::Range(0U, std::numeric_limits<std::uint32_t>::max()))
      ->envname("GIVEWAY_SEED");
  verb->add_option(
          "--vehicles", options->fleet.vehicles,
          "Of an open fleet: start so many that the scenario does not name; without it as many as "
          "its start_with says, which is 1 in patrol, rush_hour, city_grid and "
          "warehouse_loop")
      ->check(CLI::Range(0U, kMostStarted))
      ->envname("GIVEWAY_VEHICLES");
  verb->add_flag(
          "--restart", options->restart,
          "Of an open fleet: start a process that dies again, a vehicle by its id, the world from "
          "its checkpoint")
      ->envname("GIVEWAY_RUN_RESTART");
  verb->add_flag("--lockstep", options->fleet.lockstep,
                 "The world waits for every command of a tick")
      ->envname("GIVEWAY_LOCKSTEP");
}

void AddLinkFlags(CLI::App* verb, RunOptions* options) {
  verb->add_option("--domain", options->domain, "DDS domain; without it the first free one")
      ->check(CLI::Range(kFirstDomain, kLastDomain))
      ->envname("GIVEWAY_DOMAIN");
  AddInterfaceFlag(verb, &options->fleet.interface);
  AddDiscoveryFlag(verb, &options->fleet.discovery_servers);
  verb->add_option(
          "--qos", options->qos_file,
          "Fast DDS XML profiles: a file, or a shipped set (lossy_radio, same_host, ...); without "
          "it the default")
      ->type_name("SET|FILE")
      ->check(CheckNotEmpty)
      ->envname("GIVEWAY_QOS");
  verb->add_option(
          "--admin-key", options->fleet.admin_key,
          "Orders (qos apply) are sealed with the key in this file; without it, one is made "
          "that this user's fleetctl finds, for as long as the run lasts")
      ->type_name("FILE")
      ->check(CheckNotEmpty)
      ->envname("GIVEWAY_ADMIN_KEY");
  verb->add_option("--impair", options->fleet.impair,
                   "Impair what every vehicle receives, instead of the scenario: "
                   "loss=10%,delay=20ms, or none; link/impairment/README.md lists the keys")
      ->check(CheckImpairment)
      ->envname("GIVEWAY_IMPAIR");
}

void AddOutputFlags(CLI::App* verb, RunOptions* options) {
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else");
  verb->add_option("--html", options->html_file, "Write a page that shows the run into this file")
      ->check(CheckNotEmpty);
  verb->add_option("--picture", options->picture_file, "Draw both paths as SVG into this file")
      ->check(CheckNotEmpty);
  verb->add_option("--logs", options->fleet.logs_folder,
                   "Keep the log of every process in this folder")
      ->check(CheckNotEmpty);
  verb->add_option("--record", options->fleet.record_folder,
                   "Every vehicle records its inputs and decisions in this folder; see replay")
      ->check(CheckNotEmpty)
      ->envname("GIVEWAY_RECORD");
  verb->add_option("--record-topics", options->topics_file,
                   "Record every topic as it travels into this MCAP file, with the recordings of "
                   "--record within it; it must not be there yet")
      ->type_name("FILE")
      ->check(CheckRecordingName)
      ->envname("GIVEWAY_RECORD_TOPICS");
  verb->add_option("--record-split", options->fleet.record_split,
                   "Start another file of each recording at this size: 64MiB")
      ->check(CheckSplit)
      ->needs("--record")
      ->envname("GIVEWAY_RECORD_SPLIT");
  verb->add_option("--record-ring", options->fleet.record_ring,
                   "Keep only the last so many seconds of each recording: 60")
      ->check(CLI::Range(5U, 3600U))
      ->excludes("--record-split")
      ->needs("--record")
      ->envname("GIVEWAY_RECORD_RING");
  verb->add_option("--log-level", options->fleet.log_level, "Of the world and the vehicles")
      ->check(CLI::IsMember({"debug", "info", "warning", "error"}))
      ->capture_default_str()
      ->envname("GIVEWAY_LOG_LEVEL");
}

}  // namespace

void AddRunVerb(CLI::App* fleetctl, int* exit_code) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* verb =
      fleetctl->add_subcommand("run", "Run a scenario here, one process a vehicle, and judge it");
  verb->footer(kRunFooter);
  AddScenarioFlags(verb, options.get());
  AddLinkFlags(verb, options.get());
  AddOutputFlags(verb, options.get());
  verb->callback([options, exit_code] { *exit_code = Run(*options); });
}

}  // namespace giveway::fleetctl
