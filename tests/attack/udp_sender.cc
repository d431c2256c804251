#include "tests/attack/udp_sender.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <thread>

namespace giveway::attack {
namespace {

constexpr std::chrono::milliseconds kCatchUp(100);

}  // namespace

UdpSender::UdpSender(const std::string& source, double packets_a_second)
    : socket_(socket(AF_INET, SOCK_DGRAM, 0)),
      apart_(static_cast<std::int64_t>(1e9 / packets_a_second)),
      due_(std::chrono::steady_clock::now()) {
  const in_addr interface = AddressOf(source);
  if (setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_IF, &interface, sizeof interface) != 0) {
    throw std::system_error(errno, std::generic_category(), "IP_MULTICAST_IF " + source);
  }
  const sockaddr_in any{.sin_family = AF_INET, .sin_port = 0, .sin_addr = {}, .sin_zero = {}};
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&any), sizeof any) != 0) {
    throw std::system_error(errno, std::generic_category(), "bind");
  }
}

std::uint16_t UdpSender::Port() const {
  sockaddr_in own{};
  socklen_t size = sizeof own;
  getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size);
  return ntohs(own.sin_port);
}

UdpSender::~UdpSender() { close(socket_); }

void UdpSender::WaitForTurn() {
  // After a delay the sender catches up with a little of it only.
  due_ = std::max(due_, std::chrono::steady_clock::now() - kCatchUp);
  std::this_thread::sleep_until(due_);
}

void UdpSender::Send(std::span<const std::uint8_t> bytes, in_addr to, std::uint16_t port) {
  WaitForTurn();
  due_ += apart_;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr = to;
  address.sin_port = htons(port);
  sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&address),
         sizeof address);
  ++sent_;
}

in_addr AddressOf(const std::string& text) {
  in_addr address{};
  if (inet_pton(AF_INET, text.c_str(), &address) != 1) {
    throw std::invalid_argument(text + " is no IPv4 address");
  }
  return address;
}

}  // namespace giveway::attack
