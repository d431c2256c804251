#include "services/observer/fleet/sample_json.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "services/observer/fleet/sample_format.h"

namespace giveway {
namespace {

void AddId(std::string_view name, VehicleId vehicle, Json* json) {
  if (vehicle != kNoVehicle) (*json)[name] = Number(vehicle);
}

void AddTick(WorldEpoch epoch, Tick tick, Json* to) {
  Json& json = *to;
  json["world_epoch"] = Number(epoch);
  json["tick"] = Number(tick);
}

void AddWheels(const WheelSpeeds& wheels, Json* to) {
  Json& json = *to;
  json["left_rad_s"] = wheels.left_rad_s;
  json["right_rad_s"] = wheels.right_rad_s;
}

Json PointOf(Vec2 point) {
  Json object;
  object["x_m"] = point.x;
  object["y_m"] = point.y;
  return object;
}

Json PoseOf(const Pose& pose) {
  Json object = PointOf(pose.position_world);
  object["heading_rad"] = pose.heading_rad;
  return object;
}

Json CovarianceOf(const PoseCovariance& covariance) {
  Json object;
  object["xx_m2"] = covariance.xx_m2;
  object["xy_m2"] = covariance.xy_m2;
  object["yy_m2"] = covariance.yy_m2;
  object["xh_m_rad"] = covariance.xh_m_rad;
  object["yh_m_rad"] = covariance.yh_m_rad;
  object["hh_rad2"] = covariance.hh_rad2;
  return object;
}

Json BeaconCountsOf(const BeaconCounters& counters) {
  Json object;
  object["sent"] = counters.sent;
  object["taken"] = counters.taken;
  object["accepted"] = counters.accepted;
  object["not_heard"] = counters.not_heard;
  object["lost"] = counters.lost;
  object["rejected_not_finite"] = counters.rejected_not_finite;
  object["rejected_out_of_range"] = counters.rejected_out_of_range;
  object["rejected_crc"] = counters.rejected_crc;
  object["rejected_replayed"] = counters.rejected_replayed;
  object["rejected_own"] = counters.rejected_own;
  object["rejected_wrong_name"] = counters.rejected_wrong_name;
  object["rejected_duplicate_id"] = counters.rejected_duplicate_id;
  object["rejected_wrong_epoch"] = counters.rejected_wrong_epoch;
  object["rejected_table_full"] = counters.rejected_table_full;
  return object;
}

Json TrustCountsOf(const TrustCounters& counters) {
  Json object;
  object["beacon_without_echo"] = counters.beacon_without_echo;
  object["echo_without_beacon"] = counters.echo_without_beacon;
  object["halted_but_closing"] = counters.halted_but_closing;
  object["jumps"] = counters.jumps;
  object["impossible_speeds"] = counters.impossible_speeds;
  return object;
}

Json QosCountsOf(const QosCounters& counters) {
  Json object;
  object["deadline_missed"] = counters.deadline_missed;
  object["liveliness_lost"] = counters.liveliness_lost;
  object["incompatible_qos"] = counters.incompatible_qos;
  object["matched"] = counters.matched;
  object["unmatched"] = counters.unmatched;
  return object;
}

Json ImpairCountsOf(const ImpairmentCounters& counters) {
  Json object;
  object["packets"] = counters.packets;
  object["passed"] = counters.passed;
  object["dropped_blackout"] = counters.dropped_blackout;
  object["dropped_rate"] = counters.dropped_rate;
  object["dropped_loss"] = counters.dropped_loss;
  object["dropped_burst"] = counters.dropped_burst;
  object["delayed"] = counters.delayed;
  object["held_back"] = counters.held_back;
  object["duplicated"] = counters.duplicated;
  object["corrupted"] = counters.corrupted;
  object["metered"] = counters.metered;
  return object;
}

Json PacketCountsOf(const PacketCounters& counters) {
  Json object;
  object["handed_on"] = counters.Of(PacketDrop::kNone);
  for (std::size_t i = 1; i < kPacketDrops; ++i) {
    const auto drop = static_cast<PacketDrop>(i);
    object["dropped_" + std::string(Name(drop))] = counters.Of(drop);
  }
  return object;
}

Json RefusedCountsOf(const RefusedSamples& refused) {
  Json object;
  object["unbound_samples"] = refused.unbound_samples;
  object["unreadable_samples"] = refused.unreadable_samples;
  object["wrong_name_scans"] = refused.wrong_name_scans;
  object["old_world_entries"] = refused.old_world_entries;
  object["strangers"] = refused.strangers;
  object["implausible"] = refused.implausible;
  return object;
}

Json AccountOf(const BeaconAccount& account) {
  Json object;
  object["writer"] = Number(account.writer);
  object["boot_epoch"] = account.boot_epoch;
  object["first"] = account.first;
  object["last"] = account.last;
  object["accepted"] = account.accepted;
  object["not_heard"] = account.not_heard;
  object["refused"] = account.refused;
  object["superseded"] = account.superseded;
  object["lost"] = account.lost;
  return object;
}

Json DepartedOf(const AccountSums& departed) {
  Json object;
  object["writers"] = departed.writers;
  object["sent"] = departed.sent;
  object["accepted"] = departed.accepted;
  object["not_heard"] = departed.not_heard;
  object["refused"] = departed.refused;
  object["superseded"] = departed.superseded;
  object["lost"] = departed.lost;
  return object;
}

// Without the newest values, which are for collectors.
Json FigureOf(const FigureSummary& figure) {
  Json object;
  object["values"] = figure.count;
  object["p50"] = figure.p50;
  object["p99"] = figure.p99;
  object["max"] = figure.max;
  return object;
}

Json TimingOf(const DriveFigures& timing) {
  Json object;
  object["beacon_age_us"] = FigureOf(timing.Of(DriveFigure::kBeaconAge));
  object["tick_jitter_us"] = FigureOf(timing.Of(DriveFigure::kTickJitter));
  object["turn_us"] = FigureOf(timing.Of(DriveFigure::kTurn));
  object["reaction_us"] = FigureOf(timing.Of(DriveFigure::kReaction));
  object["reaction_way_um"] = FigureOf(timing.Of(DriveFigure::kReactionDistance));
  object["reaction_share_ppm"] = FigureOf(timing.Of(DriveFigure::kReactionShare));
  object["beacon_latency_us"] = FigureOf(timing.Of(DriveFigure::kBeaconLatency));
  object["scan_latency_us"] = FigureOf(timing.Of(DriveFigure::kScanLatency));
  object["received_before_sent"] = timing.received_before_sent;
  if (timing.narrowest) object["narrowest_share_left"] = timing.narrowest->ShareLeft();
  object["budget_spent"] = timing.budget_spent;
  return object;
}

void AddDecision(const Decision& decision, Json* to) {
  Json& json = *to;
  json["mode"] = giveway::Name(decision.mode);
  json["rule"] = giveway::Name(decision.rule);
  AddId("peer", decision.peer, to);
  if (decision.sensor >= 0) json["sensor"] = decision.sensor;
  if (decision.cause_tick != kNoTick) json["cause_tick"] = Number(decision.cause_tick);
}

}  // namespace

void AddFields(const ReceivedBeacon& received, Json* to) {
  Json& json = *to;
  const Beacon& beacon = received.beacon;
  json["vehicle"] = Number(beacon.vehicle);
  json["boot_epoch"] = beacon.boot_epoch;
  json["seq"] = beacon.seq;
  AddTick(beacon.world_epoch, beacon.tick, to);
  AddWheels(beacon.wheels, to);
  json["cruise_m_s"] = beacon.cruise_m_s;
  json["world_from_body"] = PoseOf(beacon.world_from_body);
  json["covariance"] = CovarianceOf(beacon.covariance);
  json["body_radius_m"] = beacon.body_radius_m;
  json["wheel_radius_m"] = beacon.drive.wheel_radius_m;
  json["axle_m"] = beacon.drive.axle_m;
  json["acceleration_m_s2"] = beacon.acceleration_m_s2;
  json["deceleration_m_s2"] = beacon.deceleration_m_s2;
  json["toward_x_m"] = beacon.toward_world.x;
  json["toward_y_m"] = beacon.toward_world.y;
  json["mode"] = giveway::Name(beacon.mode);
  json["rule"] = giveway::Name(beacon.rule);
  AddId("gives_way_to", beacon.gives_way_to, to);
  AddId("blocked_by", beacon.blocked_by, to);
  json["order_waited_ticks"] = beacon.order.waited_ticks;
  json["order_speed_bucket"] = beacon.order.speed_bucket;
  json["order_vehicle"] = Number(beacon.order.vehicle);
  json["crc_valid"] = received.crc_valid;
  json["name_valid"] = received.name_valid;
}

void AddFields(const VehicleStatus& status, Json* to) {
  Json& json = *to;
  json["vehicle"] = Number(status.vehicle);
  AddTick(status.epoch, status.tick, to);
  AddDecision(status.decision, to);
  AddId("gives_way_to", status.gives_way_to, to);
  json["forward_m_s"] = status.forward_m_s;
  json["nearest_echo_m"] = OrNull(status.nearest_echo_m);
  json["peers_heard"] = status.peers_heard;
  json["beacons"] = BeaconCountsOf(status.beacons);
  json["trust"] = TrustCountsOf(status.trust);
  json["beacons_superseded"] = status.beacons_superseded;
  json["qos"] = QosCountsOf(status.qos);
  AddId("last_deadline_missed", status.last_deadline_missed, to);
  AddId("last_liveliness_lost", status.last_liveliness_lost, to);
  if (status.last_event) {
    Json event;
    event["kind"] = giveway::Name(*status.last_event);
    AddId("vehicle", status.last_event_about, &event);
    json["last_qos_event"] = std::move(event);
  }
  AddId("last_rejected_id", VehicleId{status.last_rejected_id}, to);
  json["step_p99_us"] = status.step_p99_us;
  json["loop_max_ms"] = status.loop_max_ms;
  json["beacon_deadline_offered_ms"] = status.beacon_deadline_offered_ms;
  json["beacon_deadline_requested_ms"] = status.beacon_deadline_requested_ms;
  json["beacon_lease_ms"] = status.beacon_lease_ms;
  json["last_report"] = status.final;
  json["impaired"] = ImpairCountsOf(status.impaired);
  json["timing"] = TimingOf(status.timing);
  json["packets"] = PacketCountsOf(status.packets);
  json["refused"] = RefusedCountsOf(status.refused);
  json["departed"] = DepartedOf(status.departed);
  json["accounts"] = JsonArray(status.accounts.Rows(), AccountOf);
  json["heap_bytes"] = OrNull(status.heap_bytes);
}

void AddFields(const Truth& truth, Json* to) {
  Json& json = *to;
  json["vehicle"] = Number(truth.vehicle);
  AddTick(truth.epoch, truth.tick, to);
  json["time_s"] = truth.time_s;
  json["world_from_body"] = PoseOf(truth.world_from_body);
  AddWheels(truth.wheels, to);
  json["forward_m_s"] = truth.forward_m_s;
  json["present"] = truth.present;
  json["arrived"] = truth.arrived;
}

void AddFields(const WorldEvent& event, Json* to) {
  Json& json = *to;
  json["seq"] = event.seq;
  json["kind"] = Name(event.kind);
  AddTick(event.epoch, event.tick, to);
  json["time_s"] = event.time_s;
  AddId("vehicle", event.vehicle, to);
  AddId("other", event.other, to);
  if (event.vehicle != kNoVehicle) json["position_world"] = PointOf(event.position_world);
  // Of a contact without another vehicle it is the point of the wall, obstacle or door.
  if (event.other != kNoVehicle || event.kind == EventKind::kContact) {
    json["other_position_world"] = PointOf(event.other_position_world);
  }
  json["value"] = event.value;
  if (!event.text.empty()) json["text"] = event.text;
}

void AddFields(const RosterEntry& entry, Json* to) {
  Json& json = *to;
  json["session"] = SessionText(entry.session);
  AddId("vehicle", entry.vehicle, to);
  json["accepted"] = entry.accepted;
  json["waiting"] = entry.waiting;
  if (!entry.reason.empty()) json["reason"] = entry.reason;
  json["world_epoch"] = Number(entry.epoch);
  json["start_world"] = PoseOf(entry.start_world);
  json["tick"] = Number(entry.tick);
  json["counted_left_rad"] = entry.counted.left_rad;
  json["counted_right_rad"] = entry.counted.right_rad;
  json["waypoint"] = entry.task.waypoint;
  json["waited_ticks"] = entry.task.waited_ticks;
  if (entry.spawn != 0) json["spawn"] = entry.spawn;
  json["run_state"] = Name(entry.run_state);
  json["fleet_size"] = entry.fleet_size;
}

void AddFields(const SignalState& signal, Json* to) {
  Json& json = *to;
  json["signal"] = Number(signal.id);
  AddTick(signal.epoch, signal.tick, to);
  json["line_from_world"] = PointOf(signal.line_from_world);
  json["line_to_world"] = PointOf(signal.line_to_world);
  json["travel_rad"] = signal.travel_rad;
  json["phase"] = Name(signal.phase);
  json["to_change_s"] = signal.to_change_s;
}

void AddFields(const RunFigures& figures, Json* to) {
  Json& json = *to;
  json["world_epoch"] = Number(figures.epoch);
  json["passed"] = figures.passed;
  json["reason"] = figures.reason;
  json["contacts"] = figures.contacts;
  json["min_separation_m"] = OrNull(figures.min_separation_m);
  json["time_to_clear_s"] = OrNull(figures.time_to_clear_s);
  json["reaction_p50_ms"] = OrNull(figures.reaction_p50_ms);
  json["reaction_p99_ms"] = OrNull(figures.reaction_p99_ms);
  json["reaction_max_ms"] = OrNull(figures.reaction_max_ms);
  json["reactions"] = figures.reactions;
  json["ticks"] = figures.ticks;
  json["tick_overruns"] = figures.tick_overruns;
  json["state_hash"] = fmt::format("{:016x}", figures.state_hash);
}

void AddFields(const RangeScan& scan, Json* to) {
  Json& json = *to;
  constexpr std::array<std::string_view, 3> kEchoes{"no_data", "clear", "heard"};
  json["vehicle"] = Number(scan.vehicle);
  AddTick(scan.epoch, scan.tick, to);
  json["run_state"] = Name(scan.run_state);
  AddWheels(scan.wheels, to);
  json["counted_left_rad"] = scan.counted.left_rad;
  json["counted_right_rad"] = scan.counted.right_rad;
  json["echo"] = JsonArray(scan.readings, [&](const RangeReading& reading) {
    return kEchoes[static_cast<std::size_t>(reading.kind)];
  });
  json["range_m"] = JsonArray(scan.readings, [](const RangeReading& reading) {
    return reading.kind == Echo::kEcho ? Json(reading.range_m) : Json();
  });
}

void AddFields(const MotorCommand& command, Json* to) {
  Json& json = *to;
  json["vehicle"] = Number(command.vehicle);
  AddTick(command.epoch, command.tick, to);
  AddWheels(command.target, to);
  AddDecision(command.decision, to);
  json["decision_changed"] = command.decision_changed;
  json["matched_peers"] = command.matched_peers;
  json["waypoint"] = command.task.waypoint;
  json["waited_ticks"] = command.task.waited_ticks;
}

}  // namespace giveway
