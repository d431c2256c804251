#include "services/fleetctl/doctor/multicast_probe.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "services/fleetctl/process/file_descriptor.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kGroup = "239.255.0.1";  // RTPS 9.6.1.4.1
constexpr int kWaitMs = 200;

template <typename Value>
bool Set(const FileDescriptor& socket, int option, const Value& value) {
  return ::setsockopt(socket.Get(), IPPROTO_IP, option, &value, sizeof value) == 0;
}

sockaddr* Plain(sockaddr_in* address) { return reinterpret_cast<sockaddr*>(address); }

}  // namespace

std::optional<bool> EchoesMulticast(const std::string& address) {
  const FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ip_mreq joined{};
  sockaddr_in group{};
  socklen_t size = sizeof group;
  group.sin_family = AF_INET;  // any port that is free
  if (::inet_pton(AF_INET, kGroup, &joined.imr_multiaddr) != 1 ||
      ::inet_pton(AF_INET, address.c_str(), &joined.imr_interface) != 1 || !socket.IsOpen() ||
      ::bind(socket.Get(), Plain(&group), size) != 0 ||
      ::getsockname(socket.Get(), Plain(&group), &size) != 0) {
    return std::nullopt;
  }
  group.sin_addr = joined.imr_multiaddr;
  const char said[] = "giveway";
  const bool sent = Set(socket, IP_ADD_MEMBERSHIP, joined) &&
                    Set(socket, IP_MULTICAST_IF, joined.imr_interface) &&
                    Set(socket, IP_MULTICAST_LOOP, 1) && Set(socket, IP_MULTICAST_TTL, 0) &&
                    ::sendto(socket.Get(), said, sizeof said, 0, Plain(&group), size) >= 0;
  if (!sent) return false;
  pollfd arrives{socket.Get(), POLLIN, 0};
  return ::poll(&arrives, 1, kWaitMs) == 1;
}

}  // namespace giveway::fleetctl
