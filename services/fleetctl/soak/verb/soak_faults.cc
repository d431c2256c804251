#include "services/fleetctl/soak/verb/soak_faults.h"

#include "services/config/faults/fault_sources.h"

namespace giveway::fleetctl {

SoakFaults FaultsOf(const SoakOptions& options, const std::optional<faults::FaultFile>& own) {
  SoakFaults faults;
  faults.flag = options.faults.empty() && !own ? "calm" : options.faults;
  faults.sources = LoadFaultSources(own, faults.flag);
  faults.name = own ? options.scenario : "";
  if (!faults.flag.empty()) faults.name += (own ? " and " : "") + faults.flag;
  return faults;
}

}  // namespace giveway::fleetctl
