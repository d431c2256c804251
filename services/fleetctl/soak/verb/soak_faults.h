// Which lists of faults a soak carries out: the scenario's own, that of --faults, or both as one;
// and what is left out of them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/faults/fault.h"
#include "services/faults/fault_file.h"
#include "services/fleetctl/soak/verb/soak_options.h"

namespace giveway::fleetctl {

struct SoakFaults {
  std::vector<faults::FaultFile> sources;
  std::string flag;  // --faults of the line that repeats the soak; empty: without it
  std::string name;  // of both, for people and comparisons
};

// `own` is the scenario's list. Where it has none, and --faults is not given, the faults are the
// shipped ones of `calm`. Throws InputError.
SoakFaults FaultsOf(const SoakOptions& options, const std::optional<faults::FaultFile>& own);

// By kind and reason: a list of weeks has half a million faults.
class SkippedFaults {
 public:
  void Add(const faults::Fault& fault, const std::string& why);
  std::uint64_t Count() const { return count_; }
  // One for each kind and reason: the first such fault, how many more, and why.
  std::vector<std::string> Lines() const;

 private:
  struct Group {
    std::string first;
    std::uint64_t more = 0;
  };

  std::map<std::pair<faults::Kind, std::string>, Group> groups_;
  std::uint64_t count_ = 0;
};

}  // namespace giveway::fleetctl
