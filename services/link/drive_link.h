// What a vehicle's control loop drives over: how it hears the fleet and its world, and speaks to
// them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/types/fleet_facts.h"
#include "services/types/impairment.h"
#include "services/types/refusal.h"
#include "services/types/vehicle_io.h"

namespace giveway::link {

// What one drain found. What `inputs` points to is in the link and holds until the next Take.
struct Taken {
  Inputs inputs;
  std::uint32_t scans_skipped = 0;  // scans overwritten by a newer one in the same drain
  // The first few samples that are broken, misnamed, unreadable, out of range or a stranger's, with
  // what is wrong with them.
  std::span<const Refusal> refusals;
  // From publishing to reception, by the wall clocks of both hosts: the longest of the beacons, and
  // the newest scan. Nothing where no sample came, or none says when it was published.
  std::optional<Nanoseconds> beacon_latency;
  std::optional<Nanoseconds> scan_latency;
  // Writers, of whatever topic, that have left: their identities, as beacons name them.
  std::span<const std::uint64_t> left;
};

// Counters of the link alone; the brain counts what it accepts and refuses.
struct VehicleLinkCounters {
  // Beacons that arrived and were overwritten in the reader before a drain: gaps in the writers'
  // own sequence numbers less what the library's sample-lost status says never arrived.
  std::uint32_t beacons_superseded = 0;
  RefusedSamples refused;                   // dropped
  std::uint32_t events_dropped = 0;         // the event queue was full
  std::uint32_t deadline_watches_lost = 0;  // the library stopped watching a reader's deadlines
  std::uint32_t write_failures = 0;
  std::uint32_t matched_peers = 0;   // beacon writers matched now, own excluded
  std::uint32_t ranges_skipped = 0;  // overwritten by a newer scan in the same drain
  // Edges: once until the next scan; of signals, once a head until it is heard again.
  std::uint32_t ranges_deadline_missed = 0;
  std::uint32_t sensors_deadline_missed = 0;  // radar, lidar, camera
  std::uint32_t signals_deadline_missed = 0;
  ImpairmentCounters impaired;  // all 0 where nothing is
};

// QoS of the beacon endpoints as the library resolved it, milliseconds.
struct EffectiveBeaconQos {
  double deadline_offered_ms = 0;
  double deadline_requested_ms = 0;
  double lease_ms = 0;
};

class DriveLink {
 public:
  // Waits until a scan is there or `timeout` has passed. True if a scan is there.
  virtual bool WaitForScan(Nanoseconds timeout) = 0;
  // Drains everything. `now` is stamped on what came.
  virtual Taken Take(SteadyTime now) = 0;
  // Of endpoints found about a second ago, those that should match one of ours and do not, and why:
  // a line each. Meant for the log.
  virtual std::vector<std::string> TakeUnfit(SteadyTime now) = 0;
  // Sends beacon and command; a failed write is counted.
  virtual void Send(const Outputs& outputs) = 0;
  virtual void SendStatus(const VehicleStatus& status) = 0;
  // Waits until every matched observer has the last status, or `timeout`.
  virtual void FlushStatus(Nanoseconds timeout) = 0;
  // Waits until every matched operator has the last answer to an order, or `timeout`.
  virtual void FlushAnswer(Nanoseconds timeout) = 0;

  // Kept for worlds that start later: each of them finds the newest request of a session.
  virtual void SendJoin(const JoinRequest& request) = 0;
  // Waits until every matched world has the last request, or `timeout`.
  virtual void FlushJoin(Nanoseconds timeout) = 0;
  // The newest roster entry of this session, if one has come since the last call. `session` is that
  // of the last request. Before the loop.
  virtual std::optional<RosterEntry> TakeRoster(const SessionId& session) = 0;
  // One sentence while discovery servers are to be used and none has answered; else empty.
  virtual std::string WhyNoPeerIsFound() const = 0;
  // Gives the id back. Closing the link waits for a world to have heard it, but not later than a
  // moment after this call.
  virtual void SendLeave(const SessionId& session) = 0;

  // What changed of the network interfaces since this link was made, if it can no longer receive
  // for that reason; else empty. Throws LinkError.
  virtual std::string InterfaceChange() const = 0;
  // Whether its shared memory was deleted: participants that start later do not receive this
  // vehicle.
  virtual bool SharedMemoryIsGone() = 0;
  // Whether the writer of this vehicle's ranges is matched and alive, whatever comes of its
  // samples.
  virtual bool WorldSpeaks() const = 0;
  // Whether the world is there and has no writer of this vehicle's ranges: it took the body away,
  // or never had it.
  virtual bool LacksBody() const = 0;

  virtual VehicleLinkCounters Counters() const = 0;
  virtual EffectiveBeaconQos BeaconQos() const = 0;
  // From when on this vehicle's blackouts are counted; nothing before the start signal, or where no
  // impairment was asked for.
  virtual std::optional<SteadyTime> BlackoutsSince() const = 0;

 protected:
  ~DriveLink() = default;
};

}  // namespace giveway::link
