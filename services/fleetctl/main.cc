// fleetctl: the operator's command line. Only parses; each verb is a file of its own.
#include <cstdio>

#include "services/fleetctl/verbs.h"

namespace {

constexpr int kWrongArguments = 2;

}  // namespace

int main(int argc, char** argv) {
  CLI::App fleetctl("Runs and judges fleets of vehicles that talk over DDS.", "fleetctl");
  fleetctl.require_subcommand(1);
  fleetctl.set_version_flag("--version", "fleetctl " GIVEWAY_VERSION);
  fleetctl.footer("\nExample\n  fleetctl run intersection_yield\n\nMore: fleetctl run --help\n");
  int exit_code = kWrongArguments;
  giveway::fleetctl::AddRunVerb(&fleetctl, &exit_code);
  try {
    fleetctl.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return fleetctl.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "fleetctl: %s\nTry: fleetctl run --help\n", error.what());
    return kWrongArguments;
  }
  return exit_code;
}
