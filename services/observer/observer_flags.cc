#include "services/observer/observer_flags.h"

#include <cstdio>
#include <sstream>

#include "services/config/flag_values.h"
#include "services/config/help/command_line.h"
#include "services/config/problem.h"

namespace giveway {
namespace {

constexpr int kUsageError = 2;

constexpr const char* kFooter = R"(
Of the fleet it reads only: nothing in the fleet waits for it. The page is http://ADDRESS:PORT/. Every flag has a twin
in the environment: --port is also GIVEWAY_PORT. The flag wins; an empty variable counts as unset.

Examples
  giveway-observer                                # of the only fleet here
  giveway-observer --domain 7 --scenario patrol   # with its walls
  giveway-observer --address 0.0.0.0 --host-name fleet.example
  giveway-observer --ros2 --ros2-domain 42        # for ROS_DOMAIN_ID=42
  giveway-observer --foxglove-port 8765           # Foxglove: open ws://localhost:8765

Exit code: 0 it was stopped by SIGTERM or SIGINT; 1 the network interface was replaced by another; 2 a
flag, a file, the port or the network was not usable: stderr says which; 70 the loop hung, and the
watchdog ended it; 130 or 143 it had not left a second after SIGINT or SIGTERM, or a second signal came.
)";

struct FlagHelp {
  const char* name;
  const char* value;
  const char* help;
};

constexpr FlagHelp kFlags[] = {
    {"--domain", "1..99",
     "DDS domain of the fleet (default: that of the only fleet of this machine)"},
    {"--interface", "NAME|ADDRESS|any", "network interface of DDS (default 127.0.0.1)"},
    {"--discovery-server", "HOST[:PORT],...", "find the fleet through these servers"},
    {"--qos", "SET|FILE",
     "Fast DDS XML profiles, a file or a shipped set: those the fleet runs with (default: "
     "default)"},
    {"--scenario", "FILE|NAME", "shows its walls, doors and obstacles; takes its area"},
    {"--area", "NAME", "whose beacons (default: the scenario's, or main)"},
    {"--address", "ADDRESS", "address of the page (default 127.0.0.1)"},
    {"--port", "1..65535", "port of the page (default 8080)"},
    {"--foxglove-port", "1..65535", "port of the Foxglove WebSocket, at --address (default: none)"},
    {"--host-name", "NAME,...",
     "names by which a browser may ask for the page, besides localhost and addresses"},
    {"--ros2-rate", "0.1..100", "messages a second of each ROS 2 topic (default 10)"},
    {"--ros2-domain", "1..99", "domain of the ROS 2 topics (default: that of the fleet)"},
    {"--log-format", "text|json", "format of the log lines on stderr (default text)"},
    {"--log-level", "LEVEL", "debug, info, warning or error (default info)"},
};

void ReadRos2(FlagValues* values, ObserverFlags* flags) {
  flags->ros2 = values->Switch("--ros2");
  flags->ros2_rate_hz = values->Number("--ros2-rate", {0.1, 100}).value_or(flags->ros2_rate_hz);
  flags->ros2_domain = values->Uint("--ros2-domain", {1, 99}).value_or(0);
}

std::vector<std::string> Split(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream stream(list);
  for (std::string part; std::getline(stream, part, ',');) {
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

void ReadFleet(FlagValues* values, const FindOnlyFleet& find, ObserverFlags* flags) {
  const auto interface = values->Text("--interface");
  if (interface) flags->interface = values->TextOr(flags->interface, "--interface");
  if (values->Text("--domain")) {
    flags->domain = values->Uint("--domain", {1, 99}).value_or(0);
    return;
  }
  const OnlyFleet fleet = find();
  if (fleet.domain == 0) {
    values->AddError("--domain", "is missing, and " + fleet.why, "fleetctl ls lists the fleets");
    return;
  }
  flags->domain = fleet.domain;
  if (!interface) flags->interface = fleet.interface;
}

ObserverFlags Read(FlagValues* values, const FindOnlyFleet& find) {
  ObserverFlags flags;
  flags.address = values->TextOr(flags.address, "--address");
  flags.port = values->Uint("--port", {1, 65535}).value_or(flags.port);
  if (const auto what = values->Text("--health")) {
    flags.ask_health =
        what->empty() ? "ready" : values->OneOf("--health", {"live", "ready"}).value_or("ready");
    return flags;  // what a service needs, a question does not
  }
  ReadFleet(values, find, &flags);
  flags.discovery_servers = ReadDiscoveryServers(values);
  flags.qos = ReadQosFlag(values);
  flags.scenario = values->Text("--scenario").value_or("");
  flags.area = values->Text("--area").value_or("");
  flags.foxglove_port = values->Uint("--foxglove-port", {1, 65535}).value_or(flags.foxglove_port);
  if (flags.foxglove_port == flags.port) {
    values->AddError("--foxglove-port", "is the port of the page", "choose another, such as 8765");
  }
  flags.host_names = Split(values->Text("--host-name").value_or(""));
  ReadRos2(values, &flags);
  flags.hang_on_signal = values->Switch("--hang-on-signal");
  flags.log_format = values->OneOf("--log-format", {"text", "json"}).value_or(flags.log_format);
  flags.log_level =
      values->OneOf("--log-level", {"debug", "info", "warning", "error"}).value_or(flags.log_level);
  return flags;
}

}  // namespace

std::variant<ObserverFlags, int> ParseObserverFlags(int argc, const char* const* argv,
                                                    std::string_view library,
                                                    const FindOnlyFleet& find) {
  CommandLine line("giveway-observer", "Shows a fleet live: a page, metrics, JSON.",
                   "giveway-observer " GIVEWAY_VERSION ", " + std::string(library), kFooter);
  for (const FlagHelp& flag : kFlags) line.Add(flag.name, flag.value, flag.help);
  line.AddSwitch("--ros2",
                 "publishes odometry, ranges, transforms, markers and motor commands as "
                 "ROS 2 topics: rt/giveway/v1/odom");
  line.AddSwitch("--hang-on-signal",
                 "a drill: SIGUSR1 makes the loop hang, SIGUSR2 makes it resume");
  line.AddOptional("--health", "live|ready",
                   "asks the observer at --address and --port, prints the answer, and exits: "
                   "0 yes, 1 no, 2 no answer (ready if no value follows)");
  try {
    FlagValues values(line.Parse(argc, argv));
    ObserverFlags flags = Read(&values, find);
    if (values.Problems().empty()) return flags;
    std::fprintf(stderr, "%s\n", Format(values.Problems()).c_str());
    return kUsageError;
  } catch (const CLI::ParseError& error) {
    return line.Exit(error);
  }
}

}  // namespace giveway
