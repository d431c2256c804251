#include "services/observer/fleet/sample_json.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <string>

#include "services/observer/fleet/sample_words.h"

namespace giveway {
namespace {

void AddId(std::string_view name, VehicleId vehicle, JsonObject* object) {
  if (vehicle != kNobody) object->Add(name, Number(vehicle));
}

void AddTick(WorldEpoch epoch, Tick tick, JsonObject* object) {
  object->Add("world_epoch", Number(epoch));
  object->Add("tick", Number(tick));
}

void AddWheels(const WheelSpeeds& wheels, JsonObject* object) {
  object->Add("left_rad_s", wheels.left_rad_s);
  object->Add("right_rad_s", wheels.right_rad_s);
}

JsonObject PointOf(Vec2 point) {
  JsonObject object;
  object.Add("x_m", point.x);
  object.Add("y_m", point.y);
  return object;
}

JsonObject PoseOf(const Pose& pose) {
  JsonObject object = PointOf(pose.position_world);
  object.Add("heading_rad", pose.heading_rad);
  return object;
}

JsonObject CovarianceOf(const PoseCovariance& covariance) {
  JsonObject object;
  object.Add("xx_m2", covariance.xx_m2);
  object.Add("xy_m2", covariance.xy_m2);
  object.Add("yy_m2", covariance.yy_m2);
  object.Add("xh_m_rad", covariance.xh_m_rad);
  object.Add("yh_m_rad", covariance.yh_m_rad);
  object.Add("hh_rad2", covariance.hh_rad2);
  return object;
}

JsonObject BeaconCountsOf(const BeaconCounters& counters) {
  JsonObject object;
  object.Add("sent", counters.sent);
  object.Add("taken", counters.taken);
  object.Add("accepted", counters.accepted);
  object.Add("not_heard", counters.not_heard);
  object.Add("lost", counters.lost);
  object.Add("rejected_not_finite", counters.rejected_not_finite);
  object.Add("rejected_out_of_range", counters.rejected_out_of_range);
  object.Add("rejected_crc", counters.rejected_crc);
  object.Add("rejected_replayed", counters.rejected_replayed);
  object.Add("rejected_own", counters.rejected_own);
  object.Add("rejected_wrong_name", counters.rejected_wrong_name);
  object.Add("rejected_duplicate_id", counters.rejected_duplicate_id);
  object.Add("rejected_wrong_epoch", counters.rejected_wrong_epoch);
  object.Add("rejected_table_full", counters.rejected_table_full);
  return object;
}

JsonObject TrustCountsOf(const TrustCounters& counters) {
  JsonObject object;
  object.Add("beacon_without_echo", counters.beacon_without_echo);
  object.Add("echo_without_beacon", counters.echo_without_beacon);
  object.Add("halted_but_closing", counters.halted_but_closing);
  object.Add("jumps", counters.jumps);
  object.Add("impossible_speeds", counters.impossible_speeds);
  return object;
}

JsonObject QosCountsOf(const QosCounters& counters) {
  JsonObject object;
  object.Add("deadline_missed", counters.deadline_missed);
  object.Add("liveliness_lost", counters.liveliness_lost);
  object.Add("incompatible_qos", counters.incompatible_qos);
  object.Add("matched", counters.matched);
  object.Add("unmatched", counters.unmatched);
  return object;
}

JsonObject ImpairCountsOf(const ImpairmentCounters& counters) {
  JsonObject object;
  object.Add("packets", counters.packets);
  object.Add("passed", counters.passed);
  object.Add("dropped_blackout", counters.dropped_blackout);
  object.Add("dropped_rate", counters.dropped_rate);
  object.Add("dropped_loss", counters.dropped_loss);
  object.Add("dropped_burst", counters.dropped_burst);
  object.Add("delayed", counters.delayed);
  object.Add("held_back", counters.held_back);
  object.Add("duplicated", counters.duplicated);
  object.Add("corrupted", counters.corrupted);
  object.Add("metered", counters.metered);
  return object;
}

JsonObject PacketCountsOf(const PacketCounters& counters) {
  JsonObject object;
  object.Add("handed_on", counters.Of(PacketDrop::kNone));
  for (std::size_t i = 1; i < kPacketDrops; ++i) {
    const auto drop = static_cast<PacketDrop>(i);
    object.Add("dropped_" + std::string(Name(drop)), counters.Of(drop));
  }
  return object;
}

JsonObject RefusedCountsOf(const RefusedSamples& refused) {
  JsonObject object;
  object.Add("unbound_samples", refused.unbound_samples);
  object.Add("unreadable_samples", refused.unreadable_samples);
  object.Add("wrong_name_scans", refused.wrong_name_scans);
  object.Add("old_world_entries", refused.old_world_entries);
  object.Add("strangers", refused.strangers);
  object.Add("implausible", refused.implausible);
  return object;
}

std::string AccountOf(const BeaconAccount& account) {
  JsonObject object;
  object.Add("writer", Number(account.writer));
  object.Add("boot_epoch", account.boot_epoch);
  object.Add("first", account.first);
  object.Add("last", account.last);
  object.Add("accepted", account.accepted);
  object.Add("not_heard", account.not_heard);
  object.Add("refused", account.refused);
  object.Add("superseded", account.superseded);
  object.Add("lost", account.lost);
  return object.Text();
}

JsonObject DepartedOf(const AccountSums& departed) {
  JsonObject object;
  object.Add("writers", departed.writers);
  object.Add("sent", departed.sent);
  object.Add("accepted", departed.accepted);
  object.Add("not_heard", departed.not_heard);
  object.Add("refused", departed.refused);
  object.Add("superseded", departed.superseded);
  object.Add("lost", departed.lost);
  return object;
}

// Without the newest values, which are for collectors.
JsonObject FigureOf(const FigureSummary& figure) {
  JsonObject object;
  object.Add("values", figure.count);
  object.Add("p50", figure.p50);
  object.Add("p99", figure.p99);
  object.Add("max", figure.max);
  return object;
}

JsonObject TimingOf(const DriveFigures& timing) {
  JsonObject object;
  object.Add("beacon_age_us", FigureOf(timing.Of(DriveFigure::kBeaconAge)));
  object.Add("tick_jitter_us", FigureOf(timing.Of(DriveFigure::kTickJitter)));
  object.Add("turn_us", FigureOf(timing.Of(DriveFigure::kTurn)));
  object.Add("reaction_us", FigureOf(timing.Of(DriveFigure::kReaction)));
  object.Add("reaction_way_um", FigureOf(timing.Of(DriveFigure::kReactionWay)));
  object.Add("reaction_share_ppm", FigureOf(timing.Of(DriveFigure::kReactionShare)));
  object.Add("beacon_latency_us", FigureOf(timing.Of(DriveFigure::kBeaconLatency)));
  object.Add("scan_latency_us", FigureOf(timing.Of(DriveFigure::kScanLatency)));
  object.Add("received_before_sent", timing.received_before_sent);
  if (timing.narrowest) object.Add("narrowest_share_left", timing.narrowest->ShareLeft());
  object.Add("budget_spent", timing.budget_spent);
  return object;
}

void AddDecision(const Decision& decision, JsonObject* object) {
  object->Add("mode", giveway::Name(decision.mode));
  object->Add("rule", giveway::Name(decision.rule));
  AddId("peer", decision.peer, object);
  if (decision.sensor >= 0) object->Add("sensor", decision.sensor);
  if (decision.cause_tick != kNoTick) object->Add("cause_tick", Number(decision.cause_tick));
}

}  // namespace

void AddFields(const ReceivedBeacon& received, JsonObject* object) {
  const Beacon& beacon = received.beacon;
  object->Add("vehicle", Number(beacon.vehicle));
  object->Add("boot_epoch", beacon.boot_epoch);
  object->Add("seq", beacon.seq);
  AddTick(beacon.world_epoch, beacon.tick, object);
  AddWheels(beacon.wheels, object);
  object->Add("cruise_m_s", beacon.cruise_m_s);
  object->Add("world_from_body", PoseOf(beacon.world_from_body));
  object->Add("covariance", CovarianceOf(beacon.covariance));
  object->Add("body_radius_m", beacon.body_radius_m);
  object->Add("wheel_radius_m", beacon.drive.wheel_radius_m);
  object->Add("axle_m", beacon.drive.axle_m);
  object->Add("acceleration_m_s2", beacon.acceleration_m_s2);
  object->Add("deceleration_m_s2", beacon.deceleration_m_s2);
  object->Add("toward_x_m", beacon.toward_world.x);
  object->Add("toward_y_m", beacon.toward_world.y);
  object->Add("mode", giveway::Name(beacon.mode));
  object->Add("rule", giveway::Name(beacon.rule));
  AddId("gives_way_to", beacon.gives_way_to, object);
  AddId("blocked_by", beacon.blocked_by, object);
  object->Add("order_waited_ticks", beacon.order.waited_ticks);
  object->Add("order_speed_bucket", beacon.order.speed_bucket);
  object->Add("order_vehicle", Number(beacon.order.vehicle));
  object->Add("crc_valid", received.crc_valid);
  object->Add("name_valid", received.name_valid);
}

void AddFields(const VehicleStatus& status, JsonObject* object) {
  object->Add("vehicle", Number(status.vehicle));
  AddTick(status.epoch, status.tick, object);
  AddDecision(status.decision, object);
  AddId("gives_way_to", status.gives_way_to, object);
  object->Add("forward_m_s", status.forward_m_s);
  object->Add("nearest_echo_m", status.nearest_echo_m);
  object->Add("peers_heard", status.peers_heard);
  object->Add("beacons", BeaconCountsOf(status.beacons));
  object->Add("trust", TrustCountsOf(status.trust));
  object->Add("beacons_superseded", status.beacons_superseded);
  object->Add("qos", QosCountsOf(status.qos));
  AddId("last_deadline_missed", status.last_deadline_missed, object);
  AddId("last_liveliness_lost", status.last_liveliness_lost, object);
  if (status.last_event) {
    JsonObject event;
    event.Add("kind", giveway::Name(*status.last_event));
    AddId("vehicle", status.last_event_about, &event);
    object->Add("last_qos_event", event);
  }
  AddId("last_rejected_id", VehicleId{status.last_rejected_id}, object);
  object->Add("step_p99_us", status.step_p99_us);
  object->Add("loop_max_ms", status.loop_max_ms);
  object->Add("beacon_deadline_offered_ms", status.beacon_deadline_offered_ms);
  object->Add("beacon_deadline_requested_ms", status.beacon_deadline_requested_ms);
  object->Add("beacon_lease_ms", status.beacon_lease_ms);
  object->Add("last_report", status.final);
  object->Add("impaired", ImpairCountsOf(status.impaired));
  object->Add("timing", TimingOf(status.timing));
  object->Add("packets", PacketCountsOf(status.packets));
  object->Add("refused", RefusedCountsOf(status.refused));
  object->Add("departed", DepartedOf(status.departed));
  object->AddRaw("accounts", JsonArray(status.accounts.Rows(), AccountOf));
}

void AddFields(const Truth& truth, JsonObject* object) {
  object->Add("vehicle", Number(truth.vehicle));
  AddTick(truth.epoch, truth.tick, object);
  object->Add("time_s", truth.time_s);
  object->Add("world_from_body", PoseOf(truth.world_from_body));
  AddWheels(truth.wheels, object);
  object->Add("forward_m_s", truth.forward_m_s);
  object->Add("present", truth.present);
  object->Add("arrived", truth.arrived);
}

void AddFields(const WorldEvent& event, JsonObject* object) {
  object->Add("seq", event.seq);
  object->Add("kind", Name(event.kind));
  AddTick(event.epoch, event.tick, object);
  object->Add("time_s", event.time_s);
  AddId("vehicle", event.vehicle, object);
  AddId("other", event.other, object);
  if (event.vehicle != kNobody) object->Add("position_world", PointOf(event.position_world));
  if (event.other != kNobody) {
    object->Add("other_position_world", PointOf(event.other_position_world));
  }
  object->Add("value", event.value);
  if (!event.text.empty()) object->Add("text", event.text);
}

void AddFields(const RosterEntry& entry, JsonObject* object) {
  object->Add("session", SessionText(entry.session));
  AddId("vehicle", entry.vehicle, object);
  object->Add("accepted", entry.accepted);
  object->Add("waiting", entry.waiting);
  if (!entry.reason.empty()) object->Add("reason", entry.reason);
  object->Add("world_epoch", Number(entry.epoch));
  object->Add("start_world", PoseOf(entry.start_world));
  object->Add("tick", Number(entry.tick));
  object->Add("counted_left_rad", entry.counted.left_rad);
  object->Add("counted_right_rad", entry.counted.right_rad);
  object->Add("waypoint", entry.task.waypoint);
  object->Add("waited_ticks", entry.task.waited_ticks);
  if (entry.spawn != 0) object->Add("spawn", entry.spawn);
  object->Add("run_state", Name(entry.run_state));
  object->Add("fleet_size", entry.fleet_size);
}

void AddFields(const SignalState& signal, JsonObject* object) {
  object->Add("signal", Number(signal.id));
  AddTick(signal.epoch, signal.tick, object);
  object->Add("line_from_world", PointOf(signal.line_from_world));
  object->Add("line_to_world", PointOf(signal.line_to_world));
  object->Add("travel_rad", signal.travel_rad);
  object->Add("phase", Name(signal.phase));
  object->Add("to_change_s", signal.to_change_s);
}

void AddFields(const RunFigures& figures, JsonObject* object) {
  object->Add("world_epoch", Number(figures.epoch));
  object->Add("passed", figures.passed);
  object->Add("reason", figures.reason);
  object->Add("contacts", figures.contacts);
  object->Add("min_separation_m", figures.min_separation_m);
  object->Add("time_to_clear_s", figures.time_to_clear_s);
  object->Add("reaction_p50_ms", figures.reaction_p50_ms);
  object->Add("reaction_p99_ms", figures.reaction_p99_ms);
  object->Add("reaction_max_ms", figures.reaction_max_ms);
  object->Add("reactions", figures.reactions);
  object->Add("ticks", figures.ticks);
  object->Add("tick_overruns", figures.tick_overruns);
  object->Add("state_hash", fmt::format("{:016x}", figures.state_hash));
}

void AddFields(const RangeScan& scan, JsonObject* object) {
  constexpr std::array<std::string_view, 3> kEchoes{"no_data", "clear", "heard"};
  object->Add("vehicle", Number(scan.vehicle));
  AddTick(scan.epoch, scan.tick, object);
  object->Add("run_state", Name(scan.run_state));
  AddWheels(scan.wheels, object);
  object->Add("counted_left_rad", scan.counted.left_rad);
  object->Add("counted_right_rad", scan.counted.right_rad);
  object->AddRaw("echo", JsonArray(scan.readings, [&](const RangeReading& reading) {
                   return fmt::format("\"{}\"", kEchoes[static_cast<std::size_t>(reading.kind)]);
                 }));
  object->AddRaw("range_m", JsonArray(scan.readings, [](const RangeReading& reading) {
                   return reading.kind == Echo::kEcho ? fmt::format("{}", reading.range_m) : "null";
                 }));
}

void AddFields(const MotorCommand& command, JsonObject* object) {
  object->Add("vehicle", Number(command.vehicle));
  AddTick(command.epoch, command.tick, object);
  AddWheels(command.target, object);
  AddDecision(command.decision, object);
  object->Add("decision_changed", command.decision_changed);
  object->Add("matched_peers", command.matched_peers);
  object->Add("waypoint", command.task.waypoint);
  object->Add("waited_ticks", command.task.waited_ticks);
}

}  // namespace giveway
