// Loads and validates a fault file. Protobuf text in, values out, or every problem found; and with
// a fleet and the course of a run, the concrete list.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "services/config/problem.h"
#include "services/faults/expand.h"
#include "services/faults/fault_file.h"

namespace giveway {

// A list that a soak of weeks has written: 51 MB for 30 days of `everything` with 20 vehicles.
inline constexpr std::uintmax_t kMaxFaultFileBytes = 64U << 20;

// Reads `path`: a file, or the name of a shipped one without folder and ending. Throws InputError.
faults::FaultFile LoadFaults(const std::string& path);

// What Expand refused, as problems of the file.
std::vector<Problem> ProblemsOf(const faults::FaultFile& file, const faults::Expansion& expansion);

// Loads and expands. Throws InputError for both.
faults::Expansion LoadAndExpandFaults(const std::string& path, const faults::Course& course,
                                      std::span<const VehicleId> vehicles);

}  // namespace giveway
