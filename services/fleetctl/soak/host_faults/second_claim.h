// Second processes that ask for the id of a vehicle which is there: what shows that the world
// refused it to them, and until when that is waited for.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/faults/fault.h"
#include "services/fleetctl/process/child_process.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

// Of one of them. Pure.
class SecondClaim {
 public:
  // It has to start and be discovered first: on a busy machine a short fault is over before.
  static constexpr Nanoseconds kAnswerAfterEnd = std::chrono::seconds(8);

  // A line of the second process's log.
  void NoteLine(std::string_view line);
  // The world is gone or stopped.
  void NoteWorldAway() { world_was_away_ = true; }
  void NoteFaultOver(SteadyTime now);

  bool IsRefused() const { return refused_; }
  bool WorldWasAway() const { return world_was_away_; }
  // The fault is over and unanswered, and another one starts that concerns its vehicle or world.
  bool IsCutShort(const faults::Target& own, const faults::Target& by) const;
  // The fault is over, and no answer is awaited any more.
  bool IsOver(SteadyTime now) const;

 private:
  bool refused_ = false;
  bool world_was_away_ = false;
  std::optional<SteadyTime> ended_;
  bool awaited_ = true;  // after the end too
};

class SecondClaims {
 public:
  // The process runs until the fault is over and was answered.
  void Begin(const faults::Fault& fault, std::unique_ptr<ChildProcess> process);
  void End(const faults::Fault& fault, SteadyTime now);
  // Call often. `world_answers`: it is there, and not stopped.
  void Turn(SteadyTime now, bool world_answers);
  bool AreAwaited() const { return !claims_.empty(); }
  // Another fault starts: ends those that it cuts short, and returns their faults. Else a second
  // process could get the id of a vehicle that is gone by then.
  std::vector<const faults::Fault*> CutShort(const faults::Fault& by);

  // Empty if it was not refused yet.
  std::string EffectOf(const faults::Fault& fault) const;
  // Why nothing may come of it; empty: something must.
  std::string WhyNothing(const faults::Fault& fault) const;

 private:
  struct Claim {
    std::unique_ptr<ChildProcess> process;
    SecondClaim course;
  };
  std::map<const faults::Fault*, Claim> claims_;  // also a little after its end
};

}  // namespace giveway::fleetctl
