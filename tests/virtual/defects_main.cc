// `fleetctl virtual` over vehicles with the defects that GIVEWAY_DEFECT names, separated by commas.
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

#include "services/fleetctl/args/verbs.h"
#include "tests/support/mutant_names.h"

int main(int argc, char** argv) {
  constexpr int kWrongArguments = 2;
  const char* const names = std::getenv("GIVEWAY_DEFECT");
  std::istringstream defects(names == nullptr ? "" : names);
  for (std::string name; std::getline(defects, name, ',');) {
    if (giveway::ActivateNamedMutant(name)) continue;
    std::fprintf(stderr, "fleetctl_with_defects: GIVEWAY_DEFECT: no defect is called '%s'\n",
                 name.c_str());
    return kWrongArguments;
  }
  CLI::App fleetctl("Runs fleets of defective vehicles.", "fleetctl_with_defects");
  fleetctl.require_subcommand(1);
  int exit_code = kWrongArguments;
  giveway::fleetctl::AddVirtualVerb(&fleetctl, &exit_code);
  CLI11_PARSE(fleetctl, argc, argv);
  return exit_code;
}
