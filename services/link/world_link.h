// The world's side: drains joins and motor commands, sends what the vehicles sense, the roster,
// signals, truth and events.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "services/link/admin_link.h"
#include "services/link/fastdds/link_options.h"
#include "services/link/service_options.h"
#include "services/types/figures/drive_figures.h"
#include "services/types/fleet_facts.h"
#include "services/types/motor_command.h"
#include "services/types/range_scan.h"
#include "services/types/refusal.h"
#include "services/types/sensor_scan.h"
#include "services/types/signal.h"
#include "services/types/time.h"

namespace giveway::link {

struct WorldLinkCounters {
  std::uint32_t commands_taken = 0;
  std::uint32_t commands_wrong_name = 0;  // id is not the one of the writer's partition
  std::uint32_t commands_unbound = 0;     // writer's partition not yet known
  std::uint32_t commands_not_finite = 0;  // or out of range, or with an enumerator unknown here
  std::uint32_t commands_strangers = 0;   // not of the participant that joined as the vehicle
  std::uint32_t joins_refused = 0;        // without a session, of another's, or too many
  std::uint32_t orders_refused = 0;       // of a writer that names too many vehicles
  std::uint32_t write_failures = 0;
  // From publishing to being taken, us, by the wall clocks of both hosts: outside of lockstep the
  // tick that applies a command starts with taking it. Of each command that was not refused.
  FigureSummary command_latency;
};

class WorldLink final : public AdminLink {
 public:
  // Throws LinkError.
  explicit WorldLink(const LinkOptions& options, const ServiceOptions& service = {});
  ~WorldLink();
  WorldLink(const WorldLink&) = delete;
  WorldLink& operator=(const WorldLink&) = delete;

  // The first twelve bytes of the GUIDs of all that is made here, hexadecimal.
  std::string ParticipantText() const;
  // One sentence while discovery servers are to be used and none has answered; else empty.
  std::string WhyNoPeerIsFound() const;
  // What changed of the network interfaces since this link was made, if it can no longer receive
  // for that reason; else empty. Throws LinkError.
  std::string InterfaceChange() const;
  // Whether its shared memory was deleted: participants that start later do not receive this world.
  bool SharedMemoryIsGone();

  // Makes the writers of the vehicle's ranges and of the sensors its profile is fitted with.
  // Nothing if they are there.
  void OpenVehicle(VehicleId vehicle, const RobotModel& profile);
  void OpenRanges(VehicleId vehicle) { OpenVehicle(vehicle, RobotModel{}); }
  // The vehicle left: ends its writers and takes its roster entry back. It may come again, and may
  // not be sent scans until then. Nothing if it is not open.
  void CloseVehicle(VehicleId vehicle);
  // Nothing more is published about the vehicle, unless it comes again.
  void ForgetVehicle(VehicleId vehicle);
  // True once each of the vehicle's writers has a reader and its command writer is matched.
  bool IsMatched(VehicleId vehicle) const;

  // The newest request of each session, those that leave first: newcomers may want their ids. Of a
  // session only requests of the participant that owns it count, see session_owners.h.
  std::vector<JoinRequest> TakeJoins();
  // Everything that came since the last call, each vehicle's in order of arrival; the span holds
  // until the next call. For a vehicle that was accepted only its owner commands.
  std::span<const MotorCommand> TakeCommands();
  // The first few requests, commands and orders refused since the last call, with what is wrong
  // with them.
  std::vector<Refusal> TakeRefusals();
  // Of endpoints found about a second ago, those that should match one of ours and do not, and why:
  // a line each. Meant for the log.
  std::vector<std::string> TakeUnfit(SteadyTime now);
  // Waits until a command is there or `timeout` has passed. For lockstep.
  bool WaitForCommands(Nanoseconds timeout);

  void SendRoster(const RosterEntry& entry);
  // A vehicle wakes on its ranges, so they go last of what belongs to one tick.
  void SendSignal(const SignalState& state);
  void SendRadar(const RadarScan& scan);
  void SendLidar(const LidarScan& scan);
  void SendCamera(const CameraScan& scan);
  void SendPoseFix(const PoseFix& fix);
  void SendScan(const RangeScan& scan);
  void SendTruth(const Truth& truth);
  void SendEvent(const WorldEvent& event);
  void SendFigures(const RunFigures& figures);
  // Orders to the world are addressed to kNoVehicle, and so are its answers from it.
  std::vector<AdminRequest> TakeAdminRequests() override;
  void SendAnswer(const AdminAnswer& answer) override;
  void FlushAnswer(Nanoseconds timeout);
  std::vector<LiveValue> LiveQos() const override;
  bool SetDeadline(const std::string& profile, std::int64_t deadline) override;

  // Waits until matched readers have every event, roster entry and the figures, or `timeout`.
  void Flush(Nanoseconds timeout);

  WorldLinkCounters Counters() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace giveway::link
