#include "services/node/qos_at_start.h"

#include "services/link/fastdds/link_options.h"
#include "services/link/fastdds/profile_file.h"
#include "services/qos/profile_check.h"

namespace giveway {

QosProfiles ReadSoundQos(const std::string& file, const Scenario& scenario) {
  QosProfiles profiles = link::ReadProfileFile(file);
  // How many processes share this host is not known here: where ports run out, the library says so.
  const qos::Deployment deployment{
      .vehicles = static_cast<std::int64_t>(scenario.vehicles.size() + scenario.spawns.size()),
      .vehicles_a_host = 1,
      .signals = static_cast<std::int64_t>(scenario.signals.size()),
      .tick_ns = scenario.tick_period.count()};
  const std::string why = qos::WhyRefused({profiles.name, profiles.text}, deployment);
  if (!why.empty()) throw link::LinkError(why);
  return profiles;
}

}  // namespace giveway
