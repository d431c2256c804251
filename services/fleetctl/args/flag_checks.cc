#include "services/fleetctl/args/flag_checks.h"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <optional>

#include "services/config/flags.h"
#include "services/config/impair.h"

namespace giveway::fleetctl {

std::optional<double> FiniteNumber(const std::string& text) {
  std::size_t used = 0;
  try {
    const double value = std::stod(text, &used);
    if (used == text.size() && std::isfinite(value)) return value;
  } catch (const std::exception&) {
  }
  return std::nullopt;
}

std::string WhyNotBetween(const std::string& text, double least, double most) {
  const std::optional<double> value = FiniteNumber(text);
  if (value && *value >= least && *value <= most) return {};
  return fmt::format("must be a number from {} to {}, not '{}'", least, most, text);
}

CLI::Validator Between(double least, double most) {
  return {[=](const std::string& text) { return WhyNotBetween(text, least, most); },
          fmt::format("FLOAT in [{} - {}]", least, most)};
}

std::string CheckNotEmpty(const std::string& text) {
  return text.empty() ? "must not be empty" : "";
}

std::string CheckImpairment(const std::string& text) {
  std::string wrong;
  for (const ImpairTextProblem& problem : ParseImpairment(text).problems) {
    wrong += (wrong.empty() ? "" : "\n") + problem.message + "; " + problem.remedy;
  }
  return wrong;
}

std::string CheckRecordingName(const std::string& file) {
  constexpr const char* kEnding = ".mcap";
  if (file.empty()) return CheckNotEmpty(file);
  if (file.ends_with(kEnding)) return {};
  return "'" + file +
         "' does not end in .mcap, by which replay and report know a recording; write " + file +
         kEnding;
}

Behaviour ParseBehaviour(const std::string& name) {
  const std::optional<Behaviour> behaviour = BehaviourNamed(name);
  if (behaviour) return *behaviour;
  throw CLI::ValidationError(
      "--behaviour",
      "must be cooperative, lecture_avoid, stock_avoid, lecture_yield or lecture_printed, not '" +
          name + "'");
}

void AddDiscoveryFlag(CLI::App* verb, std::vector<DiscoveryServer>* servers) {
  const auto take = [servers](const std::string& text) {
    *servers = ParseDiscoveryServers(text).servers;
  };
  verb->add_option_function<std::string>(
          "--discovery-server", take,
          "Discover through the servers at HOST[:PORT],... instead of as --qos says")
      ->check([](const std::string& text) { return ParseDiscoveryServers(text).fault; })
      ->envname("GIVEWAY_DISCOVERY_SERVER");
}

void AddInterfaceFlag(CLI::App* verb, std::string* interface) {
  verb->add_option("--interface", *interface, "Address or name of a network interface, or 'any'")
      ->check(CheckNotEmpty)
      ->capture_default_str()
      ->envname("GIVEWAY_INTERFACE");
}

}  // namespace giveway::fleetctl
