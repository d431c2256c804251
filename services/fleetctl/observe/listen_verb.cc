#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "services/fleetctl/args/duration_flag.h"
#include "services/fleetctl/args/flag_checks.h"
#include "services/fleetctl/args/observer_flags.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/observe/listen.h"
#include "services/fleetctl/survey/local_fleets.h"
#include "services/fleetctl/survey/other_fleets.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kListenFooter = R"(
One line a sample, headed by the seconds since it started to listen and by the vehicle; with --json one
object, with every field. Topics that are kept for latecomers (world/roster, world/event,
world/figures) start with what was. Ends by --count, --duration, Ctrl-C, or when stdout is closed.
Start it after the fleet: fleetctl run takes no domain in which another process listens.

Examples
  fleetctl listen fleet/beacon --domain 7
  fleetctl listen fleet/status --domain 7 --vehicle 2 --json | jq .qos
  fleetctl listen world/event --domain 7 | head -3

Exit code: 0 heard, or ended by Ctrl-C; 1 nothing heard within --duration; 2 could not run.
)";

ListenTopic ParseTopic(const std::string& name) {
  const auto topic = ListenTopicNamed(name);
  if (topic) return *topic;
  throw CLI::ValidationError("TOPIC",
                             "must be one of " + ListenTopicNames() + ", not '" + name + "'");
}

void Listen(ListenOptions options, int* exit_code) {
  const ListenFilter& filter = options.filter;
  if (!filter.vehicles.empty() && !IsAboutVehicles(filter.topic)) {
    throw CLI::ValidationError("--vehicle", "does not go with " + std::string(Name(filter.topic)) +
                                                ", which is not about vehicles");
  }
  FindFleetIfNotNamed(&options.where);
  ReportOtherFleets(options.where.domain, options.where.interface);
  *exit_code = RunListen(options);
}

}  // namespace

void AddListenVerb(CLI::App* fleetctl, int* exit_code) {
  const auto options = std::make_shared<ListenOptions>();
  CLI::App* verb = fleetctl->add_subcommand("listen", "Print the samples of a topic of a fleet");
  verb->footer(kListenFooter);
  verb->add_option_function<std::string>(
          "TOPIC", [options](const std::string& name) { options->filter.topic = ParseTopic(name); },
          ListenTopicNames())
      ->required();
  AddObserverFlags(verb, &options->where);
  verb->add_option_function<std::vector<std::uint32_t>>(
          "--vehicle",
          [options](const std::vector<std::uint32_t>& ids) {
            for (const std::uint32_t id : ids) options->filter.vehicles.insert(VehicleId{id});
          },
          "Only samples about these vehicles")
      ->check(CLI::Range(1U, std::numeric_limits<std::uint32_t>::max()));
  verb->add_flag("--json", options->filter.json, "Print one JSON object a sample");
  verb->add_option("--count", options->count, "End after so many samples")
      ->default_str("without end")
      ->check(CLI::Range(std::uint64_t{1}, std::numeric_limits<std::uint64_t>::max()));
  AddTimeFlag(verb, "--duration", &options->duration_s, "End after this time")
      ->default_str("without end");
  verb->callback([options, exit_code] { Listen(*options, exit_code); });
}

}  // namespace giveway::fleetctl
