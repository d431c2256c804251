#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "services/config/scenario_file.h"
#include "services/fleetctl/args/flag_checks.h"
#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/output/finding_text.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/output/terminal_text.h"
#include "services/fleetctl/plan/plan.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/link/fastdds/library_release.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kPlanFooter = R"(
Estimates before anything is started, from what fleets of 2 to 32 vehicles were measured to cost here
(tests/bench/fleet_costs.sh measures them on another machine), and holds the QoS set against so many
vehicles. Nothing is started, no network is touched. Cores and memory of a host are this machine's,
unless they are given.

Examples
  fleetctl plan 20
  fleetctl plan 200 --hosts 8 --cores 16 --memory-gib 32
  fleetctl plan 120 --containers --qos wan_discovery_server    # every vehicle has ports of its own
  fleetctl plan 64 --json | jq '.vehicles_that_fit'

Exit code: 0 it fits, 1 it does not, 2 could not run.
)";

struct PlanOptions {
  PlanRequest request;
  std::string scenario;
  std::string qos;
  double memory_gib = 0;
  bool json = false;
};

double HostMemoryMib() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
         static_cast<double>(sysconf(_SC_PAGE_SIZE)) / (1 << 20);
}

int RunPlan(PlanOptions options) {
  PlanRequest& request = options.request;
  if (!options.scenario.empty()) {
    request.tick_ns = LoadScenario(options.scenario, {}).tick_period.count();
  }
  if (request.cores == 0) request.cores = std::thread::hardware_concurrency();
  request.memory_mib = options.memory_gib > 0 ? options.memory_gib * 1024 : HostMemoryMib();
  auto read = ReadQosFile(ResolveQosFile(options.qos));
  if (const auto* why = std::get_if<qos::Finding>(&read)) {
    std::fputs(ToText(*why).c_str(), stderr);
    return kCouldNotRun;
  }
  request.set = std::move(std::get<qos::ProfileFile>(read));
  request.library_major = link::LibraryMajor();
  const PlanReport report = Plan(request);
  std::fputs(
      (options.json ? ToJson(request, report) : ForTerminal(ToText(request, report))).c_str(),
      stdout);
  if (std::fflush(stdout) != 0) throw OutputError("stdout took no report");
  return report.Fits() ? 0 : 1;
}

}  // namespace

void AddPlanVerb(CLI::App* fleetctl, int* exit_code) {
  const auto options = std::make_shared<PlanOptions>();
  PlanRequest& request = options->request;
  CLI::App* verb = fleetctl->add_subcommand("plan", "Will so many vehicles fit on so many hosts?");
  verb->footer(kPlanFooter);
  verb->add_option("N,--vehicles", request.vehicles, "How many vehicles")
      ->required()
      ->check(CLI::Range(1, 4096));
  verb->add_option("--hosts", request.hosts, "Hosts, all alike; one also runs the world")
      ->capture_default_str()
      ->check(CLI::Range(1, 4096));
  verb->add_option("--cores", request.cores, "Of a host")
      ->default_str("this machine's")
      ->check(Between(0.1, 1024));
  verb->add_option("--memory-gib", options->memory_gib, "Memory of a host, GiB")
      ->default_str("this machine's")
      ->check(Between(0.1, 65536));
  verb->add_option("--link-mbit", request.link_mbit_s, "Between two hosts, Mbit/s")
      ->capture_default_str()
      ->check(Between(0.01, 1e6));
  verb->add_flag("--containers", request.containers,
                 "Every process has a network, and so ports, of its own");
  verb->add_option("--scenario", options->scenario, "The tick rate is this scenario's, not 20 Hz");
  verb->add_option("--qos", options->qos, "A file or a shipped set; without it the default");
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else");
  verb->callback([options, exit_code] {
    if (options->request.hosts > options->request.vehicles) {
      throw CLI::ValidationError("--hosts", "more hosts than vehicles");
    }
    *exit_code = RunPlan(*options);
  });
}

}  // namespace giveway::fleetctl
