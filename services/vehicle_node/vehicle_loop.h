// giveway-vehicle's control loop: wires the brain to the link, turn by turn.
//
//   DriveLink::Take -> Inputs -> Vehicle::Step -> Outputs -> DriveLink::Send
//
// It wakes on its own ranges, or when the next beacon is due without them. Deciding is
// services/vehicle, talking is services/link.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "services/link/drive_link.h"
#include "services/recording/recorder.h"
#include "services/runtime/clock.h"
#include "services/types/handover.h"
#include "services/types/scenario.h"
#include "services/vehicle/vehicle.h"
#include "services/vehicle_node/reception_monitor.h"
#include "services/vehicle_node/vehicle_health.h"
#include "services/vehicle_node/vehicle_log.h"
#include "services/vehicle_node/vehicle_place.h"
#include "services/vehicle_node/vehicle_report.h"
#include "services/vehicle_node/world_time.h"

namespace giveway {

struct VehicleLoopOptions {
  bool lockstep = false;             // see world_time.h
  bool stays = false;                // outlives its world
  std::optional<Handover> handover;  // of the process before
};

// What the loop works with; all of it outlives the loop.
struct VehicleLoopParts {
  link::DriveLink* link = nullptr;
  Clock* clock = nullptr;
  VehicleHealthReporter* health = nullptr;
  Recorder* recorder = nullptr;              // null: nothing is recorded
  std::function<bool()> serve_orders;        // what an operator ordered; true if it takes a restart
  std::function<void()> on_first_scan = {};  // called once, after its answer is out; may be empty
};

enum class DriveEnd : std::uint8_t { kOver, kRefused, kRestarts, kScansLost };

class VehicleLoop {
 public:
  // The link was opened for the profile that the entry gives.
  VehicleLoop(const VehicleLoopParts& parts, const Scenario& scenario, const RosterEntry& entry,
              const VehicleLoopOptions& options);

  // Until the run has ended (unless it stays), `is_stopped`, the world refuses it, or an operator's
  // order or a place with other sensors takes a restart. Halts, and sends a leave notice if the run
  // continues without it: finally in the second case, in the last it keeps its place.
  DriveEnd Drive(const std::function<bool()>& is_stopped);
  const SessionId& Session() const { return place_.Entry().session; }
  VehicleId Id() const { return options_.id; }
  std::optional<Handover> HandOver() const { return vehicle_.HandOver(); }

 private:
  bool TakeOver(const Handover& handover);
  void Halt(const std::function<bool()>& is_stopped);
  void AskForTime();
  Nanoseconds Patience() const;
  void Turn(bool leaving);
  void KeepPlace(const link::Taken& taken, SteadyTime woke);
  void Follow(const RosterEntry& entry);
  bool Step(link::Taken* taken, SteadyTime woke, bool by_scan);
  void LogEvents(std::span<const QosEvent> events, SteadyTime woke);

  link::DriveLink& link_;
  Clock& clock_;
  VehicleHealthReporter& health_;
  Recorder* const recorder_;
  const std::function<bool()> serve_orders_;
  std::function<void()> on_first_scan_;
  const Scenario& scenario_;
  const bool lockstep_;
  VehiclePlace place_;
  VehicleOptions options_;
  const RobotModel opened_for_;  // the link has readers for its sensors, and gets no others
  const std::uint32_t boot_epoch_;
  Vehicle vehicle_;
  std::optional<RosterEntry> news_;  // that the brain has yet to hear
  bool restarts_ = false;
  ReceptionMonitor reception_;
  Remedy remedy_ = Remedy::kNone;
  VehicleReport report_;
  VehicleLog log_;
  SteadyTime last_scan_{0};
  SteadyTime last_turn_{0};
  SteadyTime next_status_{0};
  WorldTime world_time_;
};

}  // namespace giveway
