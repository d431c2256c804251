#include "tests/link/foreign/foreign.h"

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "services/link/convert/convert.h"
#include "services/types/check.h"

namespace giveway::test {
namespace {

std::string OnLoopback(std::size_t fragment_bytes) {
  std::string fragments;
  if (fragment_bytes > 0) {
    fragments = "<FragmentSize>" + std::to_string(fragment_bytes) + "B</FragmentSize>";
  }
  return "<CycloneDDS><Domain><General><Interfaces>"
         "<NetworkInterface name=\"lo\" multicast=\"true\"/>"
         "</Interfaces>" +
         fragments + "</General></Domain></CycloneDDS>";
}

// How Cyclone walks the struct; what its IDL compiler would write.
constexpr std::uint32_t kField = DDS_OP_ADR;
constexpr std::uint32_t kWhole = kField | std::uint32_t{DDS_OP_TYPE_4BY};
constexpr std::uint32_t kReal = kField | std::uint32_t{DDS_OP_TYPE_8BY} | DDS_OP_FLAG_FP;
constexpr std::uint32_t kEnum =
    kField | std::uint32_t{DDS_OP_TYPE_ENU} | (2U << DDS_OP_FLAG_SZ_SHIFT);
constexpr std::uint32_t kLastMode = 3;
constexpr std::uint32_t kLastRule = 17;

// clang-format off
#define AT(member) static_cast<std::uint32_t>(offsetof(ForeignBeacon, member))
constexpr std::array kOps = {
    kWhole | DDS_OP_FLAG_KEY, AT(vehicle),
    kWhole, AT(boot_epoch),
    kWhole, AT(seq),
    kWhole, AT(world_epoch),
    kWhole, AT(tick),
    kReal, AT(left_rad_s),
    kReal, AT(right_rad_s),
    kReal, AT(cruise_m_s),
    kReal, AT(x_m),
    kReal, AT(y_m),
    kReal, AT(heading_rad),
    kReal, AT(xx_m2),
    kReal, AT(xy_m2),
    kReal, AT(yy_m2),
    kReal, AT(xh_m_rad),
    kReal, AT(yh_m_rad),
    kReal, AT(hh_rad2),
    kReal, AT(body_radius_m),
    kReal, AT(wheel_radius_m),
    kReal, AT(axle_m),
    kReal, AT(acceleration_m_s2),
    kReal, AT(deceleration_m_s2),
    kReal, AT(toward_x_m),
    kReal, AT(toward_y_m),
    kEnum, AT(mode), kLastMode,
    kEnum, AT(rule), kLastRule,
    kWhole, AT(gives_way_to),
    kWhole, AT(blocked_by),
    kWhole, AT(order_waited_ticks),
    kWhole, AT(order_speed_bucket),
    kWhole, AT(order_vehicle),
    kWhole, AT(crc),
    std::uint32_t{DDS_OP_RTS},
    DDS_OP_KOF | 1U, 0U,  // the key: one step, at the first instruction
};
#undef AT
// clang-format on
constexpr std::uint32_t kKeyAt = kOps.size() - 2;
constexpr std::uint32_t kInstructions = 35;  // those with an address, the end, the key

constexpr std::array kKeys = {dds_key_descriptor_t{"vehicle", kKeyAt, 0}};

constexpr std::array kStatusOps = {
    kWhole | DDS_OP_FLAG_KEY,
    static_cast<std::uint32_t>(offsetof(ForeignStatus, vehicle)),
    kWhole,
    static_cast<std::uint32_t>(offsetof(ForeignStatus, world_epoch)),
    kWhole,
    static_cast<std::uint32_t>(offsetof(ForeignStatus, tick)),
    std::uint32_t{DDS_OP_RTS},
    DDS_OP_KOF | 1U,
    0U,
};
constexpr std::uint32_t kStatusInstructions = 5;
constexpr std::array kStatusKeys = {dds_key_descriptor_t{"vehicle", kStatusOps.size() - 2, 0}};

const dds_topic_descriptor_t& StatusDescriptor() {
  static const dds_topic_descriptor_t descriptor = {sizeof(ForeignStatus),
                                                    alignof(ForeignStatus),
                                                    DDS_TOPIC_FIXED_KEY | DDS_TOPIC_FIXED_SIZE,
                                                    kStatusKeys.size(),
                                                    "giveway::wire::Status",
                                                    kStatusKeys.data(),
                                                    kStatusInstructions,
                                                    kStatusOps.data(),
                                                    "",
                                                    {},
                                                    {},
                                                    0};
  return descriptor;
}

const dds_topic_descriptor_t& Descriptor() {
  static const dds_topic_descriptor_t descriptor = {sizeof(ForeignBeacon),
                                                    alignof(ForeignBeacon),
                                                    DDS_TOPIC_FIXED_KEY | DDS_TOPIC_FIXED_SIZE,
                                                    kKeys.size(),
                                                    "giveway::wire::Beacon",
                                                    kKeys.data(),
                                                    kInstructions,
                                                    kOps.data(),
                                                    "",
                                                    {},
                                                    {},
                                                    0};
  return descriptor;
}

struct DeleteQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, DeleteQos>;

Qos EndpointQos(const ForeignQos& asked) {
  Qos qos(dds_create_qos());
  const auto kind = asked.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT;
  dds_qset_reliability(qos.get(), kind, DDS_MSECS(100));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 16);
  dds_qset_deadline(qos.get(),
                    asked.deadline_ms == 0 ? DDS_INFINITY : DDS_MSECS(asked.deadline_ms));
  dds_qset_liveliness(qos.get(), asked.liveliness,
                      asked.lease_ms == 0 ? DDS_INFINITY : DDS_MSECS(asked.lease_ms));
  const std::vector<char> user_data(asked.user_data_bytes, 'u');
  if (!user_data.empty()) dds_qset_userdata(qos.get(), user_data.data(), user_data.size());
  return qos;
}

// Of a publisher or subscriber, where the partition belongs.
Qos GroupQos(const ForeignQos& asked) {
  Qos qos(dds_create_qos());
  if (asked.partition) dds_qset_partition1(qos.get(), asked.partition->c_str());
  return qos;
}

dds_entity_t Made(dds_entity_t entity) {
  GIVEWAY_CHECK(entity > 0, dds_strretcode(entity));
  return entity;
}

}  // namespace

