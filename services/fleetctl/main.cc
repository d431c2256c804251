// fleetctl: the operator's command line. Only parses; each verb is a file of its own.
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>

#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/output/library_lines.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/link/fastdds/library_release.h"

namespace {

// The verb that was named, as far as it was: "fleetctl qos check".
std::string VerbOf(const CLI::App& app) {
  const auto named = app.get_subcommands();
  return app.get_name() + (named.empty() ? "" : " " + VerbOf(*named.front()));
}

// What was wrong, in words: the parser does not name a verb it does not know.
std::string Explain(const CLI::App& fleetctl, int argc, char** argv, const std::string& error) {
  if (argc < 2 || argv[1][0] == '-' || !fleetctl.get_subcommands().empty()) {
    return error;
  }
  std::string verbs;
  for (const CLI::App* verb : fleetctl.get_subcommands({})) {
    verbs += (verbs.empty() ? "" : ", ") + verb->get_name();
  }
  return "there is no verb '" + std::string(argv[1]) + "'; verbs: " + verbs;
}

// Whatever no table has shown.
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

}  // namespace

int main(int argc, char** argv) {
  // A file that may not grow is an error of the write that met it, not the end of the program.
  std::signal(SIGXFSZ, SIG_IGN);
  CLI::App fleetctl("Runs and judges fleets of vehicles that talk over DDS.", "fleetctl");
  fleetctl.require_subcommand(1);
  fleetctl.set_version_flag(
      "--version", "fleetctl " GIVEWAY_VERSION ", " + std::string(giveway::link::LibraryName()));
  fleetctl.footer("\nExample\n  fleetctl run intersection_yield\n\nMore: fleetctl run --help\n");
  int exit_code = giveway::fleetctl::kCouldNotRun;
  giveway::fleetctl::AddCampaignVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddDoctorVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddExportVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddFaultsVerb(&fleetctl, &exit_code);
  giveway::fleetctl::AddListenVerb(&fleetctl, &exit_code);
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
  giveway::fleetctl::KeepLibraryLines();
  const LibraryLinesAtEnd told_at_end;
  try {
    fleetctl.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return fleetctl.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "fleetctl: %s\nTry: %s --help\n",
                 Explain(fleetctl, argc, argv, error.what()).c_str(), VerbOf(fleetctl).c_str());
    return giveway::fleetctl::kCouldNotRun;
  } catch (const std::exception& error) {  // a verb's LinkError, InputError, OutputError ...
    std::fprintf(stderr, "%s\n", error.what());
    return giveway::fleetctl::kCouldNotRun;
  }
  return exit_code;
}
