// A soak's result as report.json, through idl/soak.proto, and read back.
#pragma once

#include <string>
#include <string_view>

#include "services/fleetctl/soak/soak_result.h"

namespace giveway::fleetctl {

// One JSON object on one line, proto field names, defaults printed, absent values left out.
std::string ToJson(const SoakResult& result);

// Either a result, or a message with everything that is wrong with the text.
struct ReadSoak {
  SoakResult result;
  std::string complaint;  // empty: the result is valid
};
ReadSoak SoakFromJson(std::string_view json);
// `path` is a report.json or its folder. The complaint names the file.
ReadSoak ReadSoakReport(const std::string& path);

}  // namespace giveway::fleetctl
