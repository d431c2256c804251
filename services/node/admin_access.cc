#include "services/node/admin_access.h"

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "services/auth/admin_key.h"

namespace giveway {

namespace {

// What was given to the processes before this one has numbers up to their end, by this machine's
// clock; the order for which this one came back has its own, by an operator's clock, that may be
// ahead.
std::uint64_t OrdersBefore(const ServiceFlags& flags) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto now_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
  const std::uint64_t resumed = flags.resume ? flags.resume->order : 0;
  return std::max(static_cast<std::uint64_t>(now_ns), resumed);
}

}  // namespace

auth::AdminGate AdminGateOf(const ServiceFlags& flags) {
  if (flags.admin_key.empty()) return auth::AdminGate(flags.admin);
  return {auth::ReadAdminKey(flags.admin_key), OrdersBefore(flags)};
}

link::ServiceOptions ServiceOptionsOf(const auth::AdminGate& gate, const Scenario& scenario) {
  return {.takes_orders = !gate.IsShut(), .tick_period = scenario.tick_period};
}

}  // namespace giveway
