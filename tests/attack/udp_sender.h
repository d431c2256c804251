// Sends datagrams to a fleet on one interface, at a rate.
#pragma once

#include <netinet/in.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>

namespace giveway::attack {

class UdpSender {
 public:
  // `source` is the address of the interface that multicasts leave by. Throws std::system_error.
  UdpSender(const std::string& source, double packets_a_second);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  // Until the next packet is due. For an attack whose packet depends on what was heard up to then.
  void WaitForTurn();
  // After WaitForTurn(). What the system does not take is lost, as on any network.
  void Send(std::span<const std::uint8_t> bytes, in_addr to, std::uint16_t port);
  // From any thread.
  std::uint64_t Sent() const { return sent_; }
  // The one it sends from.
  std::uint16_t Port() const;

 private:
  int socket_;
  std::chrono::nanoseconds apart_;
  std::chrono::steady_clock::time_point due_;  // of the next one
  std::atomic<std::uint64_t> sent_ = 0;
};

// Throws std::invalid_argument.
in_addr AddressOf(const std::string& text);

}  // namespace giveway::attack
