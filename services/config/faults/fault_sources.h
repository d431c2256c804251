// The lists of faults of a run: the scenario's own and that of a fault file. They are expanded as
// one list, so that what excludes what is decided between them too, and each problem names the file
// it is in.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/config/problem.h"
#include "services/faults/expand.h"
#include "services/faults/fault_file.h"
#include "services/types/ids.h"

namespace giveway {

// `own` is the scenario's. `path` is a file, or the name of a shipped one; empty: none. Throws
// InputError for an invalid file, and for each rule of it that has the name of one of `own`.
std::vector<faults::FaultFile> LoadFaultSources(const std::optional<faults::FaultFile>& own,
                                                const std::string& path);

// All rules as one file without a name.
faults::FaultFile Together(std::span<const faults::FaultFile> sources);

// The name of the file with this rule, which one of them has.
const std::string& FileOf(std::span<const faults::FaultFile> sources, const std::string& rule);

// What Expand refused of Together, as problems of the files.
std::vector<Problem> ProblemsOf(std::span<const faults::FaultFile> sources,
                                const faults::Expansion& expansion);

// Throws InputError for what Expand refuses.
faults::Expansion ExpandFaults(std::span<const faults::FaultFile> sources,
                               const faults::Course& course, std::span<const VehicleId> vehicles);

}  // namespace giveway
