// What every process needs to be a participant. Values; config fills them from the command line.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "services/link/fastdds/server_addresses.h"
#include "services/types/admin.h"
#include "services/types/discovery_server.h"
#include "services/types/impairment.h"

namespace giveway::link {

struct LinkOptions {
  std::uint32_t domain = 0;             // 1..99; above 101 ports collide with ephemeral ones
  std::string interface = "127.0.0.1";  // an address, an interface's name, or "any"
  QosProfiles qos;                      // a complete Fast DDS XML set, see ReadProfileFile
  std::string area = "main";            // [a-z0-9_-]+
  std::uint32_t fleet_size = 2;         // sets history depths and announcement periods
  std::uint32_t strangers = 256;        // participants beyond the fleet, at once: packet_filter.h
  bool partition_free = false;          // vehicle: a second beacon, for readers without a partition
  Impairment impairment = {};           // of what this process hears; its seed is set
  // Overrides the profile set's discovery; none: as the set says.
  std::vector<DiscoveryServer> discovery_servers = {};
  // Theirs, in the same order, where they are known. None: the link looks them up, and meanwhile
  // this process does nothing else.
  std::vector<ServerAddress> server_addresses = {};
  bool hears_all_bodies = false;  // observers: truth of the whole fleet
  // Readers request neither a deadline nor a lease, whatever the profile set says: the library then
  // sets no timer with every sample that comes.
  bool requests_no_times = false;
  // Observers: statuses are requested best effort. A reliable reader answers each of them, and one
  // that was lost is worth little: the next counts on from it.
  bool requests_status_once = false;
  // Of a process that looks at what came now and then, and not at once: it receives packets several
  // at a time, up to 40 ms late. Waking for each of them costs more than what is in them.
  bool lets_packets_gather = false;
  // Only the profile set's UDP is left. Set once the files of shared memory were deleted: the
  // library removes files by name as participants end, and would remove new files of the same name.
  bool leaves_out_shared_memory = false;
};

inline LinkOptions WithoutSharedMemory(LinkOptions options) {
  options.leaves_out_shared_memory = true;
  return options;
}

inline LinkOptions OfAllBodies(LinkOptions options) {
  options.hears_all_bodies = true;
  return options;
}

// An entity could not be made: says which, why, and what to do. At start-up, and where a link
// replaces its participant; main exits with 2.
class LinkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace giveway::link
