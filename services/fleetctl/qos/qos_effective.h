// The effective QoS, value by value, and where each comes from: what the library made of the
// profiles, joined with the file's lines.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/link/resolved_qos.h"
#include "services/qos/profile_set.h"

namespace giveway::fleetctl {

enum class QosOrigin : std::uint8_t {
  kProfile,      // set by the file
  kDefault,      // not set: the library's
  kCode,         // follows from fleet size, area or id
  kEnvironment,  // a GIVEWAY_ variable
  kFlag,         // of this command line
  kDiscovered,   // of a foreign vehicle: as reported by discovery
};
std::string Name(QosOrigin origin);

struct QosRow {
  std::string policy;
  std::string value;  // in readable form
  QosOrigin origin = QosOrigin::kDefault;
  int line = 0;  // of kProfile; 0: not known
};

struct EffectiveEndpoint {
  std::string profile;
  std::string topic;  // empty for the participant
  std::vector<QosRow> rows;
};

// A value that is neither the file's nor the library's default was set by code.
std::vector<EffectiveEndpoint> EffectiveQos(const std::vector<link::ResolvedEntity>& resolved,
                                            const qos::ProfileSet& set);

struct EffectiveSet {
  std::string file;
  std::string text;                          // of the file
  std::vector<EffectiveEndpoint> endpoints;  // the participant first
};

// Of a profile file, or of the shipped set of that name, in a fleet of that size. Throws LinkError.
EffectiveSet EffectiveQosOfFile(const std::string& argument, const std::string& interface,
                                std::uint32_t vehicles);

// "config/qos/default.xml:84", "library default", "code".
std::string OriginText(const QosRow& row, const std::string& file);

}  // namespace giveway::fleetctl
