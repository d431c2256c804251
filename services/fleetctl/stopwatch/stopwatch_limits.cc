#include "services/fleetctl/stopwatch/stopwatch_limits.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "services/fleetctl/process/domain_lock.h"
#include "services/link/fastdds/profile_file.h"
#include "services/link/resolved_qos.h"

namespace giveway::fleetctl {
namespace {

std::int64_t NumberOf(const std::vector<link::ResolvedEntity>& entities, std::string_view profile,
                      std::string_view policy) {
  const auto entity = std::ranges::find(entities, profile, &link::ResolvedEntity::profile);
  if (entity == entities.end()) throw link::LinkError("no profile " + std::string(profile));
  const auto value = std::ranges::find(entity->values, policy, &link::ResolvedValue::policy);
  if (value == entity->values.end()) throw link::LinkError("no value " + std::string(policy));
  return value->number;
}

std::optional<Nanoseconds> FiniteOf(std::int64_t number) {
  if (number == link::kInfiniteDuration) return std::nullopt;
  return Nanoseconds{number};
}

}  // namespace

Limits ReadLimits(const std::string& qos_file, const std::string& interface,
                  std::uint32_t participants, const VehicleOptions& vehicle) {
  link::LinkOptions of_any;
  of_any.domain = kFirstDomain;
  of_any.interface = interface;
  of_any.qos = link::ReadProfileFile(qos_file);
  of_any.fleet_size = participants;
  const auto entities = link::ResolveQos(of_any);
  const auto of_reader = [&](std::string_view policy) {
    return NumberOf(entities, "fleet_beacon_reader", policy);
  };
  Limits limits;
  limits.beacon_period = vehicle.tick_period;
  limits.beacon_age = vehicle.beacon_age_limit;
  limits.deadline = FiniteOf(of_reader("deadline"));
  limits.liveliness = FiniteOf(of_reader("liveliness_lease"));
  limits.asserted = LivelinessKind(NumberOf(entities, "fleet_beacon_writer", "liveliness"));
  limits.tracked = LivelinessKind(of_reader("liveliness"));
  limits.lease = FiniteOf(NumberOf(entities, "giveway_participant", "participant_lease"));
  return limits;
}

}  // namespace giveway::fleetctl
