// Injects a soak's faults of an intruder: during a fault the program `attacker` of the tests
// (tests/attack) runs as a child, and ends with the fault, or with the soak. Sends nothing itself,
// and knows nothing of packets; their effect is measured elsewhere, by the counters of their
// receivers. Single-threaded.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "services/faults/fault.h"
#include "services/fleetctl/process/child_process.h"

namespace giveway::fleetctl {

struct AttackerTools {
  std::string program;  // empty: not available
  std::uint32_t domain = 0;
  std::string interface;  // of the fleet: name, address or "any"
};

// Whether this process may capture packets of others: the program listens before it sends.
bool MayOpenPacketSocket();
// Empty if faults of an intruder can be injected, else the reason.
std::string WhyNoAttacker(const std::string& program, bool may_open_packet_socket);
// The command line that injects one of them.
std::vector<std::string> AttackWords(const AttackerTools& tools, const faults::Fault& fault);

class Attackers {
 public:
  // On the thread that made it.
  explicit Attackers(AttackerTools tools) : tools_(std::move(tools)) {}

  // Ignores faults of other actors. `fault` outlives its end. Throws StartError.
  void Begin(const faults::Fault& fault);
  void End(const faults::Fault& fault) { running_.erase(&fault); }
  // Call often. Reports on stderr an attacker that ended before its fault.
  void Turn();

  // For an active fault that no counter of a vehicle shows: how many packets the program reports to
  // have sent. Empty: none, or it is visible elsewhere.
  std::string EffectOf(const faults::Fault& fault) const;

 private:
  struct Running {
    std::unique_ptr<ChildProcess> process;
    bool complained = false;
  };

  AttackerTools tools_;
  std::map<const faults::Fault*, Running> running_;
};

}  // namespace giveway::fleetctl
