// Everything particular to one version of Fast DDS: names, headers, return codes, the shape of the
// discovery callback, the generated types. The rest of services/link compiles against either 2.9.1
// or 3.1.2 unchanged. Never included outside services/link and its tests.
#pragma once

#include <fastcdr/exceptions/Exception.h>

#include <algorithm>
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
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "services/link/fastdds/found_endpoint.h"

namespace giveway::link {

// An element of a profile file, by its name in 2.9 and in the release at hand.
struct Respelt {
  std::string_view in_2_9;
  std::string_view here;
};

}  // namespace giveway::link

#if __has_include(<fastrtps/config.h>)
#include <fastdds/rtps/common/CacheChange.h>
#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/common/InstanceHandle.h>
#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
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
// Whether readers of a writer may be removed while it sends to others. 2.9.1 holds the locks of its
// senders while it removes one, and may wait for the thread that sends, which waits for them: where
// an instance was unregistered that the removed reader had not acknowledged (corrected in 2.10.7
// and 3.1.1, eProsima/Fast-DDS#5432). The end of a lease takes the same locks, but on the thread
// that answers requests, so that no more samples are repeated meanwhile. 2.9.1 needs no farewell:
// see dropped_writers.h.
inline constexpr bool kRemovesWhileItSends = false;

inline bool Ok(const ReturnCode& code) { return code == ReturnCode::RETCODE_OK; }
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
// The instance that a sample is of. False for a type without a key.
inline bool ComputeInstance(dds::TopicDataType& type, void* sample, rtps::InstanceHandle_t* to) {
  return type.m_isGetKeyDefined && type.getKey(sample, to, false);
}
inline std::uint32_t LargestSize(const dds::TopicDataType& type) { return type.m_typeSize; }
// How generated code is given a payload.
inline rtps::SerializedPayload_t* AsPassed(rtps::SerializedPayload_t& payload) { return &payload; }
inline const rtps::SerializedPayload_t& PayloadOf(const rtps::SerializedPayload_t* passed) {
  return *passed;
}
// What a transport is given to send, as far as the pace of asking needs it: ask_pace.h.
inline std::span<const std::uint8_t> PacedBytes(const rtps::octet* bytes, std::uint32_t size) {
  return {bytes, size};
}
// The bytes in front of what a transport is given to send: of acknowledgements all.
inline std::span<const std::uint8_t> FirstBytes(const rtps::octet* bytes, std::uint32_t size) {
  return {bytes, size};
}
// Whether a sample that was deserialized is all of it: what ends early is an exception here.
inline bool IsWhole(dds::TopicDataType&, const rtps::SerializedPayload_t*, void*) { return true; }

}  // namespace giveway::link

#define GIVEWAY_IS_PLAIN_PARAMETERS
#define GIVEWAY_PAYLOAD rtps::SerializedPayload_t*
#define GIVEWAY_SENT const rtps::octet*
#else
#include <fastdds/config.hpp>
#include <fastdds/rtps/builtin/data/PublicationBuiltinTopicData.hpp>
#include <fastdds/rtps/builtin/data/SubscriptionBuiltinTopicData.hpp>
#include <fastdds/rtps/common/CacheChange.hpp>
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
inline constexpr bool kRemovesWhileItSends = true;
inline constexpr bool kServersByPrefix = false;

