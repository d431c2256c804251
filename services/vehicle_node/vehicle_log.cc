#include "services/vehicle_node/vehicle_log.h"

#include <algorithm>

#include "services/runtime/process.h"
#include "services/vehicle/refused_beacon.h"
#include "services/vehicle_node/vehicle_report.h"

namespace giveway {
namespace {

bool HasLeft(VehicleId peer, const Vehicle& vehicle) {
  const auto peers = vehicle.State().heard.peers.Peers();
  const auto found = std::ranges::find(peers, peer, &Peer::id);
  return found != peers.end() && found->left;
}

void LogEvent(const QosEvent& event, const Vehicle& vehicle) {
  switch (event.kind) {
    case QosEventKind::kDeadlineMissed:
    case QosEventKind::kLivelinessLost:
      // Its writer is gone a moment after its leave notice.
      if (HasLeft(event.vehicle, vehicle)) return;
      [[fallthrough]];
    case QosEventKind::kIncompatibleQos:
      return LogWarning(Describe(event), event.at);
    default:
      LogInfo(Describe(event), event.at);
  }
}

}  // namespace

void VehicleLog::LogLink(std::span<const Refusal> refusals, const std::vector<std::string>& unfit,
                         SteadyTime now) {
  LogNews(refusals, unfit, now, &refusal_log_);
}

void VehicleLog::LogPackets(const PacketCounters& packets, SteadyTime now) {
  LogDrops(packets, now, &packet_log_);
}

void VehicleLog::LogEvents(std::span<const QosEvent> events, const Vehicle& vehicle,
                           SteadyTime now) {
  const std::uint32_t left_out = event_lines_.TakeLeftOut(now);
  if (left_out > 0) LogInfo("and " + std::to_string(left_out) + " more such events of peers");
  for (const QosEvent& event : events) {
    if (event.kind == QosEventKind::kSampleLost) {
      LogDebug(Describe(event));
    } else if (event_lines_.Take(now)) {
      LogEvent(event, vehicle);
    }
  }
}

void VehicleLog::LogRefusals(std::span<const ReceivedBeacon> beacons, const Vehicle& vehicle,
                             SteadyTime now) {
  std::vector<Refusal> refusals;
  for (const RefusedBeacon& refused : vehicle.Refused()) {
    if (refused.why == BeaconRefusal::kCrc || refused.why == BeaconRefusal::kWrongName) continue;
    refusals.push_back(Explain(beacons[refused.index], refused.why, vehicle.State()));
  }
  LogNews(refusals, {}, now, &refusal_log_);
}

void VehicleLog::LogFreshness(const Vehicle& vehicle, const VehicleOptions& options, SteadyTime now,
                              SteadyTime woke) {
  beacon_freshness_.Update(vehicle.State().heard.peers.Peers(), now, vehicle.State().world.tick,
                           options);
  for (const FreshnessChange& item : beacon_freshness_.Items()) {
    const bool is_trouble = item.kind == FreshnessKind::kStale;
    is_trouble ? LogWarning(Describe(item), woke) : LogInfo(Describe(item), woke);
  }
}

void VehicleLog::LogBlackouts(const std::optional<SteadyTime>& since) {
  if (logged_blackouts_ || !since) return;
  logged_blackouts_ = true;
  LogInfo("impairment: blackouts are counted from here", *since);
}

}  // namespace giveway
