// The command line of giveway-observer. Every flag has an environment twin, as of the other
// services.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "services/types/discovery_server.h"

namespace giveway {

struct ObserverFlags {
  std::uint32_t domain = 0;             // 1..99
  std::string interface = "127.0.0.1";  // of DDS: an address, an interface's name, or "any"
  std::vector<DiscoveryServer> discovery_servers;
  std::string qos;       // a file; ConfigDir()/qos/default.xml if not given
  std::string scenario;  // a file or a shipped scenario's name; empty: no walls are shown
  std::string area;      // whose beacons; empty: the scenario's, or main
  std::string address = "127.0.0.1";  // of the page
  std::uint32_t port = 8080;
  std::uint32_t foxglove_port = 0;      // 0: the Foxglove WebSocket is not served
  std::vector<std::string> host_names;  // by which browsers may ask for it
  std::string ask_health;               // not a service but a question to one: "live" or "ready"
  std::string log_format = "text";
  std::string log_level = "info";
  bool hang_on_signal = false;    // a drill, see HangSignal
  bool ros2 = false;              // publishes the fleet as ROS 2 messages
  double ros2_rate_hz = 10;       // 0.1..100
  std::uint32_t ros2_domain = 0;  // 1..99; 0: that of the fleet
};

// The fleet to show where --domain is not given: the only one of this machine.
struct OnlyFleet {
  std::uint32_t domain = 0;  // 0: there is none, or there are several; `why` says so
  std::string interface;
  std::string why;
};
using FindOnlyFleet = std::function<OnlyFleet()>;

// The flags, or the exit code to end with at once: 0 after --help or --version, 2 after stderr
// names what is wrong. `find` is asked only where --domain is missing.
std::variant<ObserverFlags, int> ParseObserverFlags(int argc, const char* const* argv,
                                                    std::string_view library,
                                                    const FindOnlyFleet& find);

}  // namespace giveway
