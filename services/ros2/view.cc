#include "services/ros2/view.h"

#include <algorithm>
#include <utility>

#include "services/ros2/conversion.h"

namespace giveway::ros2 {
namespace {

constexpr double kSecond_ns = 1e9;

std::uint64_t Between(std::uint64_t earlier, std::uint64_t later) {
  return later > earlier ? later - earlier : 0;
}

}  // namespace

View::View(double rate_hz, ProfileOf profile)
    : period_ns_(static_cast<std::uint64_t>(kSecond_ns / rate_hz)), profile_(std::move(profile)) {}

View::Vehicle* View::Known(VehicleId id, std::uint64_t received_ns) {
  if (id == kNoVehicle) return nullptr;
  auto known = vehicles_.find(id);
  if (known == vehicles_.end()) {
    if (vehicles_.size() >= kMostVehicles) return nullptr;
    known = vehicles_.emplace(id, Vehicle{}).first;
    known->second.profile = profile_(id);
    has_newcomer_ = true;
  }
  known->second.heard_ns = received_ns;
  return &known->second;
}

void View::Take(const Beacon& beacon, Times at) {
  if (!CanShow(beacon)) return;
  Vehicle* const vehicle = Known(beacon.vehicle, at.received_ns);
  if (vehicle == nullptr) return;
  vehicle->beacon = {beacon, at.stamp_ns};
  vehicle->beacon_received_ns = at.received_ns;
  vehicle->beacon_is_new = true;
}

void View::Take(const RangeScan& scan, Times at) {
  Vehicle* const vehicle = Known(scan.vehicle, at.received_ns);
  if (vehicle == nullptr) return;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    const RangeReading& reading = scan.readings[i];
    Firing& firing = vehicle->firings[i];
    if (reading.kind == Echo::kNoData || reading.tick == firing.tick) continue;
    const auto before_ns =
        static_cast<std::uint64_t>(std::max(reading.fired_before_s, 0.0) * kSecond_ns);
    firing = {reading.tick, Between(before_ns, at.stamp_ns), reading};
  }
}

void View::Take(const MotorCommand& command, Times at) {
  Vehicle* const vehicle = Known(command.vehicle, at.received_ns);
  if (vehicle != nullptr) vehicle->command = {command, at.stamp_ns};
}

// On a fixed grid, so that a loop with turns of its own keeps the rate; after a pause, or a step of
// the clock, the grid starts again.
bool View::IsDue(std::uint64_t now_ns) {
  const bool clock_stepped = due_ns_ > now_ns + period_ns_;
  if (now_ns < due_ns_ && !clock_stepped) return false;
  due_ns_ += period_ns_;
  if (due_ns_ <= now_ns || clock_stepped) due_ns_ = now_ns + period_ns_;
  return true;
}

void View::AddOf(VehicleId id, Vehicle* vehicle, Batch* batch) const {
  const std::string topic = Namespace(id);
  if (vehicle->beacon && vehicle->beacon_is_new) {
    const auto& [beacon, stamp_ns] = *vehicle->beacon;
    batch->messages.push_back({topic + "odom", stamp_ns, OdometryOf(beacon, stamp_ns)});
  }
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    Firing& firing = vehicle->firings[i];
    if (!firing.fresh) continue;
    batch->messages.push_back({topic + "ultrasonics", firing.stamp_ns,
                               RangeOf(id, vehicle->profile, i, *firing.fresh, firing.stamp_ns)});
    firing.fresh.reset();
  }
  // What wheel rates mean is in its beacons.
  if (vehicle->command && vehicle->beacon) {
    const auto& [command, stamp_ns] = *vehicle->command;
    batch->messages.push_back(
        {topic + "cmd_vel", stamp_ns, TwistOf(vehicle->beacon->sample.drive, command.target)});
    vehicle->command.reset();
  }
}

void View::AddTransforms(Batch* batch) const {
  Transforms all;
  std::uint64_t newest_ns = 0;
  for (const auto& [id, vehicle] : vehicles_) {
    if (!vehicle.beacon || !vehicle.beacon_is_new) continue;
    const auto& [beacon, stamp_ns] = *vehicle.beacon;
    all.transforms.push_back(BodyTransform(beacon, stamp_ns));
    newest_ns = std::max(newest_ns, stamp_ns);
  }
  if (!all.transforms.empty()) batch->messages.push_back({"/tf", newest_ns, std::move(all)});
}

void View::AddMarkers(std::uint64_t now_ns, Batch* batch) const {
  // Longer than until the next one, however slow the rate.
  const std::uint64_t lifetime_ns = std::max(kGoneAfter_ns, 2 * period_ns_);
  const auto lifetime_s = static_cast<std::int32_t>((lifetime_ns + 999'999'999) / 1'000'000'000);
  Markers all;
  std::uint64_t newest_ns = 0;
  for (const VehicleId id : batch->gone) all.markers.push_back(RemovedMarker(id, now_ns));
  if (!all.markers.empty()) newest_ns = now_ns;
  for (const auto& [id, vehicle] : vehicles_) {
    if (!vehicle.beacon) continue;
    const auto& [beacon, stamp_ns] = *vehicle.beacon;
    const bool silent = Between(vehicle.beacon_received_ns, now_ns) > kSilentAfter_ns;
    all.markers.push_back(BodyMarker(beacon, stamp_ns, silent, lifetime_s));
    newest_ns = std::max(newest_ns, stamp_ns);
  }
  if (!all.markers.empty()) {
    batch->messages.push_back({"/giveway/markers", newest_ns, std::move(all)});
  }
}

void View::AddStatic(std::uint64_t now_ns, Batch* batch) {
  const bool clock_stepped = static_due_ns_ > now_ns + kStaticPeriod_ns;
  if (!has_newcomer_ && now_ns < static_due_ns_ && !clock_stepped) return;
  has_newcomer_ = false;
  static_due_ns_ = now_ns + kStaticPeriod_ns;
  Transforms all;
  for (const auto& [id, vehicle] : vehicles_) {
    for (std::size_t i = 0; i < kSensorCount; ++i) {
      all.transforms.push_back(SensorTransform(id, vehicle.profile, i, now_ns));
    }
  }
  if (!all.transforms.empty()) batch->messages.push_back({"/tf_static", now_ns, std::move(all)});
}

void View::RemoveGone(std::uint64_t now_ns, Batch* batch) {
  std::erase_if(vehicles_, [&](const auto& known) {
    if (Between(known.second.heard_ns, now_ns) <= kGoneAfter_ns) return false;
    batch->gone.push_back(known.first);
    return true;
  });
}

Batch View::Collect(std::uint64_t now_ns) {
  Batch batch;
  if (!IsDue(now_ns)) return batch;
  RemoveGone(now_ns, &batch);
  AddStatic(now_ns, &batch);
  for (auto& [id, vehicle] : vehicles_) AddOf(id, &vehicle, &batch);
  AddTransforms(&batch);
  AddMarkers(now_ns, &batch);
  for (auto& [id, vehicle] : vehicles_) vehicle.beacon_is_new = false;
  return batch;
}

}  // namespace giveway::ros2
