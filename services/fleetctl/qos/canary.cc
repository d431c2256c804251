#include "services/fleetctl/qos/canary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace giveway::fleetctl {
namespace {

constexpr double kSigmas = 3;
constexpr double kMatters = 0.2;  // of the rest's rate
constexpr double kHour_s = 3600;

// Whether a count over `a_size` is higher than one over `b_size` can explain. The variance of a
// Poisson count is its mean, estimated from both together; one event is added, so that the estimate
// is not 0 if there are none.
bool IsMore(double a, double a_size, double b, double b_size) {
  if (a_size <= 0 || b_size <= 0) return false;
  const double rate = (a + b + 1) / (a_size + b_size);
  const double sigma = std::sqrt(rate / a_size + rate / b_size);
  const double difference = a / a_size - b / b_size;
  return difference > kSigmas * sigma && difference > kMatters * b / b_size;
}

}  // namespace

void SeenVehicles::Add(const VehicleStatus& status, SteadyTime now) {
  const auto [entry, is_new] = seen_.try_emplace(status.vehicle);
  Seen& seen = entry->second;
  const bool restarted = !is_new && status.beacons.sent < seen.last.beacons.sent;
  seen.restarted |= restarted;
  if (is_new || restarted) {
    seen.first = status;
    seen.first_at = now;
  }
  seen.last = status;
  seen.last_at = now;
}

bool SeenVehicles::Hears(VehicleId vehicle, bool since_restart) const {
  const auto seen = seen_.find(vehicle);
  return seen != seen_.end() && (!since_restart || seen->second.restarted) &&
         seen->second.last.beacons.taken > 0;
}

ServiceFigures& ServiceFigures::operator+=(const ServiceFigures& other) {
  alarms += other.alarms;
  lost += other.lost;
  taken += other.taken;
  seconds += other.seconds;
  pair_seconds += other.pair_seconds;
  return *this;
}

double ServiceFigures::AlarmsPerPairHour() const {
  return pair_seconds > 0 ? static_cast<double>(alarms) * kHour_s / pair_seconds : 0;
}

double ServiceFigures::LostShare() const {
  const std::uint64_t sent = lost + taken;
  return sent > 0 ? static_cast<double>(lost) / static_cast<double>(sent) : 0;
}

double ServiceFigures::TakenPerSecond() const {
  return seconds > 0 ? static_cast<double>(taken) / seconds : 0;
}

ServiceFigures Between(const VehicleStatus& before, const VehicleStatus& after, double seconds) {
  const auto alarms = [](const VehicleStatus& status) {
    return std::uint64_t{status.qos.deadline_missed} + status.qos.liveliness_lost;
  };
  const std::uint32_t peers = std::max(before.peers_heard, after.peers_heard);
  return {.alarms = alarms(after) - alarms(before),
          .lost = after.beacons.lost - before.beacons.lost,
          .taken = after.beacons.taken - before.beacons.taken,
          .seconds = seconds,
          .pair_seconds = seconds * peers};
}

std::string WhyWorse(const ServiceFigures& canary, const ServiceFigures& rest) {
  if (rest.taken == 0) return "there is no other vehicle to compare it with";
  if (canary.taken == 0) return "it hears no beacon";
  const auto number = [](std::uint64_t count) { return static_cast<double>(count); };
  if (IsMore(number(canary.alarms), canary.pair_seconds, number(rest.alarms), rest.pair_seconds)) {
    return fmt::format("{:.0f} alarms a peer and hour, the rest {:.0f}", canary.AlarmsPerPairHour(),
                       rest.AlarmsPerPairHour());
  }
  if (IsMore(number(canary.lost), number(canary.lost + canary.taken), number(rest.lost),
             number(rest.lost + rest.taken))) {
    return fmt::format("{:.1f} % of its beacons are lost, of the rest's {:.1f} %",
                       100 * canary.LostShare(), 100 * rest.LostShare());
  }
  if (IsMore(number(rest.taken), rest.seconds, number(canary.taken), canary.seconds)) {
    return fmt::format("it takes {:.0f} beacons a second, each of the rest {:.0f}",
                       canary.TakenPerSecond(), rest.TakenPerSecond());
  }
  return "";
}

}  // namespace giveway::fleetctl
