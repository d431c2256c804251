// What this vehicle knows of the others: one entry a vehicle id, at most kMaxPeers. Takes in
// beacons and QoS events, refuses and counts invalid ones, and says which peers are fresh. Its
// only clock is the receiver's, passed in. Decides nothing.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "services/types/beacon.h"
#include "services/types/counters.h"
#include "services/types/qos_event.h"
#include "services/types/state_hash.h"
#include "services/types/vehicle_options.h"
#include "services/vehicle/estimation/trust.h"

namespace giveway {

// Bounds what an intruder with many ids can fill.
inline constexpr std::uint32_t kMaxPeers = 1024;

// Where this vehicle stands in an encounter with one peer.
struct Encounter {
  bool active = false;
  bool holds = false;     // this vehicle stops, or stands, because of the peer
  bool clears = false;    // this vehicle was blocking the peer: it drives out instead of holding
  bool lost = false;      // the peer fell silent while the encounter was active
  bool released = false;  // lost, the waiting time is over, and the own ranges show the path clear
  bool entered = false;   // too far to stop, or in the conflict: it drives through
  SteadyTime lost_at{0};
  double lost_wait_s = 0;  // how long the silent peer may take to pass at its cruise speed
};

// What every step looks at comes first, what waits last: few cache lines a peer are ever touched.
struct Peer {
  VehicleId id = kNoVehicle;
  std::uint32_t boot_epoch = 0;
  std::uint64_t writer = 0;  // the endpoint that speaks for this id
  std::uint32_t last_seq = 0;
  std::uint32_t waiting_count = 0;
  SteadyTime spoke{0};        // last beacon of `writer`, accepted or not
  SteadyTime rival_spoke{0};  // last beacon of another writer for the same id
  SteadyTime received{0};     // of `beacon`
  bool known = false;         // `beacon` is valid
  bool rivalled = false;      // two writers spoke within one lease: both are distrusted

  bool deadline_missed = false;  // since the last accepted beacon
  bool liveliness_lost = false;  // since the last accepted beacon
  bool left = false;             // sent a leave notice: a departure, not a loss
  bool out_of_reach = false;     // `beacon` was followed by one from beyond the emission radius
  Encounter encounter;
  PeerTrust trust;
  CachedHeading stated_heading;     // of a recent beacon
  Beacon beacon;                    // newest of a tick before this vehicle's
  std::array<Beacon, 2> waiting{};  // of this tick or later, older first
  std::array<SteadyTime, 2> waiting_received{};
};

// Why a beacon was not taken in; in the order of BeaconCounters.
enum class BeaconRefusal : std::uint8_t {
  kNone,
  kNotFinite,
  kOutOfRange,
  kCrc,
  kReplayed,
  kOwn,
  kWrongName,
  kDuplicateId,
  kWrongEpoch,
  kTableFull,
};

// What the table needs to know of its owner.
struct Self {
  VehicleId id = kNoVehicle;
  WorldEpoch epoch = kNoEpoch;
  Tick tick = kNoTick;
  Vec2 position_world;
};

class PeerTable {
 public:
  // Accepts one beacon or refuses it; exactly one counter of `counters` besides `taken` moves. One
  // that does not fit the one before is accepted, counted in `trust`, and its sender doubted.
  BeaconRefusal Take(const ReceivedBeacon& received, const Self& self,
                     const VehicleOptions& options, BeaconCounters* counters, TrustCounters* trust);
  // Notes what the middleware says. Only ever makes a peer less believed.
  void Note(const QosEvent& event, QosCounters* counters);
  // Moves waiting beacons of ticks before `tick` up, and drops peers silent for kForgetAfter.
  void Advance(SteadyTime now, Tick tick);
  // Forgets where the peers were; id owners and how far they counted stay.
  void LeaveWorld();

  std::span<Peer> Peers() { return peers_; }
  std::span<const Peer> Peers() const { return peers_; }
  Peer* Find(VehicleId id);

  VehicleId LastDeadlineMissed() const { return last_deadline_missed_; }
  VehicleId LastLivelinessLost() const { return last_liveliness_lost_; }
  // The id claimed by the last refused beacon.
  VehicleId LastRejected() const { return last_rejected_; }

  void AddTo(StateHash* hash) const;

 private:
  friend struct StateFields;  // services/snapshot
  Peer* FindOrInsert(VehicleId id);
  bool BelongsTo(Peer* peer, const ReceivedBeacon& received);
  void Store(Peer* peer, const ReceivedBeacon& received, Tick tick);
  void NoteBeyond(Peer* peer, const ReceivedBeacon& received, const VehicleOptions& options,
                  TrustCounters* trust);

  std::vector<Peer>::iterator PlaceOf(VehicleId id);

  std::vector<Peer> peers_;  // sorted by id
  VehicleId last_deadline_missed_ = kNoVehicle;
  VehicleId last_liveliness_lost_ = kNoVehicle;
  VehicleId last_rejected_ = kNoVehicle;
};

// The lease after which another writer may speak for a silent one's id.
inline constexpr Nanoseconds kWriterLease{250'000'000};
// By so much a beacon may be ahead of the receiver's last scan. Peers may get theirs earlier; but
// one that has had none for so long halts, whatever they say.
inline constexpr std::uint32_t kMostTicksAhead = 20;
// A peer that has not been heard for this long is forgotten.
inline constexpr Nanoseconds kForgetAfter{30'000'000'000};

// Age of the peer's newest usable beacon: the greater of receiver's clock and ticks behind.
Nanoseconds Age(const Peer& peer, SteadyTime now, Tick tick, Nanoseconds tick_period);

// True if what the peer says may be used to decide: young enough, alive, and spoken by one voice.
bool IsFresh(const Peer& peer, SteadyTime now, Tick tick, const VehicleOptions& options);

// True if it sent a leave notice or drove out of radio range: its position is unknown by now, and
// it is no loss.
bool IsGone(const Peer& peer);

// True if the peer should be heard and is not: it is not gone.
// `fresh` is whether it is.
bool IsLost(const Peer& peer, bool fresh);

}  // namespace giveway
