// Everything particular to one version of Fast DDS: names, headers, return codes, the shape of the
// discovery callback, the generated types. The rest of this room compiles against either 2.9.1 or
// 3.1.2 unchanged. Never included outside this room and its tests.
#pragma once

#include <fastcdr/exceptions/Exception.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <fastdds/dds/core/LoanableSequence.hpp>
#include <fastdds/dds/core/condition/StatusCondition.hpp>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace giveway::link {

// An element of a profile file, by its name in 2.9 and in the release at hand.
struct Respelt {
  std::string_view in_2_9;
  std::string_view here;
};

}  // namespace giveway::link

#if __has_include(<fastrtps/config.h>)
#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/common/InstanceHandle.h>
#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
#include <fastrtps/config.h>
#include <fastrtps/utils/IPLocator.h>
#include <idl/fleetPubSubTypes.h>

namespace giveway::link {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
namespace transport = eprosima::fastdds::rtps;
using Duration = eprosima::fastrtps::Duration_t;
using ReturnCode = eprosima::fastrtps::types::ReturnCode_t;
inline constexpr char kLibraryName[] = "Fast DDS " FASTRTPS_VERSION_STR;
inline constexpr int kLibraryMajor = FASTRTPS_VERSION_MAJOR;
inline constexpr std::array<Respelt, 0> kRespelt{};
inline constexpr bool kServersByPrefix = true;  // in discoveryServersList

inline bool Ok(const ReturnCode& code) { return code == ReturnCode::RETCODE_OK; }
// What a reader answers that is asked for an instance it does not have.
inline bool IsUnknownInstance(const ReturnCode& code) {
  return code == ReturnCode::RETCODE_BAD_PARAMETER;
}
// The result of DataWriter::write: true is good in 2.9.1, and 0 is good in 3.1.2.
inline bool Ok(bool written) { return written; }

inline void SetHeartbeatPeriod(dds::DataWriterQos& qos, const Duration& period) {
  qos.reliable_writer_qos().times.heartbeatPeriod = period;
}
inline Duration HeartbeatPeriod(const dds::DataWriterQos& qos) {
  return qos.reliable_writer_qos().times.heartbeatPeriod;
}
inline bool WithoutPositiveAcks(const dds::DataReaderQos& qos) {
  return qos.reliable_reader_qos().disable_positive_ACKs.enabled;
}
using Discovery = rtps::DiscoveryProtocol_t;

// A client of 2.9.1 must know the name of its server, too: `prefix`. 3.1.2 needs the address alone.
inline void AddDiscoveryServer(rtps::DiscoverySettings& discovery, const rtps::GuidPrefix_t& prefix,
                               const rtps::Locator_t& address) {
  auto& server = discovery.m_DiscoveryServers.emplace_back();
  server.guidPrefix = prefix;
  server.metatrafficUnicastLocatorList.push_back(address);
}

// A type support at work, as endpoints use it. The representation is XCDR1.
inline bool Serialize(dds::TopicDataType& type, void* sample, rtps::SerializedPayload_t& to) {
  return type.serialize(sample, &to);
}
inline bool Deserialize(dds::TopicDataType& type, rtps::SerializedPayload_t& from, void* sample) {
  return type.deserialize(&from, sample);
}
inline std::uint32_t SerializedSize(dds::TopicDataType& type, void* sample) {
  return type.getSerializedSizeProvider(sample)();
}
inline std::uint32_t LargestSize(const dds::TopicDataType& type) { return type.m_typeSize; }
// Whether a sample that was deserialized is all of it: what ends early is an exception here.
inline bool IsWhole(dds::TopicDataType&, const rtps::SerializedPayload_t*, void*) { return true; }

}  // namespace giveway::link

#define GIVEWAY_IS_PLAIN_PARAMETERS
#define GIVEWAY_PAYLOAD rtps::SerializedPayload_t*
#define GIVEWAY_SENT const rtps::octet*
#else
#include <fastdds/config.hpp>
#include <fastdds/rtps/builtin/data/PublicationBuiltinTopicData.hpp>
#include <fastdds/rtps/common/Guid.hpp>
#include <fastdds/rtps/common/InstanceHandle.hpp>
#include <fastdds/rtps/transport/ChainingTransport.hpp>
#include <fastdds/rtps/transport/SenderResource.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.hpp>
#include <fastdds/utils/IPLocator.hpp>
#include <idl/fleetPubSubTypes.hpp>

