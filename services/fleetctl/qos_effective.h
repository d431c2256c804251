// The QoS that holds, value by value, with where each comes from: what the library made of the
// profiles, joined with what the file says at which line.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/link/resolved_qos.h"
#include "services/qos/profile_set.h"

namespace giveway::fleetctl {

enum class QosOrigin : std::uint8_t {
  kProfile,      // the file says it
  kDefault,      // nobody does: the library's
  kCode,         // follows from fleet size, area or id
  kEnvironment,  // a GIVEWAY_ variable
  kFlag,         // of this command line
};
std::string Name(QosOrigin origin);

struct QosRow {
  std::string policy;
  std::string value;  // as a person writes it
  QosOrigin origin = QosOrigin::kDefault;
  int line = 0;  // of kProfile
};

struct EffectiveEndpoint {
  std::string profile;
  std::string topic;  // empty for the participant
  std::vector<QosRow> rows;
};

// A value that is neither the file's nor the library's default was set by code.
std::vector<EffectiveEndpoint> EffectiveQos(const std::vector<link::ResolvedEntity>& resolved,
                                            const qos::ProfileSet& set);

}  // namespace giveway::fleetctl
