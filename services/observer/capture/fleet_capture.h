// Samples of the fleet's topics into one MCAP file: as they came, each topic a channel with
// fleet.idl as its schema, so that the field's tools decode them. Knows no files: bytes go to a
// sink.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "services/link/raw_link.h"
#include "services/mcap/mcap_writer.h"
#include "services/observer/ros2/ros2_samples.h"

namespace giveway {

// fleet.idl, as this build was made from it.
std::string FleetIdl();

// A topic's samples as a channel is described to readers, in a file and live.
struct ChannelDescription {
  std::string topic;            // "fleet/beacon"
  std::string encoding;         // of the samples: "cdr"
  std::string schema_name;      // "giveway::wire::Beacon"
  std::string schema_encoding;  // "omgidl"
};
// Of the topic at this place of link::RawTopics(). The schema's text is FleetIdl().
ChannelDescription DescribeChannel(std::size_t topic);

class FleetCapture {
 public:
  // `qos` says of a topic what its reader asked for; it becomes the channel's metadata.
  using QosOf = std::function<std::string(std::size_t topic)>;

  // `profile`: "ros2" for a file that `ros2 bag` is to take.
  FleetCapture(mcap::McapWriter::Sink sink, QosOf qos, const std::string& profile = "");

  // All false once the sink failed.
  bool Write(const link::RawSample& sample);
  bool Write(const Ros2Sample& sample);
  bool Flush() { return writer_.Flush(); }
  bool Attach(const std::string& name, std::string_view bytes, std::uint64_t log_ns);
  bool Close() { return writer_.Close(); }

  std::uint64_t Messages() const { return writer_.Messages(); }
  std::size_t Chunks() const { return writer_.Chunks(); }
  std::uint64_t Size() const { return writer_.Size() + writer_.Pending(); }

 private:
  std::uint16_t ChannelOf(std::size_t topic);
  std::uint16_t ChannelOf(const Ros2Sample& sample);

  const QosOf qos_;
  mcap::McapWriter writer_;
  std::map<std::size_t, std::uint16_t> channels_;           // by topic
  std::map<std::string_view, std::uint16_t> ros2_schemas_;  // by type
  struct Ros2Channel {
    std::uint16_t channel = 0;
    std::uint32_t sequence = 0;  // of the last message
  };
  std::map<std::string, Ros2Channel> ros2_channels_;  // by topic
};

// The place of a topic in link::RawTopics(); its size if there is none of that name.
std::size_t RawTopicNamed(std::string_view name);

}  // namespace giveway
