// Who still speaks: notes when each vehicle was last heard, names those that fall silent, and says
// when the body of a planned casualty is to be taken away. Silence is for good within a run.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/types/scenario.h"

namespace giveway::sim {

class Attendance {
 public:
  explicit Attendance(const Scenario& scenario);

  void Join(VehicleId vehicle, Tick tick);
  // From `tick` on silence counts; everybody who joined counts as heard then.
  void Start(Tick tick);
  void Heard(VehicleId vehicle, Tick tick);
  bool IsSilent(VehicleId vehicle) const;

  // The next vehicle that has been unheard for a second at `tick`, now silent; kNobody when none.
  VehicleId TakeNewlySilent(Tick tick);
  // The next silent vehicle whose body's time is over at `tick`, each once; kNobody when none.
  VehicleId TakeOverdueBody(Tick tick);

 private:
  struct Entry {
    VehicleId vehicle = kNobody;
    Tick heard = kNoTick;
    std::optional<Tick> silent_since;
    bool removed = false;
  };

  std::uint32_t silence_ticks_;
  std::uint32_t removal_ticks_;
  std::vector<Entry> entries_;
};

}  // namespace giveway::sim
