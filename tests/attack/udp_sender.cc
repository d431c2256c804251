#include "tests/attack/udp_sender.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <thread>

namespace giveway::attack {

UdpSender::UdpSender(const std::string& source, double packets_a_second)
    : socket_(socket(AF_INET, SOCK_DGRAM, 0)),
      apart_(1 / packets_a_second),
      begun_(std::chrono::steady_clock::now()) {
  const in_addr interface = AddressOf(source);
  if (setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_IF, &interface, sizeof interface) != 0) {
    throw std::system_error(errno, std::generic_category(), "IP_MULTICAST_IF " + source);
  }
}

UdpSender::~UdpSender() { close(socket_); }

void UdpSender::Send(std::span<const std::uint8_t> bytes, in_addr to, std::uint16_t port) {
  const auto due = begun_ + std::chrono::duration_cast<std::chrono::nanoseconds>(
                                apart_ * static_cast<double>(sent_));
  std::this_thread::sleep_until(due);
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
