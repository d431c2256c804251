// The profile set's UDP transport with the packet filter between it and the library: a Fast DDS
// chaining transport that drops what no sound sender sends, and sockets that hear the groups they
// joined on the interfaces they joined them on, and no others. In the name of a dead participant it
// sends a farewell (lease_watch.h), and it asks one that does not answer less and less often
// (ask_pace.h).
//
// Shared memory, where a profile names it, is not filtered: only processes of this user on this
// machine can write into it.
#pragma once

#include <cstdint>
#include <memory>

#include "services/link/fastdds/fastdds_version.h"
#include "services/link/packet_filter/packet_filter.h"

namespace giveway::link {

struct FilteredTransportOptions {
  PacketFilterOptions filter;
  bool joined_interfaces_only = true;  // of multicasts; false where every interface is meant
  // Of participants whose lease is nearly over; false where they are found by a server, or reach
  // this one past the transport.
  bool says_farewell = true;
  bool lets_packets_gather = false;  // as LinkOptions
};

// `below` is UDPv4, or a chain of transports that ends in it.
std::shared_ptr<transport::TransportDescriptorInterface> MakeFilteredTransport(
    std::shared_ptr<transport::TransportDescriptorInterface> below,
    const FilteredTransportOptions& options);

// The size in bytes of the largest type that a fleet's topics carry, encapsulation included.
std::uint32_t LargestSample();

}  // namespace giveway::link
