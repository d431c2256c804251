// Whether the network interfaces that a participant was made with are still those of this machine.
// The library binds its sockets and joins its multicast groups once: on an interface that was taken
// away and came back, with another address or as another device, it hears nothing ever again.
#pragma once

#include <string>
#include <vector>

#include "services/link/fastdds/interfaces.h"

namespace giveway::link {

// What changed, in words, of the interfaces that LinkOptions::interface means. Empty while those
// from before are there; and while one is away and nothing has come in its place, since then no new
// participant could do better.
std::string ChangeOf(const std::string& interface, const std::vector<Interface>& before,
                     const std::vector<Interface>& now);

class InterfaceWatch {
 public:
  // Notes what there is now.
  explicit InterfaceWatch(std::string interface);
  // Empty, too, while the system does not list its interfaces: it is asked again.
  std::string Change() const;

 private:
  std::string interface_;
  std::vector<Interface> before_;
};

}  // namespace giveway::link
