// Recorded samples to ROS 2 messages of the same recording.
#include "services/observer/ros2/ros2_samples.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "services/link/sample_codec.h"
#include "services/mcap/mcap_reader.h"
#include "services/observer/capture/fleet_capture.h"

namespace giveway {
namespace {

constexpr std::uint64_t kReceived_ns = 1'700'000'000'000'000'000;

link::RawSample RawBeacon(std::uint32_t vehicle, std::uint64_t ms) {
  Beacon beacon;
  beacon.vehicle = VehicleId{vehicle};
  beacon.boot_epoch = 1;
  beacon.seq = 1;
  return {.topic = RawTopicNamed("fleet/beacon"),
          .source_ns = kReceived_ns + ms * 1'000'000 - 7,
          .reception_ns = kReceived_ns + ms * 1'000'000,
          .sequence = 1,
          .bytes = link::Encode(beacon)};
}

const Ros2Sample* Find(const std::vector<Ros2Sample>& samples, const std::string& topic) {
  const auto found = std::ranges::find(samples, topic, &Ros2Sample::topic);
  return found == samples.end() ? nullptr : &*found;
}

TEST(Ros2Samples, ABeaconIsOdometryStampedByItsWriterAndLoggedByItsReception) {
  Ros2Samples samples(10);
  const auto due = samples.Take(RawBeacon(7, 0));
  const Ros2Sample* odometry = Find(due, "/giveway/v7/odom");
  ASSERT_NE(odometry, nullptr);
  EXPECT_EQ(odometry->type, "nav_msgs/msg/Odometry");
  EXPECT_EQ(odometry->stamp_ns, kReceived_ns - 7);
  EXPECT_EQ(odometry->log_ns, kReceived_ns);
  // CDR, little-endian; then the seconds of the stamp: one below those of the reception.
  ASSERT_GT(odometry->bytes.size(), 700U);
  EXPECT_EQ(odometry->bytes.substr(0, 4), std::string("\0\1\0\0", 4));
  std::uint32_t sec = 0;
  std::copy_n(odometry->bytes.data() + 4, sizeof sec, reinterpret_cast<char*>(&sec));
  EXPECT_EQ(sec, 1'699'999'999U);
  EXPECT_NE(Find(due, "/tf_static"), nullptr);
  EXPECT_NE(Find(due, "/giveway/markers"), nullptr);
  EXPECT_EQ(samples.Take(RawBeacon(7, 50)).size(), 0U);  // not due
  EXPECT_NE(Find(samples.Take(RawBeacon(7, 100)), "/giveway/v7/odom"), nullptr);
}

TEST(Ros2Samples, BytesThatAreNoBeaconAreLeftOut) {
  Ros2Samples samples(10);
  link::RawSample corrupted = RawBeacon(7, 0);
  corrupted.bytes[40] ^= 1;  // the check sum does not fit
  EXPECT_TRUE(samples.Take(corrupted).empty());
  corrupted.bytes.resize(30);
  EXPECT_TRUE(samples.Take(corrupted).empty());
}

TEST(Ros2Samples, ARecordingNamesTheProfileAndHasOneSchemaForTopicsOfOneType) {
  std::string file;
  FleetCapture capture(
      [&file](std::string_view bytes) {
        file += bytes;
        return true;
      },
      {}, "ros2");
  Ros2Samples samples(10);
  for (const std::uint32_t vehicle : {7U, 8U}) {
    for (const Ros2Sample& sample : samples.Take(RawBeacon(vehicle, 100 * vehicle))) {
      EXPECT_TRUE(capture.Write(sample));
    }
  }
  EXPECT_TRUE(capture.Close());
  EXPECT_EQ(file.substr(17, 8), std::string("\4\0\0\0ros2", 8));  // first in the header
  std::map<std::string, std::pair<std::uint16_t, std::string>> channels;
  mcap::McapReader::Read(
      file, [&](const mcap::Message&, const mcap::Channel& channel, const mcap::Schema& schema) {
        channels[channel.topic] = {channel.schema, schema.encoding};
        EXPECT_TRUE(channel.metadata.contains("offered_qos_profiles"));
        return true;
      });
  EXPECT_EQ(channels.at("/giveway/v7/odom"), channels.at("/giveway/v8/odom"));
  EXPECT_EQ(channels.at("/tf").first, channels.at("/tf_static").first);
  EXPECT_EQ(channels.at("/tf").second, "ros2msg");
}

}  // namespace
}  // namespace giveway
