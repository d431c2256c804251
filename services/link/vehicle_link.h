// A vehicle's side of the fleet: joins, then drains beacons, sensors, signals and QoS events into
// Inputs and sends Outputs. Knows Fast DDS, decides nothing. One thread; Fast DDS's own threads
// only queue.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/link/admin_link.h"
#include "services/link/fastdds/link_options.h"
#include "services/link/resolved_qos.h"
#include "services/types/admin.h"
#include "services/types/fleet_facts.h"
#include "services/types/impairment.h"
#include "services/types/refusal.h"
#include "services/types/vehicle_io.h"

namespace giveway::link {

// What one drain found. What `inputs` points to is in the link and holds until the next Take.
struct Taken {
  Inputs inputs;
  std::uint32_t scans_skipped = 0;  // scans overwritten by a newer one in the same drain
  // The first few beacons that are broken, misnamed or unreadable, with what is wrong with them.
  std::span<const Refusal> refusals;
};

// Counters of the link alone; the brain counts what it accepts and refuses.
struct VehicleLinkCounters {
  // Beacons that arrived and were overwritten in the reader before a drain: gaps in the writers'
  // own sequence numbers less what the library's sample-lost status says never arrived.
  std::uint32_t beacons_superseded = 0;
  std::uint32_t unbound_samples = 0;        // writer's partition not yet known: dropped
  std::uint32_t unreadable_samples = 0;     // arrived, but say what cannot be told: dropped
  std::uint32_t wrong_name_scans = 0;       // of a sensor, whose id is not this vehicle's
  std::uint32_t old_world_entries = 0;      // roster of a world after another had taken over
  std::uint32_t events_dropped = 0;         // the event queue was full
  std::uint32_t deadline_watches_lost = 0;  // the library stopped watching a reader's deadlines
  std::uint32_t write_failures = 0;
  std::uint32_t matched_peers = 0;   // beacon writers matched now, own excluded
  std::uint32_t ranges_skipped = 0;  // overwritten by a newer scan in the same drain
  // Edges: once until the next scan; of signals, once a head until it is heard again.
  std::uint32_t ranges_deadline_missed = 0;
  std::uint32_t sensors_deadline_missed = 0;  // radar, lidar, camera
  std::uint32_t signals_deadline_missed = 0;
};

// QoS of the beacon endpoints as the library resolved it, milliseconds.
struct EffectiveBeaconQos {
  double deadline_offered_ms = 0;
  double deadline_requested_ms = 0;
  double lease_ms = 0;
};

class VehicleLink final : public AdminLink {
 public:
  // Makes the participant and the joining endpoints. Throws LinkError.
  explicit VehicleLink(const LinkOptions& options);
  ~VehicleLink();
  VehicleLink(const VehicleLink&) = delete;
  VehicleLink& operator=(const VehicleLink&) = delete;

  // The first twelve bytes of the GUIDs of all that is made here, hexadecimal.
  std::string ParticipantText() const;
  // One sentence while discovery servers are to be used and none has answered; else empty.
  std::string WhyNobodyIsFound() const;

  // What changed of the network interfaces since this link was made, where that leaves it deaf;
  // else empty. Throws LinkError.
  std::string InterfaceChange() const;
  // Whether the writer of this vehicle's ranges is matched and alive, whatever comes of its
  // samples.
  bool WorldSpeaks() const;

  // Kept for worlds that start later: each of them finds the newest request of a session.
  void SendJoin(const JoinRequest& request);
  // Waits until every matched world has the last request, or `timeout`.
  void FlushJoin(Nanoseconds timeout);
  // The newest roster entry of this session, if one has come since the last call. `session` is that
  // of the last request.
  std::optional<RosterEntry> TakeRoster(const SessionId& session);
  // Gives the id back. Closing the link waits for a world to have heard it, but not later than a
  // moment after this call.
  void SendLeave(const SessionId& session);

  // Makes every other endpoint, named after `id`: readers for the sensors the profile is fitted
  // with, and for signals if there are any. Once. Throws LinkError. From now on the join request
  // kept for later worlds asks for `id`, and Take tells what the world says about the session.
  void Open(VehicleId id, const VehicleProfile& profile, bool signals);
  void Open(VehicleId id) { Open(id, VehicleProfile{}, false); }

  // Of endpoints found about a second ago, those that should match one of ours and do not, and why:
  // a line each. Meant for the log.
  std::vector<std::string> TakeUnfit(SteadyTime now);

  // Waits until a scan is there or `timeout` has passed. True if a scan is there.
  bool WaitForScan(Nanoseconds timeout);
  // Drains everything. `now` is stamped on what came.
  Taken Take(SteadyTime now);
  // Sends beacon and command; a failed write is counted.
  void Send(const Outputs& outputs);
  void SendStatus(const VehicleStatus& status);
  // Waits until every matched observer has the last status, or `timeout`.
  void FlushStatus(Nanoseconds timeout);

  std::vector<AdminOrder> TakeOrders() override;
  void SendAnswer(const AdminAnswer& answer) override;
  // Waits until every matched operator has the last answer, or `timeout`.
  void FlushAnswer(Nanoseconds timeout);
  std::vector<LiveValue> LiveQos() const override;
  bool SetDeadline(const std::string& profile, std::int64_t deadline) override;

  VehicleLinkCounters Counters() const;
  EffectiveBeaconQos BeaconQos() const;
  // What was injected into what this vehicle hears; nothing where no impairment was asked for.
  std::optional<ImpairmentCounters> Impaired() const;
  // From when on this vehicle's blackouts are counted; nothing before the start signal, or where no
  // impairment was asked for.
  std::optional<SteadyTime> BlackoutsSince() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace giveway::link
