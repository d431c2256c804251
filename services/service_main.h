// What giveway-vehicle and giveway-world share: flags in, an exit code out, and one place where a
// start-up error becomes a log line and exit code 2.
#pragma once

#include <cstdint>
#include <exception>
#include <variant>

#include "services/app/flags.h"
#include "services/app/health_server.h"
#include "services/app/process.h"
#include "services/link/link_options.h"
#include "services/types/scenario.h"

namespace giveway {

inline link::LinkOptions LinkOptionsOf(const app::ServiceFlags& flags, const Scenario& scenario) {
  return {
      .domain = flags.domain,
      .interface = flags.interface,
      .qos_file = flags.qos,
      .area = scenario.area,
      .fleet_size = static_cast<std::uint32_t>(scenario.vehicles.size() + scenario.spawns.size()),
      .partition_free = flags.partition_free,
      .impairment = {},
      .discovery_servers = flags.discovery_servers};
}

// Runs the service unless the flags asked for help or were wrong.
inline int ServiceMain(const std::variant<app::ServiceFlags, int>& parsed,
                       int (*run)(const app::ServiceFlags&, const app::StopSignal&)) {
  if (const int* exit_code = std::get_if<int>(&parsed)) return *exit_code;
  const auto& flags = std::get<app::ServiceFlags>(parsed);
  if (!flags.ask_health.empty()) {
    return app::AskHealth(flags.health_address, static_cast<std::uint16_t>(flags.health_port),
                          flags.ask_health);
  }
  // Never destroyed: a second SIGTERM may come while the process is already leaving, and must not
  // end it by the default handler then.
  static const app::StopSignal& stop = *new app::StopSignal;
  try {
    return run(flags, stop);
  } catch (const std::exception& error) {
    app::LogError(error.what());
    return 2;
  }
}

}  // namespace giveway
