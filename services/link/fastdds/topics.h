// The topics of the fleet: what each is called, what travels on it, and which profiles of the QoS
// file its endpoints take. Partitions, noted below, are chosen where an endpoint is made.
#pragma once

#include <cstddef>

#include "services/link/fastdds/fastdds_version.h"

namespace giveway::link {

template <typename Wire>
struct TopicOf;

// Every topic: type, name, profile, and how many uint32 its key is, which stand first in a sample;
// 0 without a key.
// - From each vehicle: beacons in <area>/v<id>, motor commands and status in v<id>, joins in fleet.
//   Keyed by vehicle, joins by session.
// - Between an operator and a vehicle, in its partition v<id>: orders, answers. Keyed by vehicle.
// - From the world to one vehicle, in its partition v<id>, but for ranges only where fitted: scans
//   and pose fixes. Keyed by vehicle.
// - From the world to all, in the partition world. The roster is keyed by session, signals by their
//   head. Truth (keyed by vehicle), events and figures are read by observers only.
#define GIVEWAY_TOPICS(TOPIC)                                          \
  TOPIC(Beacon, "fleet/beacon", "fleet_beacon", 1)                     \
  TOPIC(MotorCommand, "fleet/motor_command", "fleet_motor_command", 1) \
  TOPIC(Status, "fleet/status", "fleet_status", 1)                     \
  TOPIC(Join, "fleet/join", "fleet_join", 4)                           \
  TOPIC(Order, "fleet/admin", "fleet_admin", 1)                        \
  TOPIC(Answer, "fleet/answer", "fleet_answer", 1)                     \
  TOPIC(RangeScan, "world/ranges", "world_ranges", 1)                  \
  TOPIC(RadarScan, "world/radar", "world_radar", 1)                    \
  TOPIC(LidarScan, "world/lidar", "world_lidar", 1)                    \
  TOPIC(CameraScan, "world/camera", "world_camera", 1)                 \
  TOPIC(PoseFix, "world/pose_fix", "world_pose_fix", 1)                \
  TOPIC(Roster, "world/roster", "world_roster", 4)                     \
  TOPIC(SignalState, "world/signal", "world_signal", 1)                \
  TOPIC(Truth, "world/truth", "world_truth", 1)                        \
  TOPIC(Event, "world/event", "world_event", 0)                        \
  TOPIC(Figures, "world/figures", "world_figures", 0)

#define GIVEWAY_TOPIC(wire_type, topic_name, profile, key_numbers)     \
  template <>                                                          \
  struct TopicOf<wire::wire_type> {                                    \
    using Type = CheckedType<wire::wire_type##PubSubType>;             \
    static constexpr const char* kName = topic_name;                   \
    static constexpr const char* kType = "giveway::wire::" #wire_type; \
    static constexpr const char* kWriter = profile "_writer";          \
    static constexpr const char* kReader = profile "_reader";          \
    static constexpr std::size_t kKeyNumbers = key_numbers;            \
  };
GIVEWAY_TOPICS(GIVEWAY_TOPIC)
#undef GIVEWAY_TOPIC

// Of what the world says to all.
inline constexpr char kWorldPartition[] = "world";

// Events have no key, so one history holds the whole fleet's: enough for an observer that comes at
// the end of a scenario, and for one that drains once a second.
constexpr std::int32_t EventDepth(std::uint32_t fleet_size) {
  return static_cast<std::int32_t>(256 + 32 * fleet_size);
}

}  // namespace giveway::link
