#include <limits>
#include <memory>

#include "services/fleetctl/args/flag_checks.h"
#include "services/fleetctl/args/observer_flags.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/qos/qos_check.h"
#include "services/fleetctl/qos/qos_live.h"
#include "services/fleetctl/qos/qos_show.h"
#include "services/fleetctl/survey/local_fleets.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kCheckFooter = R"(
A FILE is a path, or the name of a shipped set: default, lossy_radio, same_host,
wan_discovery_server. Of several files each is the set of some processes: the writers of one are
held against the readers of all.
Each finding says where, which values, what comes of it and what to do. Nothing is started and no
network is touched. Of a compose file's services those count that name giveway; their fleet is as large
as the containers of the services that are called vehicle, or have it in image or command. Findings on the environment and the working folder are about this shell.

Examples
  fleetctl qos check                                   # the shipped default
  fleetctl qos check mine.xml --scenario four_way
  fleetctl qos check lossy_radio same_host             # would vehicles of both hear each other?
  fleetctl qos check --compose compose.yaml            # what every container is given
  fleetctl qos check mine.xml --vehicles 64 --json | jq -r '.findings[].rule'

Exit code: 0 nothing found, 1 warnings, 2 errors, or it could not run.
)";

constexpr const char* kShowFooter = R"(
The library itself resolves the profiles, as it would for a service; no socket is opened. Each value
comes with its origin: FILE:LINE, library default, code (follows from fleet size, area or id),
environment or flag. --live asks a running vehicle what its endpoints have now, with the origins in
the file that it was started with or given since, and says where that differs from --qos.

Examples
  fleetctl qos show fleet/beacon
  fleetctl qos show --qos lossy_radio --vehicles 64 giveway_participant
  fleetctl qos show --diff default lossy_radio
  fleetctl qos show --live 2 --domain 7                # does vehicle 2 run with the default?
  fleetctl qos show --json | jq '.endpoints[] | select(.topic == "fleet/beacon")'

Exit code: 0 shown, or no difference; 1 the two differ; 2 could not run, or no answer.
)";

constexpr const char* kQosFooter = R"(
Examples
  fleetctl qos check mine.xml
  fleetctl qos show fleet/beacon

More: fleetctl qos check --help
)";

void AddCheck(CLI::App* qos, int* exit_code) {
  const auto options = std::make_shared<QosCheckOptions>();
  CLI::App* verb = qos->add_subcommand("check", "Find what is wrong with profile files, offline");
  verb->footer(kCheckFooter);
  verb->add_option("FILE", options->files, "Profile files; without one the shipped default");
  verb->add_option("--scenario", options->scenario,
                   "Fleet size and tick rate are this scenario's; 2 vehicles at 20 Hz without it");
  verb->add_option("--vehicles", options->vehicles, "Fleet size, instead of the scenario's")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{kMostReckonedWith}));
  verb->add_option(
      "--compose", options->compose,
      "A compose file: the sets its services are given, and how many vehicles they are");
  verb->add_flag("--partial", options->partial, "The files need not be complete sets");
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else");
  verb->callback([options, exit_code] { *exit_code = RunQosCheck(*options); });
}

void AddShow(CLI::App* qos, int* exit_code) {
  const auto options = std::make_shared<QosShowOptions>();
  const auto live = std::make_shared<QosLiveOptions>();
  CLI::App* verb =
      qos->add_subcommand("show", "The QoS every endpoint runs with, and where each value is from");
  verb->footer(kShowFooter);
  verb->add_option("NAME", options->wanted, "Profiles or topics; without one all");
  auto* file = verb->add_option("--qos", options->qos_file,
                                "Profile file, or name of a shipped set; without it the default");
  file->envname("GIVEWAY_QOS");
  verb->add_option("--diff", options->diff, "Two of these: show what differs")
      ->expected(2)
      ->type_name("A B");
  verb->add_option("--interface", options->interface, "Network interface, or 'any'")
      ->capture_default_str()
      ->envname("GIVEWAY_INTERFACE");
  auto* vehicles = verb->add_option("--vehicles", options->vehicles,
                                    "Fleet size: some values follow from it. With --live as the "
                                    "vehicle says it, if not given")
                       ->capture_default_str()
                       ->check(CLI::Range(1U, kMostReckonedWith));
  auto* vehicle = verb->add_option("--live", live->vehicle,
                                   "What this vehicle runs with, held against the file")
                      ->check(CLI::Range(1U, std::numeric_limits<std::uint32_t>::max()));
  AddAdminKeyFlag(verb, &live->admin_key);
  verb->add_option("--domain", live->domain,
                   "DDS domain of the fleet that --live examines, where several run")
      ->check(CLI::Range(1U, 99U))
      ->envname("GIVEWAY_DOMAIN");
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else");
  verb->callback([options, live, vehicle, vehicles, exit_code] {
    if (vehicle->count() == 0) {
      *exit_code = RunQosShow(*options);
      return;
    }
    ObserverOptions where{.domain = live->domain, .interface = options->interface};
    FindFleetIfNotNamed(&where);
    options->interface = where.interface;
    live->domain = where.domain;
    live->set = *options;
    live->of_its_fleet = vehicles->count() == 0;
    *exit_code = RunQosLive(*live);
  });
}

}  // namespace

void AddQosVerb(CLI::App* fleetctl, int* exit_code) {
  CLI::App* qos = fleetctl->add_subcommand("qos", "Explain, check, change and tune QoS");
  qos->require_subcommand(1);
  qos->footer(kQosFooter);
  AddCheck(qos, exit_code);
  AddShow(qos, exit_code);
  AddQosApply(qos, exit_code);
  AddQosTune(qos, exit_code);
}

}  // namespace giveway::fleetctl
