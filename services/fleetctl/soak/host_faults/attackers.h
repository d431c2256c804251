// Carries out a soak's faults of an intruder: while one lasts, the program `attacker` of the tests
// (tests/attack) runs as a child, and ends with the fault, or with the soak. Sends nothing itself,
// and knows nothing of packets; what became of them is found out elsewhere, by the counters of
// those who got them. Single-threaded.
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
  std::string program;  // empty: there is none
  std::uint32_t domain = 0;
  std::string interface;  // of the fleet: name, address or "any"
};

// Whether this process may listen to packets of others: the program hears before it speaks.
bool MayOpenPacketSocket();
// Empty: faults of an intruder can be carried out. Otherwise why not.
std::string WhyNoAttacker(const std::string& program, bool may_open_packet_socket);
// The command line that carries out one of those.
std::vector<std::string> AttackWords(const AttackerTools& tools, const faults::Fault& fault);

class Attackers {
 public:
  // On the thread that made it.
  explicit Attackers(AttackerTools tools) : tools_(std::move(tools)) {}

  // Faults of other actors are none of ours: nothing happens. `fault` outlives its end. Throws
  // StartError.
  void Begin(const faults::Fault& fault);
  void End(const faults::Fault& fault) { running_.erase(&fault); }
  // Often. Complains on stderr of one that ended before its fault did.
  void Turn();

  // Of a fault that lasts, and that no counter of a vehicle shows: how many packets the program
  // says it sent. Empty: none, or it shows elsewhere.
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
