// The topics of the fleet: what each is called, what travels on it, and which profiles of the QoS
// file its endpoints take. Partitions, noted beside each, are chosen where an endpoint is made.
#pragma once

#include "services/link/fastdds/fastdds_version.h"

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

// Of what the world says to all.
inline constexpr char kWorldPartition[] = "world";

// From each vehicle; keyed by vehicle, joins by session.
GIVEWAY_TOPIC(Beacon, "fleet/beacon", "fleet_beacon");                      // <area>/v<id>
GIVEWAY_TOPIC(MotorCommand, "fleet/motor_command", "fleet_motor_command");  // v<id>
GIVEWAY_TOPIC(Status, "fleet/status", "fleet_status");                      // v<id>
GIVEWAY_TOPIC(Join, "fleet/join", "fleet_join");                            // fleet

// Between an operator and a vehicle, in its partition v<id>; keyed by vehicle.
GIVEWAY_TOPIC(Order, "fleet/admin", "fleet_admin");
GIVEWAY_TOPIC(Answer, "fleet/answer", "fleet_answer");

// From the world to one vehicle, in its partition v<id>; but for ranges only where fitted.
GIVEWAY_TOPIC(RangeScan, "world/ranges", "world_ranges");
GIVEWAY_TOPIC(RadarScan, "world/radar", "world_radar");
GIVEWAY_TOPIC(LidarScan, "world/lidar", "world_lidar");
GIVEWAY_TOPIC(CameraScan, "world/camera", "world_camera");
GIVEWAY_TOPIC(PoseFix, "world/pose_fix", "world_pose_fix");

// From the world to all, in the partition world.
GIVEWAY_TOPIC(Roster, "world/roster", "world_roster");       // keyed by session
GIVEWAY_TOPIC(SignalState, "world/signal", "world_signal");  // keyed by signal head
GIVEWAY_TOPIC(Truth, "world/truth", "world_truth");          // keyed by vehicle; observers only
GIVEWAY_TOPIC(Event, "world/event", "world_event");          // observers only
GIVEWAY_TOPIC(Figures, "world/figures", "world_figures");    // observers only

#undef GIVEWAY_TOPIC

// Events have no key, so one history holds the whole fleet's: enough for an observer that comes at
// the end of a scenario, and for one that drains once a second.
constexpr std::int32_t EventDepth(std::uint32_t fleet_size) {
  return static_cast<std::int32_t>(256 + 32 * fleet_size);
}

}  // namespace giveway::link
