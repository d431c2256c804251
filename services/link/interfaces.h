// Turns LinkOptions::interface into the addresses Fast DDS may use: its whitelist takes addresses
// only, and silently ignores what it does not know.
#pragma once

#include <string>
#include <vector>

namespace giveway::link {

// IPv4 addresses to allow; empty means all. `interface` is an address of this machine, an
// interface's name, or "any". Throws LinkError naming the interfaces there are.
std::vector<std::string> ResolveInterface(const std::string& interface);

}  // namespace giveway::link
