// fleetctl: the operator's command line. Only parses; each verb is a file of its own.
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <string>

#include "services/config/help/help_format.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/help/help_verbs.h"
#include "services/fleetctl/help/usage_error.h"
#include "services/fleetctl/output/library_lines.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/link/fastdds/library_release.h"

namespace {

// Shows what no table has shown.
struct LibraryLinesAtEnd {
  LibraryLinesAtEnd() = default;
  ~LibraryLinesAtEnd() {
    for (const std::string& line : giveway::fleetctl::TakeLibraryLines()) {
      std::fprintf(stderr, "%s\n", line.c_str());
    }
  }
  LibraryLinesAtEnd(const LibraryLinesAtEnd&) = delete;
  LibraryLinesAtEnd& operator=(const LibraryLinesAtEnd&) = delete;
};

constexpr const char* kFleetctlFooter = R"(
Examples
  fleetctl run intersection_yield          # two vehicles, one verdict
  fleetctl virtual crossing --seeds 1..20  # the same brains in virtual time
  fleetctl ls                              # the fleets on this machine
  fleetctl help run                        # a verb explained, examples first

Exit code: 0 passed or shown, 1 failed or interrupted, 2 could not run; of doctor, qos, shrink and
campaign see their --help.
)";

}  // namespace

int main(int argc, char** argv) {
  // Reaching the file size limit is an error of that write, not the end of the program.
  std::signal(SIGXFSZ, SIG_IGN);
  // So is a reader that ends before it has read all.
  std::signal(SIGPIPE, SIG_IGN);
  // A parent may have ignored it, which survives exec: then no child could be waited for.
  std::signal(SIGCHLD, SIG_DFL);
  CLI::App fleetctl("Runs and judges fleets of vehicles that talk over DDS.", "fleetctl");
  fleetctl.require_subcommand(1);
  fleetctl.formatter(std::make_shared<giveway::HelpFormat>());  // of every verb, too
  const std::string version =
      "fleetctl " GIVEWAY_VERSION ", " + std::string(giveway::link::LibraryName());
  fleetctl.set_version_flag("--version", version);
  fleetctl.footer(kFleetctlFooter);
  int exit_code = giveway::fleetctl::kCouldNotRun;
  giveway::fleetctl::AddCampaignVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddDoctorVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddExportVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddFaultsVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddListenVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddLsVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddPlanVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddQosVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddRecordVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddReplayVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddReportVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddRunVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddShrinkVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddSoakVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddStopwatchVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddTopVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddVirtualVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddWhyVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddHelpVerbs(&fleetctl, version, &exit_code);
  giveway::fleetctl::KeepLibraryLines();
  const LibraryLinesAtEnd rest_at_end;
  try {
    fleetctl.parse(argc, argv);
  } catch (const CLI::Success& help) {
    const int code = fleetctl.exit(help);
    return std::cout.flush() ? code : giveway::fleetctl::kCouldNotRun;
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "fleetctl: %s\nTry: %s --help\n",
                 giveway::fleetctl::ExplainUsageError(fleetctl, error).c_str(),
                 giveway::fleetctl::NamedVerb(fleetctl).c_str());
    return giveway::fleetctl::kCouldNotRun;
  } catch (const std::exception& error) {  // a verb's LinkError, InputError, OutputError ...
    std::fprintf(stderr, "%s\n", error.what());
    return giveway::fleetctl::kCouldNotRun;
  }
  return exit_code;
}
