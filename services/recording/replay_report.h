// What replaying recordings came to, as data and as text. JSON is printed through idl/report.proto.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/recording/recording.h"
#include "services/report/report.h"

namespace giveway {

// The first step that did not come out as it was recorded.
struct ReplayDifference {
  std::uint32_t step = 0;  // counted from 1
  Tick tick = kNoTick;
  FieldDifference field;
};

// Names and meanings are those of the JSON object; see idl/report.proto.
struct ReplayedFile {
  std::string file;
  VehicleId vehicle = kNoVehicle;
  std::uint32_t steps = 0;
  std::uint32_t part = 1;
  bool complete = false;
  std::uint32_t lost = 0;
  std::string failure;
  std::optional<ReplayDifference> difference;
  std::string finding;
};

// kNotRun if a file could not be replayed to its end, else kFailed if one differs.
Verdict OverallVerdict(const std::vector<ReplayedFile>& files);

// One JSON object on one line.
std::string ToJson(const std::vector<ReplayedFile>& files);
// A line a file, and one for all.
std::string ToText(const std::vector<ReplayedFile>& files);

}  // namespace giveway
