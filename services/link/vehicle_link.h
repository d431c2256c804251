// A vehicle's side of the fleet: joins, then drains beacons, sensors, signals and QoS events into
// Inputs and sends Outputs. Knows Fast DDS, decides nothing. One thread; Fast DDS's own threads
// only queue.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/link/admin_link.h"
#include "services/link/drive_link.h"
#include "services/link/fastdds/link_options.h"
#include "services/link/service_options.h"
#include "services/types/admin.h"
#include "services/types/fleet_facts.h"
#include "services/types/impairment.h"
#include "services/types/robot_model.h"
#include "services/types/vehicle_io.h"

namespace giveway::link {

class VehicleLink final : public AdminLink, public DriveLink {
 public:
  // Makes the participant and the joining endpoints. Throws LinkError.
  explicit VehicleLink(const LinkOptions& options, const ServiceOptions& service = {});
  ~VehicleLink();
  VehicleLink(const VehicleLink&) = delete;
  VehicleLink& operator=(const VehicleLink&) = delete;

  // The first twelve bytes of the GUIDs of all that is made here, hexadecimal.
  std::string ParticipantText() const;
  std::string WhyNoPeerIsFound() const override;

  void SendJoin(const JoinRequest& request) override;
  void FlushJoin(Nanoseconds timeout) override;
  void SendLeave(const SessionId& session) override;
  std::optional<RosterEntry> TakeRoster(const SessionId& session) override;

  // Makes every other endpoint, named after `id`: readers for the sensors the profile is fitted
  // with, and for signals if there are any. Once. Throws LinkError. From now on the join request
  // kept for later worlds asks for `id`, and Take delivers the roster entries of the session.
  void Open(VehicleId id, const RobotModel& profile, bool signals);
  void Open(VehicleId id) { Open(id, RobotModel{}, false); }

  // Those of a loop are for after Open.
  bool WaitForScan(Nanoseconds timeout) override;
  Taken Take(SteadyTime now) override;
  std::vector<std::string> TakeUnfit(SteadyTime now) override;
  void Send(const Outputs& outputs) override;
  void SendStatus(const VehicleStatus& status) override;
  void FlushStatus(Nanoseconds timeout) override;
  std::string InterfaceChange() const override;
  bool SharedMemoryIsGone() override;
  bool WorldSpeaks() const override;
  bool LacksBody() const override;
  VehicleLinkCounters Counters() const override;
  EffectiveBeaconQos BeaconQos() const override;
  std::optional<SteadyTime> BlackoutsSince() const override;

  std::vector<AdminRequest> TakeAdminRequests() override;
  void SendAnswer(const AdminAnswer& answer) override;
  void FlushAnswer(Nanoseconds timeout) override;
  std::vector<LiveValue> LiveQos() const override;
  bool SetDeadline(const std::string& profile, std::int64_t deadline) override;

  // What was injected into what this vehicle hears; nothing where no impairment was asked for.
  std::optional<ImpairmentCounters> Impaired() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace giveway::link
