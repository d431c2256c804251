#include "services/link/resolved_values.h"

#include <algorithm>
#include <array>

namespace giveway::link {
namespace {

std::int64_t Number(const Duration& duration) { return NanosecondsOf(duration); }

// Where the library's number of a kind is its place in this list.
template <typename Kind, std::size_t count>
std::int64_t Place(Kind kind, const std::array<Kind, count>& kinds) {
  return std::distance(kinds.begin(), std::ranges::find(kinds, kind));
}

std::int64_t Number(dds::DataSharingKind kind) {
  return Place(kind, std::array{dds::AUTO, dds::ON, dds::OFF});
}

std::int64_t Number(Discovery protocol) {
  return Place(protocol, std::array{Discovery::NONE, Discovery::SIMPLE, Discovery::CLIENT,
                                    Discovery::SERVER, Discovery::BACKUP, Discovery::SUPER_CLIENT});
}

// What writers and readers have in common.
template <typename Qos, typename Around>
std::vector<ResolvedValue> EndpointValues(const Qos& qos, const Around& around) {
  const auto& limits = qos.resource_limits();
  return {
      {"reliability", qos.reliability().kind == dds::RELIABLE_RELIABILITY_QOS ? 1 : 0},
      {"max_blocking_time", Number(qos.reliability().max_blocking_time)},
      {"durability", qos.durability().kind},
      {"deadline", Number(qos.deadline().period)},
      {"liveliness", qos.liveliness().kind},
      {"liveliness_lease", Number(qos.liveliness().lease_duration)},
      {"liveliness_announcement", Number(qos.liveliness().announcement_period)},
      {"lifespan", Number(qos.lifespan().duration)},
      {"ownership", qos.ownership().kind},
      {"latency_budget", Number(qos.latency_budget().duration)},
      {"destination_order", qos.destination_order().kind},
      {"presentation", around.presentation().access_scope},
      {"data_sharing", Number(qos.data_sharing().kind())},
      {"history", qos.history().kind},
      {"depth", qos.history().depth},
      {"max_samples", limits.max_samples},
      {"max_instances", limits.max_instances},
      {"max_samples_per_instance", limits.max_samples_per_instance},
      {"memory_policy", qos.endpoint().history_memory_policy},
  };
}

}  // namespace

std::int64_t NanosecondsOf(const Duration& duration) {
  // The library's infinite differs in its nanoseconds from release to release; without any it is a
  // time that a profile says, and less than infinite.
  if (duration.seconds == std::numeric_limits<std::int32_t>::max() && duration.nanosec != 0) {
    return kInfiniteDuration;
  }
  return duration.seconds * std::int64_t{1'000'000'000} + duration.nanosec;
}

Duration ToDuration(std::int64_t nanoseconds) {
  if (nanoseconds == kInfiniteDuration) return dds::DeadlineQosPolicy().period;
  return {static_cast<std::int32_t>(nanoseconds / 1'000'000'000),
          static_cast<std::uint32_t>(nanoseconds % 1'000'000'000)};
}

std::vector<ResolvedValue> ValuesOf(const dds::DataWriterQos& qos,
                                    const dds::PublisherQos& around) {
  std::vector<ResolvedValue> values = EndpointValues(qos, around);
  values.push_back(
      {"disable_positive_acks", qos.reliable_writer_qos().disable_positive_acks.enabled ? 1 : 0});
  values.push_back({"publish_mode", qos.publish_mode().kind});
  values.push_back({"ownership_strength", qos.ownership_strength().value});
  values.push_back({"heartbeat_period", Number(HeartbeatPeriod(qos))});
  return values;
}

std::vector<ResolvedValue> ValuesOf(const dds::DataReaderQos& qos,
                                    const dds::SubscriberQos& around) {
  std::vector<ResolvedValue> values = EndpointValues(qos, around);
  values.push_back({"disable_positive_acks", WithoutPositiveAcks(qos) ? 1 : 0});
  return values;
}

std::vector<ResolvedValue> ValuesOf(const dds::DomainParticipantQos& qos) {
  const auto& wire = qos.wire_protocol();
  const auto& discovery = wire.builtin.discovery_config;
  return {
      {"participant_lease", Number(discovery.leaseDuration)},
      {"announcement", Number(discovery.leaseDuration_announcementperiod)},
      {"initial_announcements", discovery.initial_announcements.count},
      {"initial_announcement_period", Number(discovery.initial_announcements.period)},
      {"discovery_protocol", Number(discovery.discoveryProtocol)},
      {"client_announcement", Number(discovery.discoveryServer_client_syncperiod)},
      {"avoid_builtin_multicast", wire.builtin.avoid_builtin_multicast ? 1 : 0},
      {"liveliness_protocol", wire.builtin.use_WriterLivelinessProtocol ? 1 : 0},
      {"builtin_transports", qos.transport().use_builtin_transports ? 1 : 0},
      {"mutation_tries", wire.builtin.mutation_tries},
      {"participant_id", wire.participant_id},
      {"port_base", wire.port.portBase},
      {"domain_gain", wire.port.domainIDGain},
      {"participant_gain", wire.port.participantIDGain},
      {"port_offset_0", wire.port.offsetd0},
      {"port_offset_1", wire.port.offsetd1},
      {"port_offset_2", wire.port.offsetd2},
      {"port_offset_3", wire.port.offsetd3},
  };
}

}  // namespace giveway::link
