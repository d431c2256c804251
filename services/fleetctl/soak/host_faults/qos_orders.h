// Faults that order vehicles to take another profile set while they drive, and their own again:
// which order is due when, and `fleetctl qos apply` as a child process for each. What an order
// changes is that verb's.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/faults/fault.h"
#include "services/fleetctl/process/child_process.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

enum class QosOrder : std::uint8_t { kTake, kTakeBack };

// The orders of one fault. One that fails, for the vehicle may be paused or cut off meanwhile, is
// given again: to take the set as long as the fault lasts, to take it back a few times. Pure.
class QosOrderCourse {
 public:
  // Of the order to give now; none while one is carried out.
  std::optional<QosOrder> Due(SteadyTime now) const;
  void NoteGiven(QosOrder order);
  // The order that was given ended.
  void NoteEnd(bool in_effect, SteadyTime now);
  void NoteFaultOver() { fault_over_ = true; }
  // Nothing is to be ordered any more.
  bool IsOver() const { return fault_over_ && !given_ && back_left_ == 0; }

 private:
  static constexpr int kBackAttempts = 5;

  std::optional<QosOrder> given_;
  bool taken_ = false;
  bool fault_over_ = false;
  int back_left_ = kBackAttempts;
  SteadyTime not_before_{0};
};

class QosOrders {
 public:
  // `verb` is the program with `qos apply` and the flags of every order; `own_set` what the fleet
  // was started with.
  QosOrders(std::vector<std::string> verb, std::string own_set);

  // `fault` outlives its orders. `to` as the flag --to has it.
  void Begin(const faults::Fault& fault, const std::string& set, const std::string& to);
  void End(const faults::Fault& fault);
  // Gives what is due, polls what was given. Call often.
  void Turn(SteadyTime now);

  struct Ended {
    const faults::Fault* fault = nullptr;
    QosOrder order = QosOrder::kTake;
    ProcessEnd how;
    std::string last_line;
  };
  // Those that ended since the last call.
  std::vector<Ended> TakeEnded();

 private:
  struct Ordered {
    std::string set;
    std::string to;
    QosOrderCourse course;
    QosOrder order = QosOrder::kTake;
    std::unique_ptr<ChildProcess> process;
  };

  std::unique_ptr<ChildProcess> Start(const Ordered& ordered) const;

  std::vector<std::string> verb_;
  std::string own_set_;
  std::map<const faults::Fault*, Ordered> ordered_;
  std::vector<Ended> ended_;
};

// The profile file `text` with the deadlines that its readers request doubled: it matches every
// writer that matched before, and takes effect while a vehicle drives. Empty if `text` is no
// profile file.
std::string WithPatientReaders(const std::string& text, const std::string& file);

}  // namespace giveway::fleetctl
