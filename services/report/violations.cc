#include "services/report/violations.h"

#include "report.pb.h"
#include "services/types/check.h"

namespace giveway {

void SetViolations(const std::vector<BrokenInvariant>& violations, schema::Violations* message) {
  const auto* descriptor = schema::Violations::descriptor();
  for (const BrokenInvariant& broken : violations) {
    const auto* field = descriptor->FindFieldByName(broken.name);
    GIVEWAY_CHECK(field != nullptr, broken.name);
    message->GetReflection()->SetUInt32(message, field, broken.count);
  }
}

void SetTrust(const TrustCounters& counters, schema::Trust* message) {
  message->set_beacon_without_echo(counters.beacon_without_echo);
  message->set_echo_without_beacon(counters.echo_without_beacon);
  message->set_halted_but_closing(counters.halted_but_closing);
  message->set_jumps(counters.jumps);
  message->set_impossible_speeds(counters.impossible_speeds);
}

}  // namespace giveway
