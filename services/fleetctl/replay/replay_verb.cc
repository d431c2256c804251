#include <cstdio>
#include <memory>

#include "services/fleetctl/args/flag_checks.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/playback/playback.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/replay/replay.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kReplayFooter = R"(
A recording is what giveway-vehicle --record FILE, or fleetctl run --record FOLDER, writes. A fresh
brain is given the same inputs; every command, every beacon and the hash of its state must come out
bit for bit as recorded. A file cut off by kill -9, or by a full disk, is replayed up to its last whole
record. The parts of a recording that was split by size are replayed one after the other: name them all,
in any order. Those of a ring (--record-ring) replay by themselves too.
The trace has the columns of fleetctl virtual --trace; places are where the vehicle believed to be.

An MCAP file, as fleetctl record writes it, is shown on a page instead, with seek, pause and speed.

Examples
  fleetctl replay run.mcap --scenario intersection_yield
  fleetctl run intersection_yield --record tapes && fleetctl replay tapes/*
  fleetctl replay tapes/vehicle-2.recording --trace 2.tsv
  fleetctl replay tapes/* --json | jq '.files[] | select(.difference)'

Exit code: 0 all the same, 1 a step differs, 2 a file could not be replayed to its end. Of an MCAP
file: 0 shown, 1 there is nothing of a fleet in it, 2 it could not be read, or is damaged and was shown
up to there. One that was cut off is whole as far as it goes.
)";

}  // namespace

void AddReplayVerb(CLI::App* fleetctl, int* exit_code) {
  const auto options = std::make_shared<ReplayOptions>();
  CLI::App* verb =
      fleetctl->add_subcommand("replay", "Repeat recorded decisions, and compare them bit for bit");
  verb->footer(kReplayFooter);
  verb->add_option("FILE", options->files, "Recordings")->required();
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else");
  verb->add_option("--trace", options->trace_file, "Write every decision of the only recording");
  const auto page = std::make_shared<PlaybackOptions>();
  CLI::Option* const port =
      verb->add_option("--port", page->port, "Of an MCAP file: port of the page; default 8080")
          ->check(CLI::Range(1U, 65535U));
  verb->add_option("--address", page->address, "Of an MCAP file: address of the page")
      ->check(CheckNotEmpty)
      ->capture_default_str();
  verb->add_option("--scenario", page->scenario,
                   "Of an MCAP file: shows the walls of this scenario");
  verb->add_option("--html", page->html_file, "Of an MCAP file: write the page with the run in it");
  verb->callback([options, page, port, exit_code] {
    const bool shown = options->files.size() == 1 && IsMcapFile(options->files.front());
    if (shown && (options->json || !options->trace_file.empty())) {
      std::fprintf(stderr, "%s: an MCAP file is shown on a page; leave out --json and --trace\n",
                   options->files.front().c_str());
      *exit_code = kCouldNotRun;
    } else if (shown) {
      page->file = options->files.front();
      *exit_code = RunPlayback(*page);
    } else if (port->count() > 0 || !page->scenario.empty() || !page->html_file.empty()) {
      std::fprintf(
          stderr,
          "--port, --scenario and --html are for a single MCAP file, which is shown on a page\n");
      *exit_code = kCouldNotRun;
    } else {
      *exit_code = RunReplay(*options);
    }
  });
}

}  // namespace giveway::fleetctl
