// A discovery probe: reads chosen topics in chosen partitions in place of another process and
// reports, process by process, what was discovered, matched and received. Writes nothing, decodes
// no sample.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "services/link/fastdds/found_endpoint.h"
#include "services/link/fastdds/link_options.h"
#include "services/types/ids.h"
#include "services/types/time.h"

namespace giveway::link {

struct ProbeTopic {
  std::string name;       // "fleet/beacon"
  std::string partition;  // of the reader
};

struct ProbedTopicCount {
  bool matched = false;  // with a writer of the process, at some time
  std::uint64_t samples = 0;
};

// What a participant's GUID and its writers say.
struct ProbedProcess {
  std::array<std::uint8_t, 16> guid{};  // the first twelve bytes of all that it owns
  std::uint16_t host_id = 0;            // as Fast DDS made it from the machine's addresses
  std::uint16_t process = 0;       // the low half of its process id, in its own namespace of ids
  VehicleId vehicle = kNoVehicle;  // named by a partition of its writers
  std::vector<std::string> partitions;             // of its writers; "" is the default one
  std::map<std::string, ProbedTopicCount> topics;  // by name
  std::vector<FoundEndpoint> endpoints;            // as discovery announces them
};

class DiscoveryProbe {
 public:
  // `hearer` is the vehicle whose impairment rules apply, if there are any. Throws LinkError, also
  // where a topic is unknown.
  DiscoveryProbe(const LinkOptions& options, const std::vector<ProbeTopic>& topics,
                 VehicleId hearer);
  ~DiscoveryProbe();
  DiscoveryProbe(const DiscoveryProbe&) = delete;
  DiscoveryProbe& operator=(const DiscoveryProbe&) = delete;

  // Blackouts of the impairment count from here; only the first call counts.
  void StartImpairment(SteadyTime start);
  // Of endpoints found about a second ago, those that match none of the readers here, though their
  // topic is the same, and why: a line each.
  std::vector<std::string> TakeUnfit(SteadyTime now);
  // All processes found so far, and what was received from them.
  std::vector<ProbedProcess> Poll();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace giveway::link
