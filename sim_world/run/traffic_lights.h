// The scenario's signal heads: what each shows at a tick, and which of them publish in it. Follows
// the plans and the faults; knows no vehicles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/types/scenario.h"
#include "services/types/signal.h"

namespace giveway::sim {

// A head publishes when its phase changes, and at least this often.
inline constexpr Nanoseconds kSignalPeriod{100'000'000};

class SignalHeads {
 public:
  explicit SignalHeads(const Scenario& scenario);

  // `time_s` since the start signal; negative before it: then every head is red and does not know
  // for how long (to_change_s is 0). One call a tick.
  void Advance(double time_s, WorldEpoch epoch, Tick tick);
  // The heads that publish in this tick, by id; valid until the next Advance.
  std::span<const SignalState> States() const { return states_; }

  // From the next Advance on: kSignalDark keeps publishing with its lamps out, kSignalSilent stops
  // publishing. False for other faults and unknown heads.
  bool Fail(SignalId signal, FaultKind fault);

 private:
  struct Head {
    SignalPlan plan;
    bool dark = false;
    bool silent = false;
    Tick spoke = kNoTick;
    SignalPhase said = SignalPhase::kDark;  // if it has ever published
  };
  static SignalState Now(const Head& head, double time_s);

  Nanoseconds tick_period_;
  std::vector<Head> heads_;
  std::vector<SignalState> states_;
};

}  // namespace giveway::sim
