#include "services/fleetctl/observer_flags.h"

#include "services/fleetctl/domain_lock.h"

namespace giveway::fleetctl {
namespace {

constexpr double kMostSeconds = 1e6;  // eleven days; beyond 2^33 the clock's arithmetic ends

std::string CheckNotEmpty(const std::string& text) {
  return text.empty() ? "must not be empty" : "";
}

}  // namespace

void AddObserverFlags(CLI::App* verb, ObserverOptions* options) {
  verb->add_option("--domain", options->domain, "DDS domain of the fleet")
      ->required()
      ->check(CLI::Range(kFirstDomain, kLastDomain))
      ->envname("GIVEWAY_DOMAIN");
  verb->add_option("--interface", options->interface,
                   "Address or name of a network interface, or 'any'")
      ->check(CheckNotEmpty)
      ->capture_default_str()
      ->envname("GIVEWAY_INTERFACE");
  verb->add_option("--area", options->area, "Whose beacons; the scenario names it")
      ->check(CheckNotEmpty)
      ->capture_default_str();
  verb->add_option("--qos", options->qos_file,
                   "Fast DDS XML profiles: a file, or a shipped set; those of the fleet")
      ->check(CheckNotEmpty)
      ->envname("GIVEWAY_QOS");
}

std::string CheckSeconds(const std::string& text) {
  try {
    std::size_t end = 0;
    const double value = std::stod(text, &end);
    if (end == text.size() && value > 0 && value <= kMostSeconds) return {};
  } catch (const std::exception&) {
  }
  return "must be a number of seconds above 0 and up to 1000000, not '" + text + "'";
}

}  // namespace giveway::fleetctl
