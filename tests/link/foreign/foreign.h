// Cyclone DDS as a stranger in the fleet's domain: a reader and a writer of beacons by another
// vendor, on loopback. It knows of us only what the IDL says; its type is written here by hand, so
// that no second IDL compiler is needed.
#pragma once

#include <dds/dds.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/types/beacon.h"

namespace giveway::test {

// giveway::wire::Beacon as Cyclone lays it out; pose and covariance without structs of their own,
// which on the wire is the same.
struct ForeignBeacon {
  std::uint32_t vehicle, boot_epoch, seq, world_epoch, tick;
  double left_rad_s, right_rad_s, cruise_m_s, x_m, y_m, heading_rad, xx_m2, xy_m2, yy_m2, xh_m_rad,
      yh_m_rad, hh_rad2, body_radius_m, wheel_radius_m, axle_m, acceleration_m_s2,
      deceleration_m_s2, toward_x_m, toward_y_m;
  std::uint32_t mode, rule;
  std::uint32_t gives_way_to, blocked_by, order_waited_ticks, order_speed_bucket, order_vehicle,
      crc;
};

// As our link would say it, check sum included.
ForeignBeacon ForeignFrom(const Beacon& beacon);

// What is offered or requested; the fleet's own unless said otherwise.
struct ForeignQos {
  std::optional<std::string> partition;  // none: the default partition
  std::uint32_t deadline_ms = 0;         // 0: none
  std::uint32_t lease_ms = 0;            // 0: endless
  dds_liveliness_kind_t liveliness = DDS_LIVELINESS_MANUAL_BY_TOPIC;
  bool reliable = false;
  std::size_t user_data_bytes = 0;  // that it is announced with
};

// Ends with everything in it.
class ForeignParticipant {
 public:
  // It sends larger announcements in fragments of this size; 0: Cyclone's 1344 bytes.
  explicit ForeignParticipant(std::uint32_t domain, std::size_t fragment_bytes = 0);
  ~ForeignParticipant();
  ForeignParticipant(const ForeignParticipant&) = delete;
  ForeignParticipant& operator=(const ForeignParticipant&) = delete;
  dds_entity_t MakeReader(const ForeignQos& requested);
  dds_entity_t MakeWriter(const ForeignQos& offered);
  // Of fleet/status in all vehicles' partitions, reliable.
  dds_entity_t MakeStatusReader();

 private:
  dds_entity_t domain_ = 0;
  dds_entity_t participant_ = 0;
  dds_entity_t topic_ = 0;
};

struct ForeignSample {
  ForeignBeacon beacon{};
  bool valid = false;  // false: only the key, and that something happened to the instance
  bool alive = false;
  dds_instance_handle_t instance = 0;
};

std::vector<ForeignSample> Take(dds_entity_t reader);

// giveway::wire::Status to who knows of its first members alone: as a reader of a release long
// before.
struct ForeignStatus {
  std::uint32_t vehicle, world_epoch, tick;
};
std::vector<ForeignStatus> TakeStatuses(dds_entity_t reader);
bool Write(dds_entity_t writer, const ForeignBeacon& beacon);

}  // namespace giveway::test
