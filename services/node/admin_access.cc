#include "services/node/admin_access.h"

#include <chrono>

#include "services/auth/admin_key.h"

namespace giveway {

auth::AdminGate AdminGateOf(const ServiceFlags& flags) {
  if (flags.admin_key.empty()) return auth::AdminGate(flags.admin);
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto now_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
  return {auth::ReadAdminKey(flags.admin_key), static_cast<std::uint64_t>(now_ns)};
}

link::ServiceOptions ServiceOptionsOf(const auth::AdminGate& gate, const Scenario& scenario) {
  return {.takes_orders = !gate.IsShut(), .tick_period = scenario.tick_period};
}

}  // namespace giveway
