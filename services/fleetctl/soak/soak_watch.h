// What an observer learns of a fleet under faults: which vehicles drive, which fault had which
// effect, how soon the peers noticed it, and how soon all recovered. Folds the samples and the
// logs; bounded by the fleet and the schedule, for any duration. Pure.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "services/faults/fault.h"
#include "services/fleetctl/soak/soak_seen.h"
#include "services/fleetctl/stopwatch/stopwatch_log_events.h"
#include "services/link/observer_link.h"
#include "services/types/fleet_facts.h"

namespace giveway::fleetctl {

// Drives, or stands for a traffic reason: ranges are fresh, and no peer it must hear is missing.
bool IsWell(const VehicleStatus& status);

class SoakWatch {
 public:
  // The last sample of a vehicle is valid for this time.
  static constexpr Nanoseconds kFresh = std::chrono::seconds(1);

  // `schedule` outlives this.
  SoakWatch(const std::vector<VehicleId>& fleet, std::span<const faults::Fault> schedule);

  void Fold(const link::Observed& observed, SteadyTime now);
  // A line of a vehicle's log.
  void Fold(VehicleId by, const LogEvent& word);
  void NoteBegin(std::size_t fault, SteadyTime now);
  void NoteEnd(std::size_t fault, SteadyTime now);
  // It ended because the soak does, and before its time.
  void NoteCutOff(std::size_t fault) { courses_[fault].cut_off = true; }
  // The supervisor observed it. The first message stays.
  void NoteEffect(std::size_t fault, std::string effect);
  // What was seen of it later, where any effect was. As the first, it settles an earlier failure.
  void AddToEffect(std::size_t fault, const std::string& more);
  // There was nothing that it could act on, and why: no effect is missing then.
  void NoteMetNothing(std::size_t fault, std::string why) {
    courses_[fault].met_nothing = std::move(why);
  }
  // An attempt to inject it, or to undo it, failed; the last one is kept.
  void NoteFailure(std::size_t fault, std::string why) { courses_[fault].failure = std::move(why); }
  // An attempt to undo it failed. That fails the soak, unless a later one succeeds, or there is
  // `nothing` left that it could undo.
  void NoteNotUndone(std::size_t fault, std::string why, bool nothing) {
    NoteFailure(fault, std::move(why));
    courses_[fault].not_undone = !nothing;
  }
  using LongestPause = std::function<Nanoseconds(SteadyTime from, SteadyTime to)>;
  // How long the machine paused while peers had to report the open faults, of each once that time
  // and a second are over: what knows it forgets it long before the verdict.
  void NotePauses(const Limits& limits, SteadyTime now, const LongestPause& longest);
  // Nothing is expected of a process that is meant to be gone; a new one has to report everything
  // again.
  void SetAway(VehicleId vehicle, bool away);

  bool HasStarted() const { return started_.has_value(); }
  // Seconds since the start signal; 0 before it.
  double TimeSeconds(SteadyTime now) const;
  bool IsWell(VehicleId vehicle, SteadyTime now) const;
  // Every vehicle that is not away. False if none is left.
  bool AreAllWell(SteadyTime now) const;
  // Whether a fault that is aimed at a process may have ended it just now: a lowered limit, or a
  // set that matches no other; also a little after it was taken back.
  bool MayEndProcess(const std::function<bool(const faults::Fault&)>& aimed, SteadyTime now) const;
  // Who is not, and not away.
  std::vector<VehicleId> Unwell(SteadyTime now) const;
  std::uint32_t Living() const;
  std::span<const FaultCourse> Courses() const { return courses_; }
  // The faults that have started and of which more may be learnt, in the order they started. All
  // work of a cycle is done for these only: a schedule of weeks has half a million faults.
  std::span<const std::size_t> Open() const { return open_; }
  double HighestStepP99_us(VehicleId vehicle) const;
  const VehicleStatus* StatusOf(VehicleId vehicle) const;
  // When the newest was received; 0 before the first.
  SteadyTime StatusAt(VehicleId vehicle) const;
  // By its newest status, while that is fresh.
  std::optional<std::uint64_t> HeapOf(VehicleId vehicle, SteadyTime now) const;
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
  std::unordered_map<std::string, std::size_t> of_world_;  // faults by their name in events
  std::map<VehicleId, View> views_;
  std::vector<FaultCourse> courses_;
  // The counts at the start of the fault, by vehicle, from which its effect is measured. Only of
  // open ones.
  std::vector<std::map<VehicleId, VehicleStatus>> before_;
  std::vector<std::size_t> open_;
  std::optional<SteadyTime> started_;
  std::uint64_t refused_ = 0;
};

}  // namespace giveway::fleetctl
