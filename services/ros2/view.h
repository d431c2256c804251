// The fleet as a ROS 2 graph sees it: takes samples as they come, and at a fixed rate gives the
// messages of what is new. Of every vehicle the newest sample between two times due; every firing
// of an ultrasonic at most once. Bounded; pure: the time is an argument.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "services/ros2/messages.h"
#include "services/types/beacon.h"
#include "services/types/motor_command.h"
#include "services/types/range_scan.h"
#include "services/types/robot_model.h"

namespace giveway::ros2 {

// Both since 1970.
struct Times {
  std::uint64_t stamp_ns =
      0;  // when the sample was made, by its writer's clock where that is known
  std::uint64_t received_ns = 0;  // by the clock that Collect is asked with
};

// What is due at one time.
struct Batch {
  std::vector<Message> messages;
  std::vector<VehicleId> gone;  // vehicles of which nothing more comes; their markers are deleted
};

class View {
 public:
  static constexpr double kUsualRate_hz = 10;
  static constexpr std::uint64_t kSilentAfter_ns = 1'000'000'000;  // as on the page
  static constexpr std::uint64_t kGoneAfter_ns = 3'000'000'000;
  // How often transforms that do not change are repeated: the later parts of a recording have them.
  static constexpr std::uint64_t kStaticPeriod_ns = 10'000'000'000;
  // Beyond it vehicles that come are not shown.
  static constexpr std::size_t kMostVehicles = 256;

  using ProfileOf = std::function<RobotModel(VehicleId)>;

  // `profile` is asked once a vehicle, for where its ultrasonics sit.
  View(double rate_hz, ProfileOf profile);

  // Samples without an id and beacons with numbers that cannot be shown are left out.
  void Take(const Beacon& beacon, Times at);
  void Take(const RangeScan& scan, Times at);
  void Take(const MotorCommand& command, Times at);

  // Nothing where it is not yet time.
  Batch Collect(std::uint64_t now_ns);

 private:
  template <typename Sample>
  struct Stamped {
    Sample sample;
    std::uint64_t stamp_ns = 0;
  };
  struct Firing {
    Tick tick = kNoTick;
    std::uint64_t stamp_ns = 0;
    std::optional<RangeReading> fresh;  // not sent yet
  };
  struct Vehicle {
    RobotModel profile;
    std::optional<Stamped<Beacon>> beacon;
    bool beacon_is_new = false;
    std::optional<Stamped<MotorCommand>> command;  // not sent yet
    std::array<Firing, kSensorCount> firings{};
    std::uint64_t beacon_received_ns = 0;
    std::uint64_t heard_ns = 0;  // anything of it
  };

  Vehicle* Known(VehicleId id, std::uint64_t received_ns);
  bool IsDue(std::uint64_t now_ns);
  void AddOf(VehicleId id, Vehicle* vehicle, Batch* batch) const;
  void AddTransforms(Batch* batch) const;
  void AddMarkers(std::uint64_t now_ns, Batch* batch) const;
  void AddStatic(std::uint64_t now_ns, Batch* batch);
  void RemoveGone(std::uint64_t now_ns, Batch* batch);

  const std::uint64_t period_ns_;
  const ProfileOf profile_;
  std::map<VehicleId, Vehicle> vehicles_;
  std::uint64_t due_ns_ = 0;
  std::uint64_t static_due_ns_ = 0;
  bool has_newcomer_ = false;
};

}  // namespace giveway::ros2
