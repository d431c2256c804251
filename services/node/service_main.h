// What giveway-vehicle and giveway-world share: flags in, an exit code out, and one place where a
// start-up error becomes a log line and exit code 2.
#pragma once

#include <cstdint>
#include <exception>
#include <string>
#include <utility>
#include <variant>

#include "services/config/flags.h"
#include "services/health/health_server.h"
#include "services/link/fastdds/library_log.h"
#include "services/link/fastdds/link_options.h"
#include "services/node/environment_check.h"
#include "services/runtime/process.h"
#include "services/types/scenario.h"

namespace giveway {

// A service knows its fleet, unlike a tool that starts next to one: so many tools and foreign
// participants may be there when it starts. Each that does not answer costs it time: ask_pace.h.
inline constexpr std::uint32_t kStrangers = 64;

inline link::LinkOptions LinkOptionsOf(const ServiceFlags& flags, const Scenario& scenario,
                                       QosProfiles qos) {
  return {
      .domain = flags.domain,
      .interface = flags.interface,
      .qos = std::move(qos),
      .area = scenario.area,
      .fleet_size = static_cast<std::uint32_t>(scenario.vehicles.size() + scenario.spawns.size()),
      .strangers = kStrangers,
      .partition_free = flags.partition_free,
      .impairment = {},
      .discovery_servers = flags.discovery_servers,
      .leaves_out_shared_memory = flags.leaves_out_shared_memory};
}

// Only reception of vehicles is impaired: to the world it would be the wires to the wheels.
inline Impairment ImpairmentOf(const ServiceFlags& flags, const Scenario& scenario) {
  Impairment impairment = flags.impair.value_or(scenario.impairment);
  if (!impairment.seed) impairment.seed = scenario.seed;
  return impairment;
}

// A reader of the log that has stopped delays the end by no more.
inline constexpr Nanoseconds kFlushLog = std::chrono::milliseconds(200);

// Runs the service unless the flags asked for help or were wrong.
inline int ServiceMain(const std::variant<ServiceFlags, int>& parsed,
                       int (*run)(const ServiceFlags&, const StopSignal&)) {
  if (const int* exit_code = std::get_if<int>(&parsed)) {
    if (*exit_code != 0) WarnOfEnvironment();  // a flag that is missing may be a misspelt twin
    return *exit_code;
  }
  const auto& flags = std::get<ServiceFlags>(parsed);
  if (!flags.ask_health.empty()) {
    return AskHealth(flags.health_address, static_cast<std::uint16_t>(flags.health_port),
                     flags.ask_health);
  }
  // Never destroyed: the limit on the time to leave holds until the process is gone.
  static const StopSignal& stop = *new StopSignal;
  // The library's own thread says what it has to say: a log that is not read must not hold it up.
  link::SetLibraryLog([](const std::string& line) { LogWarning(line); });
  int exit_code = 2;
  try {
    exit_code = run(flags, stop);
  } catch (const std::exception& error) {
    LogError(error.what());
  }
  FlushLog(kFlushLog);
  return exit_code;
}

}  // namespace giveway