namespace giveway::link {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastdds::rtps;
namespace transport = eprosima::fastdds::rtps;
using Duration = dds::Duration_t;
using ReturnCode = dds::ReturnCode_t;
inline constexpr char kLibraryName[] = "Fast DDS " FASTDDS_VERSION_STR;
inline constexpr int kLibraryMajor = FASTDDS_VERSION_MAJOR;
inline constexpr std::array kRespelt = {
    Respelt{"initialHeartbeatDelay", "initial_heartbeat_delay"},
    Respelt{"heartbeatPeriod", "heartbeat_period"},
    Respelt{"nackResponseDelay", "nack_response_delay"},
    Respelt{"nackSupressionDuration", "nack_supression_duration"},
    Respelt{"initialAcknackDelay", "initial_acknack_delay"},
    Respelt{"heartbeatResponseDelay", "heartbeat_response_delay"},
    Respelt{"expectsInlineQos", "expects_inline_qos"},
};
inline constexpr bool kServersByPrefix = false;

inline bool Ok(ReturnCode code) { return code == dds::RETCODE_OK; }
inline bool IsUnknownInstance(ReturnCode code) { return code == dds::RETCODE_BAD_PARAMETER; }

inline void SetHeartbeatPeriod(dds::DataWriterQos& qos, const Duration& period) {
  qos.reliable_writer_qos().times.heartbeat_period = period;
}
inline Duration HeartbeatPeriod(const dds::DataWriterQos& qos) {
  return qos.reliable_writer_qos().times.heartbeat_period;
}
inline bool WithoutPositiveAcks(const dds::DataReaderQos& qos) {
  return qos.reliable_reader_qos().disable_positive_acks.enabled;
}
using Discovery = rtps::DiscoveryProtocol;

inline void AddDiscoveryServer(rtps::DiscoverySettings& discovery, const rtps::GuidPrefix_t&,
                               const rtps::Locator_t& address) {
  discovery.m_DiscoveryServers.push_back(address);
}

inline bool Serialize(dds::TopicDataType& type, void* sample, rtps::SerializedPayload_t& to) {
  return type.serialize(sample, to, dds::XCDR_DATA_REPRESENTATION);
}
inline bool Deserialize(dds::TopicDataType& type, rtps::SerializedPayload_t& from, void* sample) {
  return type.deserialize(from, sample);
}
inline std::uint32_t SerializedSize(dds::TopicDataType& type, void* sample) {
  return type.calculate_serialized_size(sample, dds::XCDR_DATA_REPRESENTATION);
}
inline std::uint32_t LargestSize(const dds::TopicDataType& type) {
  return type.max_serialized_type_size;
}
// Fast CDR 2 takes bytes that end where a member does for a sample of an older, shorter type, and
// leaves the rest as it is.
inline bool IsWhole(dds::TopicDataType& type, const rtps::SerializedPayload_t& from, void* sample) {
  return SerializedSize(type, sample) <= from.length;
}

}  // namespace giveway::link

#define GIVEWAY_IS_PLAIN_PARAMETERS dds::DataRepresentationId_t
#define GIVEWAY_PAYLOAD rtps::SerializedPayload_t&
#define GIVEWAY_SENT const std::vector<transport::NetworkBuffer>&
#endif

namespace giveway::link {

// Tells of every writer in the domain that this participant discovers, its own included, and
// whether it has found any other participant yet.
class DiscoveryListener : public dds::DomainParticipantListener {
 public:
  enum class Change : std::uint8_t { kFound, kGone };

  // Called on the library's threads. A writer whose QoS changed is found again.
  virtual void OnWriter(Change change, const rtps::GUID_t& writer,
                        const std::vector<std::string>& partitions) = 0;

  bool HasFoundAnybody() const { return has_found_anybody_.load(std::memory_order_relaxed); }

#if __has_include(<fastrtps/config.h>)
  void on_publisher_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryInfo&& found) final {
    const bool gone = found.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER;
    OnWriter(gone ? Change::kGone : Change::kFound, found.info.guid(),
             found.info.m_qos.m_partition.names());
  }
  void on_participant_discovery(dds::DomainParticipant*, rtps::ParticipantDiscoveryInfo&&) final {
    has_found_anybody_.store(true, std::memory_order_relaxed);
  }
#else
  void on_data_writer_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryStatus status,
                                const dds::PublicationBuiltinTopicData& found, bool&) final {
    const bool gone = status == rtps::WriterDiscoveryStatus::REMOVED_WRITER;
    OnWriter(gone ? Change::kGone : Change::kFound, found.guid, found.partition.names());
  }
  void on_participant_discovery(dds::DomainParticipant*, rtps::ParticipantDiscoveryStatus,
                                const dds::ParticipantBuiltinTopicData&, bool&) final {
    has_found_anybody_.store(true, std::memory_order_relaxed);
  }
#endif

 private:
  std::atomic<bool> has_found_anybody_{false};
};

// A chaining transport that sends as the one below it does.
class ForwardingTransport : public transport::ChainingTransport {
 public:
  using ChainingTransport::ChainingTransport;
  bool send(rtps::SenderResource* below, GIVEWAY_SENT bytes, std::uint32_t size,
            rtps::LocatorsIterator* from, rtps::LocatorsIterator* to,
            const std::chrono::steady_clock::time_point& timeout) final {
    return below->send(bytes, size, from, to, timeout);
  }
};

// A generated type that is always deserialized. Left to itself the library lends its network buffer
// for types without strings: unchecked in length and byte order, and misaligned for doubles. The
// generated code lets most exceptions of spoilt bytes through; here they are no sample.
template <typename Generated>
class CheckedType final : public Generated {
 public:
  bool is_plain(GIVEWAY_IS_PLAIN_PARAMETERS) const override { return false; }
  bool deserialize(GIVEWAY_PAYLOAD payload, void* sample) override {
    try {
      return Generated::deserialize(payload, sample) && IsWhole(*this, payload, sample);
    } catch (const eprosima::fastcdr::exception::Exception&) {
      return false;
    }
  }
};

}  // namespace giveway::link
