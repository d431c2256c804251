#include "services/qos/deployment.h"

#include <algorithm>
#include <array>

namespace giveway::qos {
namespace {

// As services/link/fastdds/topics.h names them; tests/link/qos_resolved_test.cc holds the two
// together.
constexpr std::array kTopics = {
    Topic{.name = "fleet/beacon",
          .stem = "fleet_beacon",
          .written_in = "<area>/v<id>",
          .read_in = "<area>/*",
          .ticks = 1,
          .guarded = true,
          .lively = true,
          .reader_depth = 2},
    Topic{.name = "fleet/motor_command",
          .stem = "fleet_motor_command",
          .written_in = "v<id>",
          .read_in = "v*",
          .ticks = 1,
          .reader_depth = 2},
    Topic{.name = "fleet/status", .stem = "fleet_status", .written_in = "v<id>", .read_in = "v*"},
    Topic{.name = "fleet/admin",
          .stem = "fleet_admin",
          .written_in = "v<id>",
          .read_in = "v<id>",
          .keyed = Keyed::kByVehicleReaderOne},
    Topic{.name = "fleet/answer",
          .stem = "fleet_answer",
          .written_in = "v<id>",
          .read_in = "v*",
          .late_joiners = true,
          .reader_depth = 2},
    Topic{.name = "fleet/join",
          .stem = "fleet_join",
          .written_in = "fleet",
          .read_in = "fleet",
          .late_joiners = true},
    Topic{.name = "world/ranges",
          .stem = "world_ranges",
          .written_in = "v<id>",
          .read_in = "v<id>",
          .keyed = Keyed::kByVehicleReaderOne,
          .ticks = 1,
          .guarded = true,
          .lively = true},
    Topic{.name = "world/radar",
          .stem = "world_radar",
          .written_in = "v<id>",
          .read_in = "v<id>",
          .keyed = Keyed::kByVehicleReaderOne,
          .ticks = 1},
    Topic{.name = "world/lidar",
          .stem = "world_lidar",
          .written_in = "v<id>",
          .read_in = "v<id>",
          .keyed = Keyed::kByVehicleReaderOne,
          .ticks = 1},
    Topic{.name = "world/camera",
          .stem = "world_camera",
          .written_in = "v<id>",
          .read_in = "v<id>",
          .keyed = Keyed::kByVehicleReaderOne,
          .ticks = 1},
    Topic{.name = "world/pose_fix",
          .stem = "world_pose_fix",
          .written_in = "v<id>",
          .read_in = "v<id>",
          .keyed = Keyed::kByVehicleReaderOne},
    Topic{.name = "world/signal",
          .stem = "world_signal",
          .written_in = "world",
          .read_in = "world",
          .keyed = Keyed::kBySignal,
          .ticks = 2},
    Topic{.name = "world/roster",
          .stem = "world_roster",
          .written_in = "world",
          .read_in = "world",
          .late_joiners = true,
          .reader_depth = 2},
    Topic{.name = "world/truth",
          .stem = "world_truth",
          .written_in = "world",
          .read_in = "world",
          .ticks = 1},
    Topic{.name = "world/event",
          .stem = "world_event",
          .written_in = "world",
          .read_in = "world",
          .keyed = Keyed::kNot,
          .late_joiners = true},
    Topic{.name = "world/figures",
          .stem = "world_figures",
          .written_in = "world",
          .read_in = "world",
          .keyed = Keyed::kNot,
          .late_joiners = true},
};

}  // namespace

std::span<const Topic> FleetTopics() { return kTopics; }

const Topic* TopicOfProfile(std::string_view profile) {
  const auto found = std::ranges::find_if(kTopics, [&](const Topic& topic) {
    const std::string stem(topic.stem);
    return profile == stem + "_writer" || profile == stem + "_reader";
  });
  return found == kTopics.end() ? nullptr : &*found;
}

std::int64_t Instances(const Topic& topic, Owner owner, const Deployment& deployment) {
  switch (topic.keyed) {
    case Keyed::kNot:
      return 1;
    case Keyed::kBySignal:
      return std::max<std::int64_t>(deployment.signals, 1);
    case Keyed::kByVehicleReaderOne:
      return 1;
    case Keyed::kByVehicle:
      break;
  }
  // A vehicle writes about itself alone; the world writes about all.
  const bool about_itself = owner == Owner::kWriter && topic.name.starts_with("fleet/");
  return about_itself ? 1 : deployment.vehicles;
}

std::int64_t Period(const Topic& topic, const Deployment& deployment) {
  return topic.ticks * deployment.tick_ns;
}

}  // namespace giveway::qos
