// The settings with which the processes of a fleet are started, and the resulting command lines.
// Pure.
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/process/child_process.h"
#include "services/types/decision.h"
#include "services/types/discovery_server.h"
#include "services/types/ids.h"
#include "services/types/scenario.h"

namespace giveway::fleetctl {

enum class MemberKind : std::uint8_t { kWorld, kVehicle, kNewcomer, kDiscoveryServer };

// One process of a fleet, through all of its restarts.
struct MemberId {
  MemberKind kind = MemberKind::kWorld;
  // A vehicle's id. Newcomers, which have no id yet, and discovery servers are numbered from 1.
  std::uint32_t number = 0;

  friend auto operator<=>(const MemberId&, const MemberId&) = default;
};
inline constexpr MemberId kTheWorld{};
constexpr MemberId MemberOf(VehicleId vehicle) { return {MemberKind::kVehicle, Number(vehicle)}; }
// For messages: "the world", "vehicle 2", "newcomer 1", "discovery server 1".
std::string NameOf(MemberId member);

// Flags of every process. Absent values are the scenario's.
struct FleetOptions {
  std::optional<double> duration_s;
  std::optional<std::uint32_t> seed;
  std::optional<Behaviour> behaviour;
  // In an open fleet: how many are started without an id of the scenario. Absent: as many as the
  // scenario waits for, or one per spawn place if it waits for none.
  std::optional<std::uint32_t> vehicles;
  std::string interface = "127.0.0.1";
  std::vector<DiscoveryServer> discovery_servers;  // none: as the QoS file says
  std::string impair;  // of what the vehicles receive, see config/impair.h; empty: the scenario's
  bool lockstep = false;
  std::string log_level = "info";
  std::string logs_folder;    // empty: no logs are kept
  std::string record_folder;  // empty: vehicles record nothing
  std::string record_ring;    // seconds; empty: recordings are whole
  std::string admin_key;      // a file: orders must be sealed with it; empty: none are accepted
  std::string record_split;   // a size, see config/byte_size.h; empty: a recording is one file
};

struct FleetSpec {
  std::filesystem::path program_folder;  // giveway-world and giveway-vehicle are here
  std::string scenario_file;
  std::uint32_t domain = 0;
  std::string qos_file;
  int lock_fd = -1;             // inherited: the domain stays taken until the last process is gone
  bool flags_only = false;      // a measurement: no variable of the shell has an effect
  bool hands_on_lines = false;  // see ChildCommand
  // Vehicles that the scenario does not name ask for the ids 1, 2, 3 ..., and are vehicles of the
  // fleet by these, not newcomers.
  bool names_newcomers = false;
  FleetOptions options;
  std::map<MemberId, std::vector<std::string>> extra_words;  // at the end of the command line
  Nanoseconds stagger{0};  // from one start to the next; the world starts first
};

struct MemberCommand {
  MemberId member;
  ChildCommand child;
  Nanoseconds start_after{0};  // the start of the fleet
};

// How many vehicles to start that the scenario does not name: 0 in a closed fleet.
std::uint32_t NewcomerCount(const FleetOptions& options, const Scenario& scenario);
// The world first, then the named vehicles, then the newcomers.
std::vector<MemberCommand> MakeCommands(const FleetSpec& spec, const Scenario& scenario);

}  // namespace giveway::fleetctl
