#include "services/fleetctl/soak/verb/soak_faults.h"

#include <fmt/format.h>

#include "services/config/faults/fault_sources.h"
#include "services/faults/kind_table.h"

namespace giveway::fleetctl {

SoakFaults FaultsOf(const SoakOptions& options, const std::optional<faults::FaultFile>& own) {
  SoakFaults faults;
  faults.flag = options.faults.empty() && !own ? "calm" : options.faults;
  faults.sources = LoadFaultSources(own, faults.flag);
  faults.name = own ? options.scenario : "";
  if (!faults.flag.empty()) faults.name += (own ? " and " : "") + faults.flag;
  return faults;
}

void SkippedFaults::Add(const faults::Fault& fault, const std::string& why) {
  ++count_;
  const auto [group, is_new] = groups_.try_emplace({fault.kind, why});
  if (is_new) {
    group->second.first =
        fmt::format("{}#{} ({} of {} at {:.1f} s)", fault.rule, fault.nth,
                    faults::ToString(fault.kind), faults::ToString(fault.target), fault.at_s);
  } else {
    ++group->second.more;
  }
}

std::vector<std::string> SkippedFaults::Lines() const {
  std::vector<std::string> lines;
  for (const auto& [key, group] : groups_) {
    const std::string more =
        group.more == 0 ? "" : fmt::format(" and {} more of its kind", group.more);
    lines.push_back(group.first + more + ": " + key.second);
  }
  return lines;
}

}  // namespace giveway::fleetctl