inline bool Ok(ReturnCode code) { return code == dds::RETCODE_OK; }

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
inline bool ComputeInstance(dds::TopicDataType& type, void* sample, rtps::InstanceHandle_t* to) {
  return type.is_compute_key_provided &&
         type.compute_key(static_cast<const void*>(sample), *to, false);
}
inline std::uint32_t LargestSize(const dds::TopicDataType& type) {
  return type.max_serialized_type_size;
}
inline rtps::SerializedPayload_t& AsPassed(rtps::SerializedPayload_t& payload) { return payload; }
inline const rtps::SerializedPayload_t& PayloadOf(const rtps::SerializedPayload_t& passed) {
  return passed;
}
// The library itself asks less and less often.
inline std::span<const std::uint8_t> PacedBytes(const std::vector<transport::NetworkBuffer>&,
                                                std::uint32_t) {
  return {};
}
// The bytes in front of what a transport is given to send: of acknowledgements all.
inline std::span<const std::uint8_t> FirstBytes(
    const std::vector<transport::NetworkBuffer>& buffers, std::uint32_t) {
  if (buffers.empty()) return {};
  return {static_cast<const std::uint8_t*>(buffers.front().buffer), buffers.front().size};
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

inline std::int64_t ToNanoseconds(const Duration& duration) {
  constexpr std::int32_t kEndlessSeconds = 0x7fffffff;  // alone: a time that a profile says
  if (duration.seconds == kEndlessSeconds && duration.nanosec != 0) return kEndless;
  return duration.seconds * std::int64_t{1'000'000'000} + duration.nanosec;
}

template <typename Partition, typename Reliability, typename Durability, typename Deadline,
          typename Liveliness, typename Ownership>
FoundEndpoint MakeEndpoint(bool writes, const rtps::GUID_t& guid, std::string topic,
                           std::string type, const Partition& partition,
                           const Reliability& reliability, const Durability& durability,
                           const Deadline& deadline, const Liveliness& liveliness,
                           const Ownership& ownership) {
  FoundEndpoint found;
  std::copy_n(guid.guidPrefix.value, 12, found.guid.begin());
  std::copy_n(guid.entityId.value, 4, found.guid.begin() + 12);
  found.writes = writes;
  found.topic = std::move(topic);
  found.type = std::move(type);
  found.partitions = partition.names();
  found.reliable = reliability.kind == dds::RELIABLE_RELIABILITY_QOS;
  found.durability = static_cast<int>(durability.kind);
  found.deadline_ns = ToNanoseconds(deadline.period);
  found.liveliness = static_cast<int>(liveliness.kind);
  found.lease_ns = ToNanoseconds(liveliness.lease_duration);
  found.exclusive = ownership.kind == dds::EXCLUSIVE_OWNERSHIP_QOS;
  return found;
}

// One of our own.
inline FoundEndpoint Described(const dds::DataWriter& writer) {
  const auto& qos = writer.get_qos();
  return MakeEndpoint(true, writer.guid(), writer.get_topic()->get_name(),
                      writer.get_topic()->get_type_name(),
                      writer.get_publisher()->get_qos().partition(), qos.reliability(),
                      qos.durability(), qos.deadline(), qos.liveliness(), qos.ownership());
}
inline FoundEndpoint Described(const dds::DataReader& reader) {
  const auto& qos = reader.get_qos();
  return MakeEndpoint(false, reader.guid(), reader.get_topicdescription()->get_name(),
                      reader.get_topicdescription()->get_type_name(),
                      reader.get_subscriber()->get_qos().partition(), qos.reliability(),
                      qos.durability(), qos.deadline(), qos.liveliness(), qos.ownership());
}

// Reports every writer in the domain that this participant discovers, its own included, and whether
// it has discovered any other participant yet.
class DiscoveryListener : public dds::DomainParticipantListener {
 public:
  enum class Change : std::uint8_t { kFound, kGone };

  // Called on the library's threads. A writer whose QoS changed is found again.
  virtual void OnWriter(Change change, const rtps::GUID_t& writer,
                        const std::vector<std::string>& partitions) = 0;

  // From now on the endpoints found are kept for TakeEndpoints. Before the participant is made.
  void KeepEndpoints() { keeps_endpoints_ = true; }
  // The endpoints of others found, or found changed, since the last call; of too many, the first.
  std::vector<FoundEndpoint> TakeEndpoints() { return endpoints_.Take(); }

  bool HasFoundAny() const { return has_found_any_.load(std::memory_order_relaxed); }

  // Participants whose lease the library saw end: of each writer of theirs it keeps a record.
  std::uint32_t Dropped() const { return dropped_.load(std::memory_order_relaxed); }

#if __has_include(<fastrtps/config.h>)
  void on_publisher_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryInfo&& found) final {
    const bool gone = found.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER;
    OnWriter(gone ? Change::kGone : Change::kFound, found.info.guid(),
             found.info.m_qos.m_partition.names());
    if (!gone) NoteEndpoint(true, found.info);
  }
  void on_subscriber_discovery(dds::DomainParticipant*, rtps::ReaderDiscoveryInfo&& found) final {
    if (found.status != rtps::ReaderDiscoveryInfo::REMOVED_READER) NoteEndpoint(false, found.info);
  }
  void on_participant_discovery(dds::DomainParticipant*,
                                rtps::ParticipantDiscoveryInfo&& found) final {
    NoteParticipant(found.status == rtps::ParticipantDiscoveryInfo::DROPPED_PARTICIPANT);
  }
#else
  void on_data_writer_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryStatus status,
                                const dds::PublicationBuiltinTopicData& found, bool&) final {
    const bool gone = status == rtps::WriterDiscoveryStatus::REMOVED_WRITER;
    OnWriter(gone ? Change::kGone : Change::kFound, found.guid, found.partition.names());
    if (!gone) NoteEndpoint(true, found);
  }
  void on_data_reader_discovery(dds::DomainParticipant*, rtps::ReaderDiscoveryStatus status,
                                const dds::SubscriptionBuiltinTopicData& found, bool&) final {
    if (status != rtps::ReaderDiscoveryStatus::REMOVED_READER) NoteEndpoint(false, found);
  }
  void on_participant_discovery(dds::DomainParticipant*, rtps::ParticipantDiscoveryStatus status,
                                const dds::ParticipantBuiltinTopicData&, bool&) final {
    NoteParticipant(status == rtps::ParticipantDiscoveryStatus::DROPPED_PARTICIPANT);
  }
#endif

 private:
  void NoteParticipant(bool dropped) {
    has_found_any_.store(true, std::memory_order_relaxed);
    if (dropped) dropped_.fetch_add(1, std::memory_order_relaxed);
  }

#if __has_include(<fastrtps/config.h>)
  template <typename ProxyData>
  void NoteEndpoint(bool writes, const ProxyData& found) {
    if (!keeps_endpoints_) return;
    const auto& qos = found.m_qos;
    endpoints_.Add(MakeEndpoint(writes, found.guid(), found.topicName().to_string(),
                                found.typeName().to_string(), qos.m_partition, qos.m_reliability,
                                qos.m_durability, qos.m_deadline, qos.m_liveliness,
                                qos.m_ownership));
  }
#else
  template <typename TopicData>
  void NoteEndpoint(bool writes, const TopicData& found) {
    if (!keeps_endpoints_) return;
    endpoints_.Add(MakeEndpoint(writes, found.guid, found.topic_name.to_string(),
                                found.type_name.to_string(), found.partition, found.reliability,
                                found.durability, found.deadline, found.liveliness,
                                found.ownership));
  }
#endif

  bool keeps_endpoints_ = false;
  EndpointQueue endpoints_;
  std::atomic<bool> has_found_any_{false};
  std::atomic<std::uint32_t> dropped_{0};
};

