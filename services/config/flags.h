// The command line of the two services. Every flag has an environment twin: --log-level is
// GIVEWAY_LOG_LEVEL. The flag wins; an empty variable counts as unset. There is no third source.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "services/recording/resumed.h"
#include "services/types/decision.h"
#include "services/types/discovery_server.h"
#include "services/types/impairment.h"
#include "services/types/time.h"

namespace giveway {

struct ServiceFlags {
  std::uint32_t domain = 0;             // 1..99
  std::string interface = "127.0.0.1";  // an address, an interface's name, or "any"
  // Overrides the profile set's discovery; none: as the set says.
  std::vector<DiscoveryServer> discovery_servers;
  std::string qos;                 // a file; ConfigDir()/qos/default.xml if not given
  std::string scenario;            // a file or a shipped scenario's name
  std::uint32_t id = 0;            // vehicle only; 0 asks the world for any free id
  std::uint32_t threads = 1;       // world only; the result does not depend on it
  std::string checkpoint;          // world only; the file it is kept in; empty: none is
  std::string record;              // vehicle only; the file it is written to; empty: none is
  std::uint64_t record_split = 0;  // vehicle only; bytes of a file of it; 0: it is one file
  Nanoseconds record_ring{0};      // vehicle only; keeps so much of it at least; 0: all
  bool partition_free = false;     // vehicle only; beacons also without a partition
  std::optional<Resumed> resume;   // it was itself before, see restart.h
  bool stay = false;               // vehicle only; outlives its world
  std::string go_on_from;          // world only; the checkpoint it gave to itself
  std::string faults;              // world only; a concrete fault file; empty: none
  std::string try_qos;             // not a service: makes the endpoints of this set once, and ends
  std::string former_qos;   // the set it had before an order's; with it, it comes back if it must
  std::string rolled_back;  // why it came back with that
  // Of the profile set only UDP is used.
  bool leaves_out_shared_memory = false;
  std::string memory_lost;           // why it restarted itself so; empty: it did not
  bool hang_on_signal = false;       // vehicle only; a drill, see HangSignal
  bool watchdog = true;              // false: vehicle only, a drill; see Watchdog
  bool admin = false;                // takes orders of any operator; with a key only sealed ones
  std::string admin_key;             // the key's file; empty: none
  std::optional<Impairment> impair;  // vehicle only; instead of the scenario's
  // Overrides of the scenario's; 0 moves nothing. Without the flag: the scenario's own seed.
  std::optional<std::uint32_t> seed;
  std::optional<Behaviour> behaviour;
  std::optional<double> duration_s;
  bool lockstep = false;
  // Where its health is served; port 0: nowhere, for many vehicles share a host.
  std::string health_address = "127.0.0.1";
  std::uint32_t health_port = 0;
  // Not a service but a question to one: "live", "ready" or "metrics"; empty: a service.
  std::string ask_health;
  std::string log_format = "text";  // "text" or "json"
  std::string log_level = "info";   // "debug", "info", "warning" or "error"
};

// The flags, or the exit code to end with at once: 0 after --help or --version, 2 after writing to
// stderr every wrong flag with its value, the allowed range and the remedy. `library` is what
// --version names besides the service: "Fast DDS 2.9.1".
using ParsedFlags = std::variant<ServiceFlags, int>;
ParsedFlags ParseVehicleFlags(int argc, const char* const* argv, std::string_view library);
ParsedFlags ParseWorldFlags(int argc, const char* const* argv, std::string_view library);

// The behaviour whose Name() this is.
std::optional<Behaviour> BehaviourNamed(std::string_view name);

}  // namespace giveway
