// QoS objects of the library as named numbers; see resolved_value.h.
#pragma once

#include <vector>

#include "services/link/fastdds/fastdds_version.h"
#include "services/link/resolved_value.h"

namespace giveway::link {

// Back from a number of nanoseconds, or kInfiniteDuration.
Duration ToDuration(std::int64_t nanoseconds);
std::int64_t NanosecondsOf(const Duration& duration);

std::vector<ResolvedValue> ValuesOf(const dds::DomainParticipantQos& qos);
std::vector<ResolvedValue> ValuesOf(const dds::DataWriterQos& qos, const dds::PublisherQos& around);
std::vector<ResolvedValue> ValuesOf(const dds::DataReaderQos& qos,
                                    const dds::SubscriberQos& around);

}  // namespace giveway::link