ForeignBeacon ForeignFrom(const Beacon& beacon) {
  const wire::Beacon sent = link::ToWire(beacon);
  return {sent.vehicle(),
          sent.boot_epoch(),
          sent.seq(),
          sent.world_epoch(),
          sent.tick(),
          sent.left_rad_s(),
          sent.right_rad_s(),
          sent.cruise_m_s(),
          sent.world_from_body().x_m(),
          sent.world_from_body().y_m(),
          sent.world_from_body().heading_rad(),
          sent.covariance().xx_m2(),
          sent.covariance().xy_m2(),
          sent.covariance().yy_m2(),
          sent.covariance().xh_m_rad(),
          sent.covariance().yh_m_rad(),
          sent.covariance().hh_rad2(),
          sent.body_radius_m(),
          sent.wheel_radius_m(),
          sent.axle_m(),
          sent.acceleration_m_s2(),
          sent.deceleration_m_s2(),
          sent.toward_x_m(),
          sent.toward_y_m(),
          static_cast<std::uint32_t>(sent.mode()),
          static_cast<std::uint32_t>(sent.rule()),
          sent.gives_way_to(),
          sent.blocked_by(),
          sent.order_waited_ticks(),
          sent.order_speed_bucket(),
          sent.order_vehicle(),
          sent.crc()};
}

ForeignParticipant::ForeignParticipant(std::uint32_t domain, std::size_t fragment_bytes)
    : domain_(Made(dds_create_domain(domain, OnLoopback(fragment_bytes).c_str()))),
      participant_(Made(dds_create_participant(domain, nullptr, nullptr))),
      topic_(
          Made(dds_create_topic(participant_, &Descriptor(), "fleet/beacon", nullptr, nullptr))) {}

ForeignParticipant::~ForeignParticipant() {
  dds_delete(participant_);
  dds_delete(domain_);
}

dds_entity_t ForeignParticipant::MakeReader(const ForeignQos& requested) {
  const auto subscriber =
      Made(dds_create_subscriber(participant_, GroupQos(requested).get(), nullptr));
  return Made(dds_create_reader(subscriber, topic_, EndpointQos(requested).get(), nullptr));
}

dds_entity_t ForeignParticipant::MakeWriter(const ForeignQos& offered) {
  const auto publisher = Made(dds_create_publisher(participant_, GroupQos(offered).get(), nullptr));
  return Made(dds_create_writer(publisher, topic_, EndpointQos(offered).get(), nullptr));
}

dds_entity_t ForeignParticipant::MakeStatusReader() {
  const ForeignQos asked{
      .partition = "v*", .liveliness = DDS_LIVELINESS_AUTOMATIC, .reliable = true};
  const auto topic =
      Made(dds_create_topic(participant_, &StatusDescriptor(), "fleet/status", nullptr, nullptr));
  const auto subscriber = Made(dds_create_subscriber(participant_, GroupQos(asked).get(), nullptr));
  return Made(dds_create_reader(subscriber, topic, EndpointQos(asked).get(), nullptr));
}

std::vector<ForeignStatus> TakeStatuses(dds_entity_t reader) {
  std::vector<ForeignStatus> taken;
  for (;;) {
    ForeignStatus sample{};
    void* at = &sample;
    dds_sample_info_t info{};
    if (dds_take(reader, &at, &info, 1, 1) != 1) return taken;
    if (info.valid_data) taken.push_back(sample);
  }
}

std::vector<ForeignSample> Take(dds_entity_t reader) {
  std::vector<ForeignSample> taken;
  for (;;) {
    ForeignSample sample;
    void* at = &sample.beacon;
    dds_sample_info_t info{};
    if (dds_take(reader, &at, &info, 1, 1) != 1) return taken;
    sample.valid = info.valid_data;
    sample.alive = info.instance_state == DDS_IST_ALIVE;
    sample.instance = info.instance_handle;
    taken.push_back(sample);
  }
}

bool Write(dds_entity_t writer, const ForeignBeacon& beacon) {
  return dds_write(writer, &beacon) == DDS_RETCODE_OK;
}

}  // namespace giveway::test
