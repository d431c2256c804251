// What an observer learns of a fleet under faults: who drives, which fault had which effect, how
// soon the peers noticed it, and how soon all was well again. Folds what the link and the logs
// bring; bounded by the fleet and the schedule, however long it lasts. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/faults/fault.h"
#include "services/fleetctl/soak/soak_seen.h"
#include "services/fleetctl/stopwatch/stopwatch_words.h"
#include "services/link/observer_link.h"
#include "services/types/fleet_facts.h"

namespace giveway::fleetctl {

// Drives, or stands for a reason that traffic has: ranges are fresh, and no peer it must hear is
// missing.
bool IsWell(const VehicleStatus& status);

class SoakWatch {
 public:
  // What was heard last of a vehicle counts for so long.
  static constexpr Nanoseconds kFresh = std::chrono::seconds(1);

  // `schedule` outlives this.
  SoakWatch(std::vector<VehicleId> fleet, std::span<const faults::Fault> schedule);

  void Fold(const link::Observed& observed, SteadyTime now);
  // A word of a vehicle's log.
  void Fold(VehicleId by, const Word& word);
  void NoteBegin(std::size_t fault, SteadyTime now);
  void NoteEnd(std::size_t fault, SteadyTime now);
  // The supervisor saw it happen. The first words stay.
  void NoteEffect(std::size_t fault, std::string effect);
  // Of a process that is meant to be gone nothing is expected; a new one has everything to report
  // again.
  void SetAway(VehicleId vehicle, bool away);

  bool HasStarted() const { return started_.has_value(); }
  // Seconds since the start signal; 0 before it.
  double TimeSeconds(SteadyTime now) const;
  bool IsWell(VehicleId vehicle, SteadyTime now) const;
  // Every vehicle that is not away. False where none is left.
  bool AreAllWell(SteadyTime now) const;
  // Who is not, and not away.
  std::vector<VehicleId> Unwell(SteadyTime now) const;
  std::uint32_t Living() const;
  std::span<const FaultCourse> Courses() const { return courses_; }
  // Those that have started and of which something may still be learnt, in the order they started.
  // All that is done every turn is done for these: a schedule of weeks has half a million faults.
  std::span<const std::size_t> Open() const { return open_; }
  double HighestStepP99_us(VehicleId vehicle) const;
  const VehicleStatus* StatusOf(VehicleId vehicle) const;
  // When the newest was received; 0 before the first.
  SteadyTime StatusAt(VehicleId vehicle) const;
  const Truth* TruthOf(VehicleId vehicle) const;
  std::uint64_t StatusesRefused() const { return refused_; }

 private:
  struct View {
    std::optional<VehicleStatus> status;
    SteadyTime status_at{0};
    std::optional<Truth> truth;
    bool away = false;
    double step_p99_us = 0;
  };

  void FoldStatus(const VehicleStatus& status, SteadyTime now);
  void FoldEvent(const WorldEvent& event);
  void SeekEffect(std::size_t fault, const VehicleStatus& status);
  void SeekRecovery(SteadyTime now);
  void CloseSettled(SteadyTime now);
  bool Concerns(const faults::Fault& fault, VehicleId vehicle) const;

  std::span<const faults::Fault> schedule_;
  std::map<VehicleId, View> views_;
  std::vector<FaultCourse> courses_;
  // As the fault started, by vehicle: what its effect is measured from. Of open ones alone.
  std::vector<std::map<VehicleId, VehicleStatus>> before_;
  std::vector<std::size_t> open_;
  std::optional<SteadyTime> started_;
  std::uint64_t refused_ = 0;
};

}  // namespace giveway::fleetctl
