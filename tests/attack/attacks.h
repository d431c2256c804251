// What is sent at a fleet: one function an attack. Each uses what was captured of the fleet, as an
// intruder without credentials would.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tests/attack/capture.h"
#include "tests/attack/udp_sender.h"

namespace giveway::attack {

struct Target {
  std::uint32_t domain = 0;
  in_addr address{};                   // of one participant's ports
  std::uint32_t vehicle = 0;           // the one that is meant; 0: all
  std::vector<Packet> captured;        // of the fleet; may be empty
  const Listener* listener = nullptr;  // hears on; null: goes by nothing that is said meanwhile
  std::chrono::milliseconds time{3000};
  std::uint64_t seed = 1;
};

using Attack = std::function<void(const Target&, UdpSender*)>;

// By name, as on the command line.
const std::map<std::string, Attack>& Attacks();
// Whether it can be aimed at one vehicle, or speak as it.
bool TakesVehicle(const std::string& attack);
// Whether what was captured of the target is enough for such an attack; of all it always is.
bool KnowsEnough(const std::string& attack, const Target& target);

// The ports of a domain: RTPS 2.3, 9.6.1.1.
std::uint16_t MulticastPort(std::uint32_t domain);
std::uint16_t UnicastPort(std::uint32_t domain, std::uint32_t participant, bool user);

}  // namespace giveway::attack
