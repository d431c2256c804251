#include "services/link/fastdds/joined_groups.h"

#include <netinet/in.h>
#include <sys/socket.h>

#include <charconv>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace giveway::link {
namespace {

std::vector<int> OpenDescriptors() {
  std::vector<int> open;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const std::string name = entry.path().filename();
    int number = -1;
    std::from_chars(name.data(), name.data() + name.size(), number);
    if (number >= 0) open.push_back(number);
  }
  return open;
}

bool IsUdpSocketAt(int descriptor, std::uint16_t port) {
  int kind = 0;
  socklen_t size = sizeof kind;
  if (getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &kind, &size) != 0 || kind != SOCK_DGRAM) {
    return false;
  }
  sockaddr_storage bound{};
  size = sizeof bound;
  if (getsockname(descriptor, reinterpret_cast<sockaddr*>(&bound), &size) != 0) return false;
  if (bound.ss_family != AF_INET) return false;
  sockaddr_in address;
  std::memcpy(&address, &bound, sizeof address);
  return ntohs(address.sin_port) == port;
}

}  // namespace

int HearJoinedInterfacesOnly(std::uint16_t port) {
  constexpr int kOff = 0;
  int changed = 0;
  for (const int descriptor : OpenDescriptors()) {
    if (!IsUdpSocketAt(descriptor, port)) continue;
    if (setsockopt(descriptor, IPPROTO_IP, IP_MULTICAST_ALL, &kOff, sizeof kOff) != 0) return -1;
    ++changed;
  }
  return changed;
}

}  // namespace giveway::link
