#include "tests/attack/capture.h"

#include <arpa/inet.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>
#include <utility>

namespace giveway::attack {
namespace {

[[noreturn]] void ThrowErrno(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

std::uint16_t Word(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8U | bytes[at + 1]);
}

// IPv4 with UDP in it, not in pieces.
std::optional<Packet> ParseUdp(const std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kUdpHeader = 8;
  constexpr std::uint16_t kPieces = 0x3fff;  // more to come, or an offset
  if (bytes.size() < 20 || bytes[0] >> 4U != 4 || bytes[9] != IPPROTO_UDP) return std::nullopt;
  const std::size_t header = std::size_t{bytes[0] & 15U} * 4;
  if (bytes.size() < header + kUdpHeader || (Word(bytes, 6) & kPieces) != 0) return std::nullopt;
  Packet packet;
  std::memcpy(&packet.to, bytes.data() + 16, sizeof packet.to);
  packet.from_port = Word(bytes, header);
  packet.port = Word(bytes, header + 2);
  packet.bytes.assign(bytes.begin() + static_cast<std::ptrdiff_t>(header + kUdpHeader),
                      bytes.end());
  return packet;
}

bool IsRtps(const std::vector<std::uint8_t>& bytes) {
  return bytes.size() > 20 && std::memcmp(bytes.data(), "RTPS", 4) == 0;
}

}  // namespace

Listener::Listener(const std::string& interface, std::uint16_t first_port, std::uint16_t last_port)
    : socket_(socket(AF_PACKET, SOCK_DGRAM, htons(ETH_P_IP))),
      first_port_(first_port),
      last_port_(last_port) {
  if (socket_ < 0) ThrowErrno("packet socket");
  sockaddr_ll at{};
  at.sll_family = AF_PACKET;
  at.sll_protocol = htons(ETH_P_IP);
  at.sll_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  if (bind(socket_, reinterpret_cast<sockaddr*>(&at), sizeof at) == 0) return;
  close(socket_);
  ThrowErrno("bind");
}

Listener::~Listener() { close(socket_); }

std::optional<Packet> Listener::Take(std::chrono::milliseconds time) const {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + time;
  std::vector<std::uint8_t> bytes(65536);
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    pollfd one{.fd = socket_, .events = POLLIN, .revents = 0};
    if (poll(&one, 1, std::max(static_cast<int>(left.count()), 0)) <= 0) return std::nullopt;
    bytes.resize(65536);
    const ssize_t got = recv(socket_, bytes.data(), bytes.size(), 0);
    if (got <= 0) return std::nullopt;
    bytes.resize(static_cast<std::size_t>(got));
    const auto packet = ParseUdp(bytes);
    if (!packet || packet->port < first_port_ || packet->port > last_port_) continue;
    if (IsRtps(packet->bytes)) return packet;
  }
}

std::vector<Packet> Listener::Capture(std::size_t most, std::chrono::milliseconds time) const {
  using Clock = std::chrono::steady_clock;
  std::vector<Packet> captured;
  const auto end = Clock::now() + time;
  while (captured.size() < most && Clock::now() < end) {
    auto packet = Take(std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()));
    if (packet) captured.push_back(std::move(*packet));
  }
  return captured;
}

}  // namespace giveway::attack
