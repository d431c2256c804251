#include "services/node/qos_at_start.h"

#include "services/link/fastdds/link_options.h"
#include "services/link/fastdds/profile_file.h"
#include "services/qos/profile_check.h"

namespace giveway {

// How many processes share this host is not known here: where ports run out, the library says so.
qos::Deployment ServiceDeployment(const Scenario& scenario) {
  return {.vehicles = static_cast<std::int64_t>(scenario.vehicles.size() + scenario.spawns.size()),
          .vehicles_a_host = 1,
          .signals = static_cast<std::int64_t>(scenario.signals.size()),
          .tick_ns = scenario.tick_period.count()};
}

QosProfiles ReadSoundQos(const std::string& file, const Scenario& scenario) {
  QosProfiles profiles = link::ReadProfileFile(file);
  const std::string why =
      qos::WhyRefused({profiles.name, profiles.text}, ServiceDeployment(scenario));
  if (!why.empty()) throw link::LinkError(why);
  return profiles;
}

}  // namespace giveway
