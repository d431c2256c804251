// The profile set's UDP transport with an impaired channel behind it: a Fast DDS chaining transport
// that loses, delays, doubles and corrupts what arrives. Made only where an impairment is asked
// for.
//
// It acts on the receiving side. There each direction between two processes is impaired exactly
// once; a multicast packet may be received by some and not by others, as over radio; and the packet
// names its sender, which a multicast's destination does not name.
#pragma once

#include <memory>

#include "services/link/fastdds/fastdds_version.h"
#include "services/link/impairment/impairer.h"

namespace giveway::link {

std::shared_ptr<transport::TransportDescriptorInterface> MakeImpairedTransport(
    std::shared_ptr<transport::TransportDescriptorInterface> udp,
    std::shared_ptr<Impairer> impairer);

PrefixBytes BytesOf(const rtps::GuidPrefix_t& prefix);

// Reports discovered writers to the impairer, and everything to the listener behind it.
class NamingListener final : public DiscoveryListener {
 public:
  NamingListener(std::shared_ptr<Impairer> impairer, DiscoveryListener& next)
      : impairer_(std::move(impairer)), next_(next) {}
  void OnWriter(Change change, const rtps::GUID_t& writer,
                const std::vector<std::string>& partitions) override;

 private:
  std::shared_ptr<Impairer> impairer_;
  DiscoveryListener& next_;
};

}  // namespace giveway::link
