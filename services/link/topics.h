// The topics of the fleet: what each is called, what travels on it, and which profiles of the QoS
// file its endpoints take. Partitions are chosen where an endpoint is made.
#pragma once

#include "services/link/fastdds_version.h"

namespace giveway::link {

template <typename Wire>
struct TopicOf;

#define GIVEWAY_TOPIC(wire_type, topic_name, profile)         \
  template <>                                                 \
  struct TopicOf<wire::wire_type> {                           \
    using Type = CheckedType<wire::wire_type##PubSubType>;    \
    static constexpr const char* kName = topic_name;          \
    static constexpr const char* kWriter = profile "_writer"; \
    static constexpr const char* kReader = profile "_reader"; \
  }

GIVEWAY_TOPIC(Beacon, "fleet/beacon", "fleet_beacon");
GIVEWAY_TOPIC(MotorCommand, "fleet/motor_command", "fleet_motor_command");
GIVEWAY_TOPIC(Status, "fleet/status", "fleet_status");
GIVEWAY_TOPIC(Join, "fleet/join", "fleet_join");
GIVEWAY_TOPIC(RangeScan, "world/ranges", "world_ranges");
GIVEWAY_TOPIC(Roster, "world/roster", "world_roster");
GIVEWAY_TOPIC(Truth, "world/truth", "world_truth");
GIVEWAY_TOPIC(Event, "world/event", "world_event");
GIVEWAY_TOPIC(Figures, "world/figures", "world_figures");

#undef GIVEWAY_TOPIC

// Events have no key, so one history holds the whole fleet's: enough for an observer that comes at
// the end of a scenario, and for one that drains once a second.
constexpr std::int32_t EventDepth(std::uint32_t fleet_size) {
  return static_cast<std::int32_t>(256 + 32 * fleet_size);
}

}  // namespace giveway::link
