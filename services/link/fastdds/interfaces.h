// Turns LinkOptions::interface into the addresses Fast DDS may use: its whitelist takes addresses
// only, and silently ignores what it does not know.
#pragma once

#include <string>
#include <vector>

namespace giveway::link {

// One IPv4 address of one interface of this network namespace.
struct Interface {
  std::string name;
  std::string address;
  bool up = true;
  bool loopback = false;
  bool says_multicast = true;  // its flag; a loopback has none and carries multicast all the same
  unsigned index = 0;          // the kernel's, another if it is made again; 0: not known
};

// Throws LinkError.
std::vector<Interface> Ipv4Interfaces();

// IPv4 addresses to allow; empty means all. `interface` is an address of this machine, an
// interface's name, or "any". Throws LinkError naming the interfaces there are.
std::vector<std::string> ResolveInterface(const std::string& interface);

}  // namespace giveway::link
