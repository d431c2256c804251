// What travels now and then: joins, the roster, status, events, figures.
#include <cmath>

#include "services/link/convert/convert.h"
#include "services/link/convert/convert_parts.h"

namespace giveway::link {
namespace {

wire::BeaconCounts ToWirePart(const BeaconCounters& counters) {
  wire::BeaconCounts sent;
  sent.sent(counters.sent);
  sent.taken(counters.taken);
  sent.accepted(counters.accepted);
  sent.not_heard(counters.not_heard);
  sent.lost(counters.lost);
  sent.rejected_not_finite(counters.rejected_not_finite);
  sent.rejected_out_of_range(counters.rejected_out_of_range);
  sent.rejected_crc(counters.rejected_crc);
  sent.rejected_replayed(counters.rejected_replayed);
  sent.rejected_own(counters.rejected_own);
  sent.rejected_wrong_name(counters.rejected_wrong_name);
  sent.rejected_duplicate_id(counters.rejected_duplicate_id);
  sent.rejected_wrong_epoch(counters.rejected_wrong_epoch);
  sent.rejected_table_full(counters.rejected_table_full);
  return sent;
}

wire::ImpairCounts ToWirePart(const ImpairmentCounters& counters) {
  wire::ImpairCounts sent;
  sent.packets(counters.packets);
  sent.passed(counters.passed);
  sent.dropped_blackout(counters.dropped_blackout);
  sent.dropped_rate(counters.dropped_rate);
  sent.dropped_loss(counters.dropped_loss);
  sent.dropped_burst(counters.dropped_burst);
  sent.delayed(counters.delayed);
  sent.held_back(counters.held_back);
  sent.duplicated(counters.duplicated);
  sent.corrupted(counters.corrupted);
  return sent;
}

ImpairmentCounters FromWirePart(const wire::ImpairCounts& sent) {
  return {.packets = sent.packets(),
          .passed = sent.passed(),
          .dropped_blackout = sent.dropped_blackout(),
          .dropped_rate = sent.dropped_rate(),
          .dropped_loss = sent.dropped_loss(),
          .dropped_burst = sent.dropped_burst(),
          .delayed = sent.delayed(),
          .held_back = sent.held_back(),
          .duplicated = sent.duplicated(),
          .corrupted = sent.corrupted()};
}

BeaconCounters FromWirePart(const wire::BeaconCounts& sent) {
  return {.sent = sent.sent(),
          .taken = sent.taken(),
          .accepted = sent.accepted(),
          .not_heard = sent.not_heard(),
          .lost = sent.lost(),
          .rejected_not_finite = sent.rejected_not_finite(),
          .rejected_out_of_range = sent.rejected_out_of_range(),
          .rejected_crc = sent.rejected_crc(),
          .rejected_replayed = sent.rejected_replayed(),
          .rejected_own = sent.rejected_own(),
          .rejected_wrong_name = sent.rejected_wrong_name(),
          .rejected_duplicate_id = sent.rejected_duplicate_id(),
          .rejected_wrong_epoch = sent.rejected_wrong_epoch(),
          .rejected_table_full = sent.rejected_table_full()};
}

wire::TrustCounts ToWirePart(const TrustCounters& counters) {
  wire::TrustCounts sent;
  sent.beacon_without_echo(counters.beacon_without_echo);
  sent.echo_without_beacon(counters.echo_without_beacon);
  sent.halted_but_closing(counters.halted_but_closing);
  sent.jumps(counters.jumps);
  sent.impossible_speeds(counters.impossible_speeds);
  return sent;
}

TrustCounters FromWirePart(const wire::TrustCounts& sent) {
  return {.beacon_without_echo = sent.beacon_without_echo(),
          .echo_without_beacon = sent.echo_without_beacon(),
          .halted_but_closing = sent.halted_but_closing(),
          .jumps = sent.jumps(),
          .impossible_speeds = sent.impossible_speeds()};
}

wire::QosCounts ToWirePart(const QosCounters& counters) {
  wire::QosCounts sent;
  sent.deadline_missed(counters.deadline_missed);
  sent.liveliness_lost(counters.liveliness_lost);
  sent.incompatible_qos(counters.incompatible_qos);
  sent.matched(counters.matched);
  sent.unmatched(counters.unmatched);
  return sent;
}

QosCounters FromWirePart(const wire::QosCounts& sent) {
  return {.deadline_missed = sent.deadline_missed(),
          .liveliness_lost = sent.liveliness_lost(),
          .incompatible_qos = sent.incompatible_qos(),
          .matched = sent.matched(),
          .unmatched = sent.unmatched()};
}

wire::LastQosEvent LastEventOf(const VehicleStatus& status) {
  wire::LastQosEvent sent;
  sent.known(status.last_event.has_value());
  if (status.last_event) sent.kind(ToWireEnum<wire::QosEventKind>(*status.last_event));
  sent.vehicle(Number(status.last_event_about));
  return sent;
}

wire::FigureCounts ToWirePart(const FigureSummary& figure) {
  wire::FigureCounts sent;
  sent.values(figure.count);
  sent.sum(figure.sum);
  sent.p50(figure.p50);
  sent.p99(figure.p99);
  sent.highest(figure.max);
  sent.newest(figure.newest);
  return sent;
}

FigureSummary FromWirePart(const wire::FigureCounts& sent) {
  return {.count = sent.values(),
          .sum = sent.sum(),
          .p50 = sent.p50(),
          .p99 = sent.p99(),
          .max = sent.highest(),
          .newest = sent.newest()};
}

wire::TimingReport ToWirePart(const DriveFigures& timing) {
  wire::TimingReport sent;
  sent.beacon_age_us(ToWirePart(timing.Of(DriveFigure::kBeaconAge)));
  sent.tick_jitter_us(ToWirePart(timing.Of(DriveFigure::kTickJitter)));
  sent.turn_us(ToWirePart(timing.Of(DriveFigure::kTurn)));
  sent.reaction_us(ToWirePart(timing.Of(DriveFigure::kReaction)));
  sent.reaction_way_um(ToWirePart(timing.Of(DriveFigure::kReactionDistance)));
  sent.reaction_share_ppm(ToWirePart(timing.Of(DriveFigure::kReactionShare)));
  const ReactionMargin margin = timing.narrowest.value_or(ReactionMargin{});
  sent.margin_known(timing.narrowest.has_value());
  sent.margin_tick(Number(margin.tick));
  sent.margin_reaction_m(margin.reaction_m);
  sent.margin_free_m(margin.free_m);
  sent.budget_spent(timing.budget_spent);
  return sent;
}

wire::PacketCounts ToWirePart(const PacketCounters& counters) {
  wire::PacketCounts sent;
  sent.handed_on(counters.Of(PacketDrop::kNone));
  sent.dropped_foreign_source(counters.Of(PacketDrop::kForeignSource));
  sent.dropped_not_rtps(counters.Of(PacketDrop::kNotRtps));
  sent.dropped_unknown_kind(counters.Of(PacketDrop::kUnknownKind));
  sent.dropped_statistics(counters.Of(PacketDrop::kStatistics));
  sent.dropped_malformed(counters.Of(PacketDrop::kMalformed));
  sent.dropped_list_too_long(counters.Of(PacketDrop::kListTooLong));
  sent.dropped_sample_too_large(counters.Of(PacketDrop::kSampleTooLarge));
  sent.dropped_range_too_long(counters.Of(PacketDrop::kRangeTooLong));
  sent.dropped_sequence_jump(counters.Of(PacketDrop::kSequenceJump));
  sent.dropped_too_many_strangers(counters.Of(PacketDrop::kTooManyStrangers));
  sent.dropped_fragmented_announcement(counters.Of(PacketDrop::kFragmentedAnnouncement));
  return sent;
}

// In the order of PacketDrop, but for the last one, which is at the end of a status.
PacketCounters FromWirePart(const wire::PacketCounts& sent) {
  return {{sent.handed_on(), sent.dropped_foreign_source(), sent.dropped_not_rtps(),
           sent.dropped_unknown_kind(), sent.dropped_statistics(), sent.dropped_malformed(),
           sent.dropped_list_too_long(), sent.dropped_sample_too_large(),
           sent.dropped_range_too_long(), sent.dropped_sequence_jump(),
           sent.dropped_too_many_strangers(), sent.dropped_fragmented_announcement()}};
}

wire::RefusedCounts ToWirePart(const RefusedSamples& refused) {
  wire::RefusedCounts sent;
  sent.unbound_samples(refused.unbound_samples);
  sent.unreadable_samples(refused.unreadable_samples);
  sent.wrong_name_scans(refused.wrong_name_scans);
  sent.old_world_entries(refused.old_world_entries);
  sent.strangers(refused.strangers);
  sent.implausible(refused.implausible);
  return sent;
}

RefusedSamples FromWirePart(const wire::RefusedCounts& sent) {
  return {.unbound_samples = sent.unbound_samples(),
          .unreadable_samples = sent.unreadable_samples(),
          .wrong_name_scans = sent.wrong_name_scans(),
          .old_world_entries = sent.old_world_entries(),
          .strangers = sent.strangers(),
          .implausible = sent.implausible()};
}

// Numbers that no distance has are refused.
bool TakeTiming(const wire::Status& sample, DriveFigures& timing) {
  const wire::TimingReport& sent = sample.timing();
  timing.figures = {FromWirePart(sent.beacon_age_us()),
                    FromWirePart(sent.tick_jitter_us()),
                    FromWirePart(sent.turn_us()),
                    FromWirePart(sent.reaction_us()),
                    FromWirePart(sent.reaction_way_um()),
                    FromWirePart(sent.reaction_share_ppm()),
                    FromWirePart(sample.beacon_latency_us()),
                    FromWirePart(sample.scan_latency_us())};
  timing.received_before_sent = sample.received_before_sent();
  timing.narrowest.reset();
  timing.budget_spent = sent.budget_spent();
  if (!sent.margin_known()) return true;
  const ReactionMargin margin{Tick{sent.margin_tick()}, sent.margin_reaction_m(),
                              sent.margin_free_m()};
  if (!std::isfinite(margin.reaction_m) || !(margin.free_m >= 0) || std::isinf(margin.free_m)) {
    return false;
  }
  timing.narrowest = margin;
  return true;
}

wire::BeaconAccount ToWirePart(const BeaconAccount& account) {
  wire::BeaconAccount sent;
  sent.writer(Number(account.writer));
  sent.boot_epoch(account.boot_epoch);
  sent.first(account.first);
  sent.last(account.last);
  sent.accepted(account.accepted);
  sent.not_heard(account.not_heard);
  sent.refused(account.refused);
  sent.superseded(account.superseded);
  sent.lost(account.lost);
  return sent;
}

BeaconAccount FromWirePart(const wire::BeaconAccount& sent) {
  return {.writer = VehicleId{sent.writer()},
          .boot_epoch = sent.boot_epoch(),
          .first = sent.first(),
          .last = sent.last(),
          .accepted = sent.accepted(),
          .not_heard = sent.not_heard(),
          .refused = sent.refused(),
          .superseded = sent.superseded(),
          .lost = sent.lost()};
}

wire::DepartedAccounts ToWirePart(const AccountSums& departed) {
  wire::DepartedAccounts sent;
  sent.writers(departed.writers);
  sent.sent(departed.sent);
  sent.accepted(departed.accepted);
  sent.not_heard(departed.not_heard);
  sent.refused(departed.refused);
  sent.superseded(departed.superseded);
  sent.lost(departed.lost);
  return sent;
}

AccountSums FromWirePart(const wire::DepartedAccounts& sent) {
  return {.writers = sent.writers(),
          .sent = sent.sent(),
          .accepted = sent.accepted(),
          .not_heard = sent.not_heard(),
          .refused = sent.refused(),
          .superseded = sent.superseded(),
          .lost = sent.lost()};
}

bool TakeAccounts(const wire::Status& sample, VehicleStatus& status) {
  status.departed = FromWirePart(sample.departed());
  status.accounts = {};
  for (const wire::BeaconAccount& sent : sample.accounts()) {
    if (!status.accounts.Add(FromWirePart(sent))) return false;
  }
  return true;
}

bool TakeLastEvent(const wire::LastQosEvent& sent, VehicleStatus& status) {
  giveway::QosEventKind kind{};
  if (!FromWireEnum(sent.kind(), giveway::QosEventKind::kSampleLost, kind)) return false;
  status.last_event.reset();
  if (sent.known()) status.last_event = kind;
  status.last_event_about = VehicleId{sent.vehicle()};
  return true;
}

}  // namespace

wire::Status ToWire(const VehicleStatus& status) {
  wire::Status sent;
  sent.vehicle(Number(status.vehicle));
  sent.world_epoch(Number(status.epoch));
  sent.tick(Number(status.tick));
  sent.decision(ToWirePart(status.decision));
  sent.gives_way_to(Number(status.gives_way_to));
  sent.forward_m_s(status.forward_m_s);
  sent.nearest_echo_m(ToWirePart(status.nearest_echo_m));
  sent.peers_heard(status.peers_heard);
  sent.beacons(ToWirePart(status.beacons));
  sent.trust(ToWirePart(status.trust));
  sent.beacons_superseded(status.beacons_superseded);
  sent.qos(ToWirePart(status.qos));
  sent.last_deadline_missed(Number(status.last_deadline_missed));
  sent.last_liveliness_lost(Number(status.last_liveliness_lost));
  sent.last_qos_event(LastEventOf(status));
  sent.last_rejected_id(status.last_rejected_id);
  sent.step_p99_us(status.step_p99_us);
  sent.loop_max_ms(status.loop_max_ms);
  sent.beacon_deadline_offered_ms(status.beacon_deadline_offered_ms);
  sent.beacon_deadline_requested_ms(status.beacon_deadline_requested_ms);
  sent.beacon_lease_ms(status.beacon_lease_ms);
  sent.last_report(status.final);
  sent.impaired(ToWirePart(status.impaired));
  sent.timing(ToWirePart(status.timing));
  sent.packets(ToWirePart(status.packets));
  sent.refused(ToWirePart(status.refused));
  sent.impaired_metered(status.impaired.metered);
  sent.beacon_latency_us(ToWirePart(status.timing.Of(DriveFigure::kBeaconLatency)));
  sent.scan_latency_us(ToWirePart(status.timing.Of(DriveFigure::kScanLatency)));
  sent.received_before_sent(status.timing.received_before_sent);
  sent.departed(ToWirePart(status.departed));
  for (const BeaconAccount& account : status.accounts.Rows()) {
    sent.accounts().push_back(ToWirePart(account));
  }
  sent.heap_bytes(status.heap_bytes.value_or(0));
  sent.dropped_too_many_endpoints(status.packets.Of(PacketDrop::kTooManyEndpoints));
  return sent;
}

bool FromWire(const wire::Status& sample, VehicleStatus& status) {
  status.vehicle = VehicleId{sample.vehicle()};
  status.epoch = WorldEpoch{sample.world_epoch()};
  status.tick = Tick{sample.tick()};
  status.gives_way_to = VehicleId{sample.gives_way_to()};
  status.forward_m_s = sample.forward_m_s();
  status.nearest_echo_m = FromWirePart(sample.nearest_echo_m());
  status.peers_heard = sample.peers_heard();
  status.beacons = FromWirePart(sample.beacons());
  status.trust = FromWirePart(sample.trust());
  status.beacons_superseded = sample.beacons_superseded();
  status.qos = FromWirePart(sample.qos());
  status.last_deadline_missed = VehicleId{sample.last_deadline_missed()};
  status.last_liveliness_lost = VehicleId{sample.last_liveliness_lost()};
  status.last_rejected_id = sample.last_rejected_id();
  status.step_p99_us = sample.step_p99_us();
  status.loop_max_ms = sample.loop_max_ms();
  status.beacon_deadline_offered_ms = sample.beacon_deadline_offered_ms();
  status.beacon_deadline_requested_ms = sample.beacon_deadline_requested_ms();
  status.beacon_lease_ms = sample.beacon_lease_ms();
  status.final = sample.last_report();
  status.impaired = FromWirePart(sample.impaired());
  status.packets = FromWirePart(sample.packets());
  status.refused = FromWirePart(sample.refused());
  status.impaired.metered = sample.impaired_metered();
  status.packets.packets[static_cast<std::size_t>(PacketDrop::kTooManyEndpoints)] =
      sample.dropped_too_many_endpoints();
  status.heap_bytes.reset();
  if (sample.heap_bytes() > 0) status.heap_bytes = sample.heap_bytes();
  return TakeTiming(sample, status.timing) && TakeAccounts(sample, status) &&
         TakeLastEvent(sample.last_qos_event(), status) &&
         FromWirePart(sample.decision(), status.decision);
}

wire::Join ToWire(const JoinRequest& request) {
  wire::Join sent;
  sent.session(request.session);
  sent.wanted(Number(request.wanted));
  sent.leaving(request.leaving);
  sent.secret(request.secret);
  return sent;
}

bool FromWire(const wire::Join& sample, JoinRequest& request) {
  request.session = sample.session();
  request.wanted = VehicleId{sample.wanted()};
  request.leaving = sample.leaving();
  request.secret = sample.secret();
  return true;
}

wire::Roster ToWire(const RosterEntry& entry) {
  wire::Roster sent;
  sent.session(entry.session);
  sent.vehicle(Number(entry.vehicle));
  sent.accepted(entry.accepted);
  sent.waiting(entry.waiting);
  sent.reason(CutText(entry.reason));
  sent.world_epoch(Number(entry.epoch));
  sent.start_world(ToWirePart(entry.start_world));
  sent.tick(Number(entry.tick));
  sent.counted_left_rad(entry.counted.left_rad);
  sent.counted_right_rad(entry.counted.right_rad);
  sent.waypoint(entry.task.waypoint);
  sent.waited_ticks(entry.task.waited_ticks);
  sent.spawn(entry.spawn);
  sent.run_state(ToWireEnum<wire::RunPhase>(entry.run_state));
  sent.fleet_size(entry.fleet_size);
  return sent;
}

bool FromWire(const wire::Roster& sample, RosterEntry& entry) {
  entry.session = sample.session();
  entry.vehicle = VehicleId{sample.vehicle()};
  entry.accepted = sample.accepted();
  entry.waiting = sample.waiting();
  entry.reason = sample.reason().c_str();
  entry.epoch = WorldEpoch{sample.world_epoch()};
  entry.start_world = FromWirePart(sample.start_world());
  entry.tick = Tick{sample.tick()};
  entry.counted = {sample.counted_left_rad(), sample.counted_right_rad()};
  entry.task = {sample.waypoint(), sample.waited_ticks()};
  entry.spawn = sample.spawn();
  entry.fleet_size = sample.fleet_size();
  return FromWirePart(sample.run_state(), entry.run_state);
}

wire::Event ToWire(const WorldEvent& event) {
  wire::Event sent;
  sent.seq(event.seq);
  sent.kind(ToWireEnum<wire::EventKind>(event.kind));
  sent.world_epoch(Number(event.epoch));
  sent.tick(Number(event.tick));
  sent.time_s(event.time_s);
  sent.vehicle(Number(event.vehicle));
  sent.other(Number(event.other));
  sent.x_m(event.position_world.x);
  sent.y_m(event.position_world.y);
  sent.other_x_m(event.other_position_world.x);
  sent.other_y_m(event.other_position_world.y);
  sent.value(event.value);
  sent.text(CutText(event.text));
  return sent;
}

bool FromWire(const wire::Event& sample, WorldEvent& event) {
  event.seq = sample.seq();
  event.epoch = WorldEpoch{sample.world_epoch()};
  event.tick = Tick{sample.tick()};
  event.time_s = sample.time_s();
  event.vehicle = VehicleId{sample.vehicle()};
  event.other = VehicleId{sample.other()};
  event.position_world = {sample.x_m(), sample.y_m()};
  event.other_position_world = {sample.other_x_m(), sample.other_y_m()};
  event.value = sample.value();
  event.text = sample.text().c_str();
  // JSON leaves out what is not finite, and the page relies on these.
  return std::isfinite(event.time_s) && IsFinite(event.position_world) &&
         IsFinite(event.other_position_world) && FromWirePart(sample.kind(), event.kind);
}

wire::Figures ToWire(const RunFigures& figures) {
  wire::Figures sent;
  sent.world_epoch(Number(figures.epoch));
  sent.passed(figures.passed);
  sent.reason(CutText(figures.reason));
  sent.contacts(figures.contacts);
  sent.min_separation_m(ToWirePart(figures.min_separation_m));
  sent.time_to_clear_s(ToWirePart(figures.time_to_clear_s));
  sent.reaction_p50_ms(ToWirePart(figures.reaction_p50_ms));
  sent.reaction_p99_ms(ToWirePart(figures.reaction_p99_ms));
  sent.reaction_max_ms(ToWirePart(figures.reaction_max_ms));
  sent.reactions(figures.reactions);
  sent.ticks(figures.ticks);
  sent.tick_overruns(figures.tick_overruns);
  sent.state_hash(figures.state_hash);
  return sent;
}

bool FromWire(const wire::Figures& sample, RunFigures& figures) {
  figures.epoch = WorldEpoch{sample.world_epoch()};
  figures.passed = sample.passed();
  figures.reason = sample.reason().c_str();
  figures.contacts = sample.contacts();
  figures.min_separation_m = FromWirePart(sample.min_separation_m());
  figures.time_to_clear_s = FromWirePart(sample.time_to_clear_s());
  figures.reaction_p50_ms = FromWirePart(sample.reaction_p50_ms());
  figures.reaction_p99_ms = FromWirePart(sample.reaction_p99_ms());
  figures.reaction_max_ms = FromWirePart(sample.reaction_max_ms());
  figures.reactions = sample.reactions();
  figures.ticks = sample.ticks();
  figures.tick_overruns = sample.tick_overruns();
  figures.state_hash = sample.state_hash();
  return true;
}

}  // namespace giveway::link
