#include <memory>
#include <set>

#include "services/fleetctl/args/flag_checks.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/record/export.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kExportFooter = R"(
Fields have the names of fleet.idl, as those of fleetctl listen --json; in CSV those within others are
joined by dots.

Examples
  fleetctl export run.mcap --topic fleet/beacon --csv > beacons.csv
  fleetctl export run.mcap --topic world/event --json | jq 'select(.kind == "contact")'

Exit code: 0 exported; 1 nothing of the topic, or the file is damaged; 2 could not run.
)";

const std::set<std::string> kTopics{"fleet/beacon", "fleet/motor_command", "fleet/status",
                                    "world/event",  "world/figures",       "world/ranges",
                                    "world/roster", "world/signal",        "world/truth"};

std::string ExportedNames() {
  std::string names;
  for (const std::string& topic : kTopics) names += (names.empty() ? "" : ", ") + topic;
  return names;
}

std::string CheckExported(const std::string& topic) {
  if (kTopics.contains(topic)) return {};
  return "there is no topic \"" + topic + "\" to export; there are " + ExportedNames();
}

}  // namespace

void AddExportVerb(CLI::App* fleetctl, int* exit_code) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* verb =
      fleetctl->add_subcommand("export", "One topic of an MCAP recording as JSON or CSV");
  verb->footer(kExportFooter);
  verb->add_option("FILE", options->file, "The recording")->required()->check(CheckNotEmpty);
  verb->add_option("--topic", options->topic, "One of " + ExportedNames())
      ->type_name("TOPIC")
      ->required()
      ->check(CheckExported);
  CLI::Option* csv = verb->add_flag("--csv", options->csv, "Lines of CSV under a head");
  verb->add_flag("--json", options->json, "Lines of JSON; the default")->excludes(csv);
  verb->callback([options, exit_code] { *exit_code = RunExport(*options); });
}

}  // namespace giveway::fleetctl
