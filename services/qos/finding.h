// What is wrong with a deployment's QoS, as a value: one finding says where, which values, what
// comes of it and what to do.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace giveway::qos {

enum class Severity : std::uint8_t {
  kWarning,  // works, but not as its author expects
  kError,    // does not start, does not match, or does not keep a promise
};

// A place in a file; line 0 is the file as a whole.
struct Place {
  std::string file;
  int line = 0;  // from 1

  bool operator==(const Place&) const = default;
};

struct Finding {
  Severity severity = Severity::kError;
  std::string rule;         // a stable name: "deadline_mismatch"
  Place place;              // where to change it
  std::string subject;      // profile or element it is about; may be empty
  std::string values;       // what was found, and what it was held against
  std::string consequence;  // one sentence
  std::string remedy;
};

using Findings = std::vector<Finding>;

}  // namespace giveway::qos
