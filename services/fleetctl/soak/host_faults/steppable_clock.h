// The system clock of one process, stepped by a soak: a file that the library preloaded into that
// process reads. Steps no clock of the machine, and no monotonic one. Single-threaded.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "services/fleetctl/soak/host_faults/clock_shift.h"

namespace giveway::fleetctl {

// The library to be preloaded, found next to the programs; empty if it is missing.
std::filesystem::path ClockStepLibrary();

class SteppableClock {
 public:
  // Creates or truncates `file`; the clock is not stepped. Throws StartError.
  explicit SteppableClock(const std::filesystem::path& file);
  ~SteppableClock();
  SteppableClock(SteppableClock&& other) noexcept;
  SteppableClock& operator=(SteppableClock&&) = delete;

  // The environment of the process, NAME=value each.
  std::vector<std::string> Environment() const;
  void Step(std::int64_t offset_s) { shift_->offset_s = offset_s; }
  // Readings of the clock that were shifted since its creation.
  std::uint64_t Shifted() const { return shift_->shifted; }

 private:
  std::string file_;
  ClockShift* shift_ = nullptr;  // mapped; null once moved from
};

}  // namespace giveway::fleetctl
