// What a vehicle reports of itself: gathers brain, link and timing into a VehicleStatus.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "services/accounting/beacon_ledger.h"
#include "services/health/heap_in_use.h"
#include "services/link/drive_link.h"
#include "services/timing/drive_timing.h"
#include "services/types/impairment.h"
#include "services/vehicle/vehicle.h"

namespace giveway {

// "give_way to 1 (cooperative)", for log lines.
std::string Describe(const Decision& decision);

// "deadline_missed: vehicle 2", for log lines.
std::string Describe(const QosEvent& event);

// What was injected into what a vehicle heard, one line of name=number.
std::string Describe(const ImpairmentCounters& counters);

// "31 cm driven of 35 cm free before the wheels obeyed", for log lines.
std::string Describe(const ReactionMargin& margin);

// The link counters that fleet/status does not carry, one line of name=number.
std::string Describe(const link::VehicleLinkCounters& counters);

class VehicleReport {
 public:
  // What its allocator has in use, in bytes.
  using Heap = std::function<std::optional<std::uint64_t>()>;
  // Asking costs by pieces of free memory, and a status may be due each tick.
  static constexpr Nanoseconds kHeapEvery = std::chrono::seconds(1);

  explicit VehicleReport(const VehicleOptions& options, Heap heap = HeapInUse)
      : timing_(options), heap_(std::move(heap)) {}

  // `step` is the processor time of Vehicle::Step, `turn` the time from waking on a scan to the
  // command sent.
  void NoteStep(Nanoseconds step, Nanoseconds turn);
  // A reaction that spent its budget, if one ended with this turn.
  std::optional<ReactionMargin> NoteTurn(const TurnSeen& turn) { return timing_.Note(turn); }
  // What became of the beacons of a step: fates[i] of beacons[i].
  void NoteBeacons(std::span<const ReceivedBeacon> beacons, std::span<const BeaconFate> fates) {
    ledger_.Note(beacons, fates);
  }
  void NoteLeft(std::span<const std::uint64_t> writers) { ledger_.NoteLeft(writers); }
  // It drives by other options from now on.
  void Reseat(const VehicleOptions& options) { timing_.Reseat(options); }
  void NoteEvents(std::span<const QosEvent> events);
  // Sends it to the fleet, and gives back what it sent.
  VehicleStatus Send(const Vehicle& vehicle, link::DriveLink& link, SteadyTime now);
  void SendFinal(const Vehicle& vehicle, link::DriveLink& link);

 private:
  VehicleStatus Gather(const Vehicle& vehicle, const link::DriveLink& link);
  double StepP99Us();
  void AskForHeap(SteadyTime now);

  DriveTiming timing_;
  BeaconLedger ledger_;
  std::vector<double> steps_us_;  // the last kKeptSteps, in a ring
  std::vector<double> sorted_;
  std::size_t next_ = 0;
  double longest_turn_ms_ = 0;
  std::optional<QosEvent> last_event_;
  Heap heap_;
  std::optional<std::uint64_t> heap_bytes_;  // when it was last asked for
  SteadyTime next_heap_{0};
};

}  // namespace giveway
