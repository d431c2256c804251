#include "services/fleetctl/qos/qos_foreign.h"

#include <algorithm>
#include <chrono>

#include "services/link/discovery_probe.h"
#include "services/qos/deployment.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

constexpr Nanoseconds kDiscoveryPatience = std::chrono::seconds(3);
constexpr Nanoseconds kSettles =
    std::chrono::milliseconds(500);  // its endpoints are discovered one by one
constexpr Nanoseconds kProbeTurn = std::chrono::milliseconds(20);

}  // namespace

std::vector<EffectiveEndpoint> EffectiveForeign(const std::vector<link::FoundEndpoint>& endpoints) {
  std::vector<link::ResolvedEntity> entities;
  std::vector<std::string> partitions;
  for (const link::FoundEndpoint& found : endpoints) {
    const auto topics = qos::FleetTopics();
    const auto topic = std::ranges::find(topics, found.topic, &qos::Topic::name);
    if (topic == topics.end()) continue;
    entities.push_back({std::string(topic->stem) + (found.writes ? "_writer" : "_reader"),
                        found.topic,
                        {{"reliability", found.reliable ? 1 : 0},
                         {"durability", found.durability},
                         {"deadline", found.deadline_ns},
                         {"liveliness", found.liveliness},
                         {"liveliness_lease", found.lease_ns}}});
    partitions.push_back(link::PartitionText(found));
  }
  std::vector<EffectiveEndpoint> effective = EffectiveQos(entities, qos::ProfileSet{});
  for (std::size_t i = 0; i < effective.size(); ++i) {
    for (QosRow& row : effective[i].rows) {
      row.origin = QosOrigin::kDiscovered;
      if (row.policy == "partition") row.value = partitions[i];
    }
  }
  return effective;
}

std::optional<ForeignVehicle> SeekForeign(const link::LinkOptions& options, VehicleId vehicle) {
  link::DiscoveryProbe probe(options, {}, kNoVehicle);
  SteadyTime end = SteadyNow() + kDiscoveryPatience;
  std::optional<link::ProbedProcess> found;
  while (SteadyNow() < end) {
    SleepUntil(SteadyNow() + kProbeTurn);
    for (link::ProbedProcess& process : probe.Poll()) {
      if (process.vehicle != vehicle || link::IsOurVendor(process.guid)) continue;
      if (!found) end = SteadyNow() + kSettles;
      found = std::move(process);
    }
  }
  if (!found) return std::nullopt;
  return ForeignVehicle{link::VendorOf(found->guid), EffectiveForeign(found->endpoints)};
}

}  // namespace giveway::fleetctl
