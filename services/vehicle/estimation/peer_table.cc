#include "services/vehicle/estimation/peer_table.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/vehicle/estimation/beacon_check.h"
#include "services/vehicle/estimation/injected_mutants.h"

namespace giveway {

namespace {

// The newest believed to be of this world and life, and in reach; null if there is none.
const Beacon* LastBeaconOf(const Peer& peer) {
  if (peer.left) return nullptr;
  if (peer.waiting_count > 0) return &peer.waiting[peer.waiting_count - 1];
  return peer.known && !peer.out_of_reach ? &peer.beacon : nullptr;
}

}  // namespace

// Where the id is, or would have to be inserted.
std::vector<Peer>::iterator PeerTable::PlaceOf(VehicleId id) {
  return std::ranges::lower_bound(peers_, id, {}, &Peer::id);
}

Peer* PeerTable::Find(VehicleId id) {
  const auto place = PlaceOf(id);
  return place != peers_.end() && place->id == id ? &*place : nullptr;
}

Peer* PeerTable::FindOrInsert(VehicleId id) {
  const auto place = PlaceOf(id);
  if (place != peers_.end() && place->id == id) return &*place;
  if (peers_.size() == kMaxPeers) return nullptr;
  return &*peers_.insert(place, Peer{.id = id});
}

// One writer speaks for an id. Another is believed once the first is silent past its lease or has
// left; while both speak, neither is.
bool PeerTable::BelongsTo(Peer* peer, const ReceivedBeacon& received) {
  const SteadyTime now = received.received;
  if (received.writer != peer->writer) {
    const bool silent = now - peer->spoke > kWriterLease || peer->left;
    const bool restarted = received.beacon.boot_epoch != peer->boot_epoch;
    if (peer->writer == 0) {
      peer->writer = received.writer;
    } else if (silent && restarted) {
      *peer = Peer{.id = peer->id,
                   .writer = received.writer,
                   .encounter = peer->encounter,
                   .trust = peer->trust};
    } else {
      peer->rivalled = true;
      peer->rival_spoke = now;
      return false;
    }
  }
  peer->spoke = now;
  if (peer->rivalled && now - peer->rival_spoke <= kWriterLease) return false;
  peer->rivalled = false;
  return true;
}

void PeerTable::Store(Peer* peer, const ReceivedBeacon& received, Tick tick) {
  const Beacon& beacon = received.beacon;
  peer->boot_epoch = beacon.boot_epoch;
  peer->last_seq = beacon.seq;
  peer->deadline_missed = false;
  peer->liveliness_lost = false;
  peer->left = beacon.mode == Mode::kLeaving;
  if (beacon.tick < tick) {
    peer->beacon = beacon;
    peer->received = received.received;
    peer->known = true;
    peer->out_of_reach = false;
    peer->waiting_count = 0;  // all older than this one
    return;
  }
  if (peer->waiting_count == peer->waiting.size()) {  // the newer of two waits for its turn no more
    peer->waiting[0] = peer->waiting[1];
    peer->waiting_received[0] = peer->waiting_received[1];
    --peer->waiting_count;
  }
  peer->waiting[peer->waiting_count] = beacon;
  peer->waiting_received[peer->waiting_count] = received.received;
  ++peer->waiting_count;
}

// One that it has driven out of reach, or so it says. Who jumps there has not: what is known of it,
// and its claim, are as good as if it had fallen silent. Judged once: what it says while it is
// doubted does not fit what it said before that.
void PeerTable::NoteBeyond(Peer* peer, const ReceivedBeacon& received,
                           const VehicleOptions& options, TrustCounters* trust) {
  peer->spoke = received.received;
  peer->last_seq = received.beacon.seq;
  const Beacon* before = LastBeaconOf(*peer);
  if (before != nullptr && !IsDoubted(peer->trust, received.received)) {
    JudgeBeacon(*before, received, options, &peer->trust, trust);
  }
  if (before != nullptr && IsDoubted(peer->trust, received.received)) return;
  peer->out_of_reach = true;
  peer->waiting_count = 0;  // all older than this one
}

BeaconRefusal PeerTable::Take(const ReceivedBeacon& received, const Self& self,
                              const VehicleOptions& options, BeaconCounters* counters,
                              TrustCounters* trust) {
  const Beacon& beacon = received.beacon;
  ++counters->taken;
  const auto refuse = [&](std::uint32_t BeaconCounters::*counter, BeaconRefusal why) {
    ++(counters->*counter);
    last_rejected_ = beacon.vehicle;
    return why;
  };
  const bool own = beacon.vehicle == self.id && !MutantActive(Mutant::kOwnBeaconHeard);
  if (own) return refuse(&BeaconCounters::rejected_own, BeaconRefusal::kOwn);
  if (!received.name_valid)
    return refuse(&BeaconCounters::rejected_wrong_name, BeaconRefusal::kWrongName);
  if (!received.crc_valid) return refuse(&BeaconCounters::rejected_crc, BeaconRefusal::kCrc);
  if (!received.in_range && !IsInRange(beacon)) {
    return IsFinite(beacon)
               ? refuse(&BeaconCounters::rejected_out_of_range, BeaconRefusal::kOutOfRange)
               : refuse(&BeaconCounters::rejected_not_finite, BeaconRefusal::kNotFinite);
  }
  // Before either has heard the world, positions have no common frame to be near in. Nor does one
  // that has had no scan yet say anything of now.
  if (self.epoch == kNoEpoch || beacon.world_epoch == kNoEpoch || beacon.tick == kNoTick) {
    ++counters->not_heard;
    return BeaconRefusal::kNone;
  }
  if (beacon.world_epoch != self.epoch) {
    return refuse(&BeaconCounters::rejected_wrong_epoch, BeaconRefusal::kWrongEpoch);
  }
  // Before anything is noted of its writer: a time that far ahead would hold for as long.
  if (self.tick != kNoTick && beacon.tick > After(self.tick, kMostTicksAhead)) {
    return refuse(&BeaconCounters::rejected_out_of_range, BeaconRefusal::kOutOfRange);
  }

  const Vec2 apart = beacon.world_from_body.position_world - self.position_world;
  const bool heard = SquaredNorm(apart) <= options.emission_radius_m * options.emission_radius_m;
  if (!heard) {
    ++counters->not_heard;
    Peer* peer = Find(beacon.vehicle);
    const bool newer = peer != nullptr && peer->writer == received.writer &&
                       peer->boot_epoch == beacon.boot_epoch && beacon.seq > peer->last_seq;
    if (newer) NoteBeyond(peer, received, options, trust);
    return BeaconRefusal::kNone;
  }
  Peer* peer = FindOrInsert(beacon.vehicle);
  if (peer == nullptr)
    return refuse(&BeaconCounters::rejected_table_full, BeaconRefusal::kTableFull);
  if (!BelongsTo(peer, received))
    return refuse(&BeaconCounters::rejected_duplicate_id, BeaconRefusal::kDuplicateId);
  if (peer->boot_epoch != 0) {  // it has spoken before
    const bool replayed = beacon.boot_epoch != peer->boot_epoch || beacon.seq <= peer->last_seq;
    if (replayed) return refuse(&BeaconCounters::rejected_replayed, BeaconRefusal::kReplayed);
    counters->lost += beacon.seq - peer->last_seq - 1;
  }
  ++counters->accepted;
  if (const Beacon* before = LastBeaconOf(*peer)) {
    JudgeBeacon(*before, received, options, &peer->trust, trust);
  }
  Store(peer, received, self.tick);
  return BeaconRefusal::kNone;
}

void PeerTable::Note(const QosEvent& event, QosCounters* counters) {
  Peer* peer = Find(event.vehicle);
  switch (event.kind) {
    case QosEventKind::kDeadlineMissed:
      // A leave notice is no miss, and a miss is an edge: one until the next accepted beacon.
      if (peer == nullptr || peer->left || peer->deadline_missed) return;
      ++counters->deadline_missed;
      last_deadline_missed_ = event.vehicle;
      peer->deadline_missed = true;
      return;
    case QosEventKind::kLivelinessLost:
      if (peer == nullptr || peer->left || peer->liveliness_lost) return;
      ++counters->liveliness_lost;
      last_liveliness_lost_ = event.vehicle;
      peer->liveliness_lost = true;
      return;
    case QosEventKind::kIncompatibleQos:
      ++counters->incompatible_qos;
      return;
    case QosEventKind::kMatched:
      ++counters->matched;
      return;
    case QosEventKind::kUnmatched:
      ++counters->unmatched;
      return;
    case QosEventKind::kSampleLost:      // the numbers of the beacons that arrive say how many
    case QosEventKind::kLivelinessBack:  // its next beacon says more
      return;
  }
}

void PeerTable::Advance(SteadyTime now, Tick tick) {
  std::erase_if(peers_, [now](const Peer& peer) { return now - peer.spoke > kForgetAfter; });
  for (Peer& peer : Peers()) {
    while (peer.waiting_count > 0 && peer.waiting[0].tick < tick) {
      peer.beacon = peer.waiting[0];
      peer.received = peer.waiting_received[0];
      peer.known = true;
      peer.out_of_reach = false;
      peer.waiting[0] = peer.waiting[1];
      peer.waiting_received[0] = peer.waiting_received[1];
      --peer.waiting_count;
    }
  }
}

void PeerTable::LeaveWorld() {
  for (Peer& peer : Peers()) {
    peer.known = false;
    peer.waiting_count = 0;
    peer.out_of_reach = false;
    peer.encounter = {};
    peer.trust = {};
  }
}

Nanoseconds Age(const Peer& peer, SteadyTime now, Tick tick, Nanoseconds tick_period) {
  // One tick behind is what every decision works with; only ticks beyond it are age.
  const std::uint32_t behind = TicksBetween(After(peer.beacon.tick, 1), tick);
  return std::max(now - peer.received, behind * tick_period);
}

bool IsFresh(const Peer& peer, SteadyTime now, Tick tick, const VehicleOptions& options) {
  if (MutantActive(Mutant::kStaleBeaconTrusted)) return peer.known && !peer.left;
  const bool doubtful = peer.left || peer.rivalled || peer.deadline_missed ||
                        peer.liveliness_lost || peer.out_of_reach;
  return peer.known && !doubtful &&
         Age(peer, now, tick, options.tick_period) <= options.beacon_age_limit;
}

bool IsGone(const Peer& peer) { return peer.left || peer.out_of_reach; }

bool IsLost(const Peer& peer, bool fresh) {
  if (MutantActive(Mutant::kLostPeerForgotten)) return false;
  return peer.known && !fresh && !IsGone(peer);
}

void PeerTable::AddTo(StateHash* hash) const {
  hash->Add(static_cast<std::uint32_t>(peers_.size()));
  for (const Peer& peer : Peers()) {
    hash->Add(peer.id);
    hash->Add(peer.known);
    hash->Add(peer.received.count());
    hash->Add(peer.spoke.count());
    hash->Add(peer.boot_epoch);
    hash->Add(peer.last_seq);
    hash->Add(peer.waiting_count);
    hash->Add(peer.beacon.tick);
    hash->Add(peer.beacon.world_from_body.position_world.x);
    hash->Add(peer.beacon.world_from_body.position_world.y);
    hash->Add(peer.beacon.world_from_body.heading_rad);
    hash->Add(peer.beacon.gives_way_to);
    hash->Add(peer.rivalled);
    hash->Add(peer.deadline_missed);
    hash->Add(peer.liveliness_lost);
    hash->Add(peer.left);
    hash->Add(peer.out_of_reach);
    hash->Add(peer.encounter.active);
    hash->Add(peer.encounter.holds);
    hash->Add(peer.encounter.lost);
    hash->Add(peer.encounter.released);
    if (peer.encounter.entered) hash->Add(peer.encounter.entered);
    if (peer.trust.ever_doubted) hash->Add(peer.trust.doubted_at.count());
  }
}

}  // namespace giveway
