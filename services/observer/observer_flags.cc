#include "services/observer/observer_flags.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <list>
#include <map>
#include <sstream>
#include <utility>

#include "services/config/config_dir.h"
#include "services/config/flag_values.h"
#include "services/config/problem.h"

namespace giveway {
namespace {

constexpr int kUsageError = 2;

constexpr const char* kFooter =
    "Reads only: nothing in the fleet waits for it. Page: http://ADDRESS:PORT/\n"
    "Every flag has a twin in the environment: --port is also GIVEWAY_PORT. The flag wins; an "
    "empty\n"
    "variable counts as unset.\n\nExample\n  giveway-observer --domain 7 --scenario "
    "intersection_yield\n\n"
    "Exit code 2: a flag, a file, the port or the network was not usable; stderr says which.";

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
    {"--qos", "FILE", "Fast DDS XML profiles, those of the fleet (default: the shipped ones)"},
    {"--scenario", "FILE|NAME", "shows its walls, doors and obstacles; takes its area"},
    {"--area", "NAME", "whose beacons (default: the scenario's, or main)"},
    {"--address", "ADDRESS", "address of the page (default 127.0.0.1)"},
    {"--port", "1..65535", "port of the page (default 8080)"},
    {"--host-name", "NAME,...",
     "names by which a browser may ask for the page, beside localhost and addresses"},
    {"--log-format", "text|json", "of the lines on stderr (default text)"},
    {"--log-level", "LEVEL", "debug, info, warning or error (default info)"},
};

std::vector<std::string> Split(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream stream(list);
  for (std::string part; std::getline(stream, part, ',');) {
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

void ReadServers(FlagValues* values, ObserverFlags* flags) {
  const auto text = values->Text("--discovery-server");
  if (!text) return;
  ParsedDiscoveryServers parsed = ParseDiscoveryServers(*text);
  flags->discovery_servers = std::move(parsed.servers);
  if (parsed.fault.empty()) return;
  values->Complain("--discovery-server", parsed.fault,
                   "write HOST or HOST:PORT, several with commas between them");
}

std::string DefaultQos(FlagValues* values) {
  try {
    return ConfigDir() + "/qos/default.xml";
  } catch (const InputError& error) {
    values->Add(error.Problems());
    return "";
  }
}

std::uint32_t ReadDomain(FlagValues* values, const std::set<std::uint32_t>& running) {
  if (values->Text("--domain")) return values->Whole("--domain", {1, 99}).value_or(0);
  if (running.size() == 1) return *running.begin();
  std::string found = running.empty() ? "no fleet was found on this machine" : "fleets run in";
  for (const std::uint32_t domain : running) found += " " + std::to_string(domain);
  values->Complain("--domain", "is missing, and " + found, "write --domain with a number 1..99");
  return 0;
}

ObserverFlags Read(FlagValues* values, const std::set<std::uint32_t>& running) {
  ObserverFlags flags;
  flags.address = values->TextOr(flags.address, "--address");
  flags.port = values->Whole("--port", {1, 65535}).value_or(flags.port);
  if (const auto what = values->Text("--health")) {
    flags.ask_health =
        what->empty() ? "ready" : values->OneOf("--health", {"live", "ready"}).value_or("ready");
    return flags;  // what a service needs, a question does not
  }
  flags.domain = ReadDomain(values, running);
  flags.interface = values->TextOr(flags.interface, "--interface");
  ReadServers(values, &flags);
  flags.qos = values->Text("--qos") ? values->TextOr("", "--qos") : DefaultQos(values);
  flags.scenario = values->Text("--scenario").value_or("");
  flags.area = values->Text("--area").value_or("");
  flags.host_names = Split(values->Text("--host-name").value_or(""));
  flags.log_format = values->OneOf("--log-format", {"text", "json"}).value_or(flags.log_format);
  flags.log_level =
      values->OneOf("--log-level", {"debug", "info", "warning", "error"}).value_or(flags.log_level);
  return flags;
}

}  // namespace

std::variant<ObserverFlags, int> ParseObserverFlags(int argc, const char* const* argv,
                                                    std::string_view library,
                                                    const std::set<std::uint32_t>& running) {
  CLI::App app("Shows a fleet live: a page, metrics, JSON.", "giveway-observer");
  app.set_version_flag("--version",
                       "giveway-observer " GIVEWAY_VERSION ", " + std::string(library));
  app.footer(kFooter);
  std::list<std::pair<CLI::Option*, std::string>> options;  // a list: CLI11 keeps references
  for (const FlagHelp& flag : kFlags) {
    auto& [option, value] = options.emplace_back();
    option = app.add_option(flag.name, value, flag.help)->type_name(flag.value);
  }
  auto& [health, what] = options.emplace_back();
  health =
      app.add_option("--health", what,
                     "asks the observer at --address and --port, prints the answer, and ends:\n"
                     "0 yes, 1 no, 2 no answer");
  health->type_name("live|ready")->expected(0, 1);
  try {
    app.parse(argc, argv);
    std::map<std::string, std::string> given;
    for (const auto& [option, value] : options) {
      if (option->count() > 0) given.emplace(option->get_name(), value);
    }
    FlagValues values(std::move(given));
    ObserverFlags flags = Read(&values, running);
    if (values.Problems().empty()) return flags;
    std::fprintf(stderr, "%s\n", Format(values.Problems()).c_str());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    std::fprintf(stderr, "command line: %s; see giveway-observer --help\n", error.what());
  }
  return kUsageError;
}

}  // namespace giveway
