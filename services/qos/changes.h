// What changes for a running process that takes other profiles, value by value, and whether that
// takes a restart.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "services/qos/profile_set.h"
#include "services/qos/xml_tree.h"

namespace giveway::qos {

enum class Effect : std::uint8_t {
  kNow,      // the library takes it while the endpoint runs
  kRestart,  // fixed once the endpoint or the participant is made
};

struct Change {
  std::string profile;  // or "transport giveway_udp", "library_settings"
  std::string what;     // a policy's name; of all else the path of the element
  std::string from;     // as a person writes it; empty: not said
  std::string to;
  Effect effect = Effect::kRestart;
  std::int64_t number = 0;  // the new value, of a policy
  std::int64_t before = 0;  // the former one
};

// Profiles in the order of their names. A value that is only written down differently, as a default
// that the other file leaves out, is no change.
std::vector<Change> Changes(const XmlElement& from, const XmlElement& to);
// Those of them that no policy of an endpoint or participant holds: transports, buffers, discovery
// servers, the library's settings.
std::vector<Change> ChangesElsewhere(const XmlElement& from, const XmlElement& to);

// Which endpoints a process has.
enum class Role : std::uint8_t { kVehicle, kWorld, kOperator };

// Whether a process of that role makes an endpoint of the profile; true of all that is no endpoint.
bool Concerns(Role role, std::string_view profile);
// Those that concern it.
std::vector<Change> ChangesFor(Role role, std::vector<Change> changes);

bool NeedsRestart(const std::vector<Change>& changes);

}  // namespace giveway::qos
