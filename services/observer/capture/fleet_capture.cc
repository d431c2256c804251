#include "services/observer/capture/fleet_capture.h"

#include <algorithm>
#include <utility>

#include "services/ros2/definitions.h"

namespace giveway {

FleetCapture::FleetCapture(mcap::McapWriter::Sink sink, QosOf qos, const std::string& profile)
    : qos_(std::move(qos)), writer_(std::move(sink), "giveway", profile) {}

ChannelDescription DescribeChannel(std::size_t topic) {
  const link::RawTopic& raw = link::RawTopics().at(topic);
  return {.topic = std::string(raw.name),
          .encoding = "cdr",
          .schema_name = std::string(raw.type),
          .schema_encoding = "omgidl"};
}

std::uint16_t FleetCapture::ChannelOf(std::size_t topic) {
  const auto known = channels_.find(topic);
  if (known != channels_.end()) return known->second;
  ChannelDescription described = DescribeChannel(topic);
  const std::uint16_t schema = writer_.AddSchema({.id = 0,
                                                  .name = std::move(described.schema_name),
                                                  .encoding = std::move(described.schema_encoding),
                                                  .data = FleetIdl()});
  mcap::Metadata metadata;
  const std::string qos = qos_ ? qos_(topic) : "";
  if (!qos.empty()) metadata["reader_qos"] = qos;
  const std::uint16_t channel = writer_.AddChannel({.id = 0,
                                                    .schema = schema,
                                                    .topic = std::move(described.topic),
                                                    .encoding = std::move(described.encoding),
                                                    .metadata = std::move(metadata)});
  channels_[topic] = channel;
  return channel;
}

bool FleetCapture::Write(const link::RawSample& sample) {
  return writer_.Write({.channel = ChannelOf(sample.topic),
                        .sequence = sample.sequence,
                        .log_ns = sample.reception_ns,
                        .publish_ns = sample.source_ns,
                        .data = sample.bytes});
}

std::uint16_t FleetCapture::ChannelOf(const Ros2Sample& sample) {
  auto [schema, is_new] = ros2_schemas_.try_emplace(sample.type, std::uint16_t{0});
  if (is_new) {
    schema->second = writer_.AddSchema({.id = 0,
                                        .name = std::string(sample.type),
                                        .encoding = "ros2msg",
                                        .data = ros2::DefinitionOf(sample.type)});
  }
  return writer_.AddChannel(
      {.id = 0,
       .schema = schema->second,
       .topic = sample.topic,
       .encoding = "cdr",
       .metadata = {{"offered_qos_profiles", ros2::QosProfileOf(sample.topic)}}});
}

bool FleetCapture::Write(const Ros2Sample& sample) {
  auto [known, is_new] = ros2_channels_.try_emplace(sample.topic);
  if (is_new) known->second.channel = ChannelOf(sample);
  return writer_.Write({.channel = known->second.channel,
                        .sequence = ++known->second.sequence,
                        .log_ns = sample.log_ns,
                        .publish_ns = sample.stamp_ns,
                        .data = sample.bytes});
}

bool FleetCapture::Attach(const std::string& name, std::string_view bytes, std::uint64_t log_ns) {
  return writer_.Attach(name, "application/octet-stream", bytes, log_ns);
}

std::size_t RawTopicNamed(std::string_view name) {
  const auto& topics = link::RawTopics();
  const auto found = std::ranges::find(topics, name, &link::RawTopic::name);
  return static_cast<std::size_t>(found - topics.begin());
}

}  // namespace giveway
