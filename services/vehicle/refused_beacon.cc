#include "services/vehicle/refused_beacon.h"

#include <algorithm>
#include <optional>

#include "services/vehicle/estimation/beacon_check.h"

namespace giveway {
namespace {

std::string Text(std::uint32_t number) { return std::to_string(number); }

const Peer* PeerOf(const PeerTable& peers, VehicleId id) {
  const auto all = peers.Peers();
  const auto found = std::ranges::lower_bound(all, id, {}, &Peer::id);
  return found == all.end() || found->id != id ? nullptr : &*found;
}

// Of a beacon whose numbers are possible, but not yet.
FieldFault TooFarAhead(const Beacon& beacon, const VehicleState& state) {
  const double most = Number(After(state.world.tick, kMostTicksAhead));
  return {"tick", static_cast<double>(Number(beacon.tick)), 0, most};
}

void DescribeReplayed(const Beacon& beacon, const VehicleState& state, Refusal* refusal) {
  const Peer* const peer = PeerOf(state.heard.peers, beacon.vehicle);
  refusal->counter = "rejected_replayed";
  refusal->passing = true;
  if (peer != nullptr && peer->boot_epoch != beacon.boot_epoch) {
    refusal->field = "boot_epoch";
    refusal->why = "boot_epoch is " + Text(beacon.boot_epoch) + ", must be " +
                   Text(peer->boot_epoch) + " as long as the writer is the same";
    return;
  }
  refusal->field = "seq";
  refusal->why = "seq is " + Text(beacon.seq) + ", must be greater than that of the beacon before" +
                 (peer == nullptr ? "" : ", " + Text(peer->last_seq));
}

}  // namespace

Refusal Explain(const ReceivedBeacon& received, BeaconRefusal why, const VehicleState& state) {
  const Beacon& beacon = received.beacon;
  Refusal refusal{.sample = "beacon", .vehicle = beacon.vehicle, .writer = received.writer};
  const auto say = [&](const char* counter, const char* field, std::string text) {
    refusal.counter = counter;
    refusal.field = field;
    refusal.why = std::move(text);
  };
  switch (why) {
    case BeaconRefusal::kNone:
      break;
    case BeaconRefusal::kNotFinite:
    case BeaconRefusal::kOutOfRange: {
      const std::optional<FieldFault> own = FaultOf(beacon);
      const FieldFault fault = own.value_or(TooFarAhead(beacon, state));
      refusal.passing = !own;  // the own scans may be late
      say(why == BeaconRefusal::kNotFinite ? "rejected_not_finite" : "rejected_out_of_range",
          fault.field, Describe(fault));
      break;
    }
    case BeaconRefusal::kCrc:
      say("rejected_crc", "crc", "crc does not fit its fields");
      break;
    case BeaconRefusal::kReplayed:
      DescribeReplayed(beacon, state, &refusal);
      break;
    case BeaconRefusal::kOwn:
      say("rejected_own", "vehicle", "vehicle is this vehicle's own id");
      break;
    case BeaconRefusal::kWrongName:
      say("rejected_wrong_name", "vehicle", "vehicle is not the one that its partition names");
      break;
    case BeaconRefusal::kDuplicateId:
      say("rejected_duplicate_id", "vehicle",
          "another writer spoke as vehicle " + Text(Number(beacon.vehicle)) +
              " less than its lease ago, or with this boot_epoch");
      refusal.passing = true;
      break;
    case BeaconRefusal::kWrongEpoch:
      say("rejected_wrong_epoch", "world_epoch",
          "world_epoch is " + Text(Number(beacon.world_epoch)) + ", must be " +
              Text(Number(state.world.epoch)) + " as the ranges and the roster say");
      refusal.passing = true;
      break;
    case BeaconRefusal::kTableFull:
      say("rejected_table_full", "", "there are " + Text(kMaxPeers) + " peers already");
      break;
  }
  return refusal;
}

}  // namespace giveway
