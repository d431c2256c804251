#include "services/node/qos_at_start.h"

#include <filesystem>

#include "services/config/text_file.h"
#include "services/link/fastdds/link_options.h"
#include "services/qos/check.h"

namespace giveway {

void RequireSoundQos(const std::string& file, const Scenario& scenario) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return;
  // How many processes share this host is not known here: where ports run out, the library says so.
  const qos::Deployment deployment{
      .vehicles = static_cast<std::int64_t>(scenario.vehicles.size() + scenario.spawns.size()),
      .vehicles_a_host = 1,
      .signals = static_cast<std::int64_t>(scenario.signals.size()),
      .tick_ns = scenario.tick_period.count()};
  const std::string why = qos::WhyRefused({file, ReadBytes(file)}, deployment);
  if (!why.empty()) throw link::LinkError(why);
}

}  // namespace giveway