// A chaining transport that sends as the one below it does.
class ForwardingTransport : public transport::ChainingTransport {
 public:
  using ChainingTransport::ChainingTransport;
  bool send(rtps::SenderResource* below, GIVEWAY_SENT bytes, std::uint32_t size,
            rtps::LocatorsIterator* from, rtps::LocatorsIterator* to,
            const std::chrono::steady_clock::time_point& timeout) override {
    return below->send(bytes, size, from, to, timeout);
  }
};

// Whether a sample of this many bytes, encapsulation header included, is one of an older writer:
// the type has gained members at its end since. `read` was read from those bytes and zeros.
inline constexpr std::uint32_t kStatusBytesBeforePackets = 888;
inline constexpr std::uint32_t kStatusBytesBeforeHeap = 1264;  // and those of its accounts
inline constexpr std::uint32_t kAccountBytes = 9 * 4;
// With heap_bytes, which is aligned behind the encapsulation header.
constexpr std::uint32_t StatusBytesBeforeEndpoints(std::uint32_t accounts) {
  constexpr std::uint32_t kHeader = 4;
  const std::uint32_t before = kStatusBytesBeforeHeap + kAccountBytes * accounts - kHeader;
  return kHeader + (before + 7) / 8 * 8 + 8;
}
inline bool IsOfOlderWriter(const wire::Status& read, std::uint32_t bytes) {
  const auto accounts = static_cast<std::uint32_t>(read.accounts().size());
  return bytes == kStatusBytesBeforePackets ||
         bytes == kStatusBytesBeforeHeap + kAccountBytes * accounts ||
         bytes == StatusBytesBeforeEndpoints(accounts);
}

// A generated type that is always deserialized. By default the library loans its network buffer for
// types without strings: unchecked in length and byte order, and misaligned for doubles. The
// generated code lets most exceptions of corrupted bytes through; here they are no sample.
template <typename Generated>
class CheckedType final : public Generated {
 public:
  bool is_plain(GIVEWAY_IS_PLAIN_PARAMETERS) const override { return false; }
  bool deserialize(GIVEWAY_PAYLOAD payload, void* sample) override {
    return Decode(payload, sample) || DecodeOlder(PayloadOf(payload), sample);
  }

 private:
  bool DecodeOlder(const rtps::SerializedPayload_t& came, void* sample) {
    if constexpr (std::is_same_v<typename Generated::type, wire::Status>) {
      rtps::SerializedPayload_t whole(LargestSize(*this));
      if (came.length >= whole.max_size) return false;
      whole.length = whole.max_size;
      std::fill_n(whole.data, whole.length, rtps::octet{0});
      std::copy_n(came.data, came.length, whole.data);
      return Decode(AsPassed(whole), sample) &&
             IsOfOlderWriter(*static_cast<wire::Status*>(sample), came.length);
    } else {
      return false;
    }
  }
  bool Decode(GIVEWAY_PAYLOAD payload, void* sample) {
    try {
      return Generated::deserialize(payload, sample) && IsWhole(*this, payload, sample);
    } catch (const eprosima::fastcdr::exception::Exception&) {
      return false;
    }
  }
};

}  // namespace giveway::link
