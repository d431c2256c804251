// Listens to the UDP packets that pass an interface, as an intruder with a packet socket does.
#pragma once

#include <netinet/in.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace giveway::attack {

struct Packet {
  in_addr to{};
  std::uint16_t port = 0;
  std::uint16_t from_port = 0;
  std::vector<std::uint8_t> bytes;  // of the datagram
};

// Hears RTPS packets to a range of ports.
class Listener {
 public:
  // Throws std::system_error; needs the right to open packet sockets.
  Listener(const std::string& interface, std::uint16_t first_port, std::uint16_t last_port);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  // The next one; nothing if none comes in time.
  std::optional<Packet> Take(std::chrono::milliseconds time) const;
  // Until so many are there or the time is over.
  std::vector<Packet> Capture(std::size_t most, std::chrono::milliseconds time) const;

 private:
  int socket_;
  std::uint16_t first_port_;
  std::uint16_t last_port_;
};

}  // namespace giveway::attack
