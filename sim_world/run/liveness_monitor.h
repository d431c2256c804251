// The liveness of vehicles: notes when each was last heard, names those that fall silent, and says
// when the body of a silent vehicle is to be removed.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "services/types/scenario.h"

namespace giveway::sim {

class LivenessMonitor {
 public:
  struct Entry {
    VehicleId vehicle = kNoVehicle;
    Tick heard = kNoTick;  // or joined, or the start signal
    bool spoke = false;    // since it joined
    std::optional<Tick> silent_since;
    bool removed = false;
  };

  explicit LivenessMonitor(const Scenario& scenario);

  // The vehicle joins, or joins again: its earlier state is forgotten.
  void Join(VehicleId vehicle, Tick tick);
  void Leave(VehicleId vehicle);
  // From `tick` on silence counts; every vehicle that joined counts as heard then.
  void Start(Tick tick);
  void Heard(VehicleId vehicle, Tick tick);
  bool IsSilent(VehicleId vehicle) const;
  // True if no process seems to run the vehicle at `tick`, also before the start: unheard for a
  // second and three ticks; for five seconds if it has joined and not yet been heard, because its
  // endpoints must be discovered first.
  bool IsAbandoned(VehicleId vehicle, Tick tick) const;

  // The next vehicle that has been unheard for so long at `tick`, now silent; kNoVehicle when none.
  VehicleId TakeNewlySilent(Tick tick);
  // The next silent vehicle whose body is to be removed at `tick`, each once; kNoVehicle when none.
  VehicleId TakeOverdueBody(Tick tick);

  std::span<const Entry> Entries() const { return entries_; }
  void Restore(std::span<const Entry> entries) { entries_.assign(entries.begin(), entries.end()); }

 private:
  bool IsUnheard(const Entry& entry, Tick tick) const;
  const Entry* Find(VehicleId vehicle) const;
  Entry* Find(VehicleId vehicle);

  std::uint32_t silence_ticks_;
  std::uint32_t removal_ticks_;
  std::uint32_t first_sample_ticks_;
  std::uint32_t never_spoke_ticks_;
  std::vector<Entry> entries_;  // sorted by id
};

}  // namespace giveway::sim
