// The result of a stopwatch as a table and as one JSON object.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/fleetctl/stopwatch/stopwatch_figures.h"

namespace giveway::fleetctl {

// What all trials together come to.
enum class StopwatchVerdict : std::uint8_t {
  kKept,        // every promise was, and every trial could be made
  kBroken,      // a promise was
  kIncomplete,  // none was, but not every trial could be made
  kNotRun,      // no trial could be made: nothing is known of any promise
};

struct StopwatchReport {
  std::string qos_file;
  std::uint32_t vehicles = 0;
  std::uint32_t fleets = 0;
  std::uint32_t seed = 0;
  double took_s = 0;
  Limits limits;
  int library_major = 2;  // of the Fast DDS that the fleets ran with
  std::vector<Cell> cells;
  std::uint32_t false_alarms = 0;
  std::vector<std::string> problems;  // trials that could not be made

  bool interrupted = false;  // by the user, with trials left: no fault of the fleets

  StopwatchVerdict Verdict() const;
  bool Kept() const { return Verdict() == StopwatchVerdict::kKept; }
};

// "kill: liveliness was seen by 3 of 12 too late, ...": a line for each promise that was broken.
std::vector<std::string> Findings(const StopwatchReport& report);
std::string StopwatchText(const StopwatchReport& report);
std::string StopwatchJson(const StopwatchReport& report);

}  // namespace giveway::fleetctl
