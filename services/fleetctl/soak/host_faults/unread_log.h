// What shows that the reader of a process's log has stopped: what the process writes waits in its
// pipe. A process that writes nothing meanwhile has nothing that could wait. Pure.
#pragma once

#include <fmt/format.h>
#include <sys/types.h>

#include <map>
#include <optional>
#include <string>

#include "services/faults/fault.h"
#include "services/fleetctl/process/child_process.h"

namespace giveway::fleetctl {

// Of the process that a fault is aimed at; no id while there is none.
struct LogSeen {
  std::optional<pid_t> process;
  OutputFlow output;
};

class UnreadLogs {
 public:
  void Begin(const faults::Fault& fault, const LogSeen& now) { before_[&fault] = now; }
  void End(const faults::Fault& fault) { before_.erase(&fault); }

  // Empty if nothing more waits than at the start, or if another process came.
  std::string EffectOf(const faults::Fault& fault, const LogSeen& now) const {
    const auto before = BeforeOf(fault, now);
    if (!before || now.output.unread <= before->unread) return {};
    return fmt::format("{} bytes of its log wait for a reader", now.output.unread - before->unread);
  }

  // It has written nothing. What was read of it was written too: then its reader had not stopped.
  std::string WhyNothing(const faults::Fault& fault, const LogSeen& now) const {
    const auto before = BeforeOf(fault, now);
    return before == now.output ? "it logged nothing meanwhile" : "";
  }

 private:
  // As the reader stopped, of the process that is there now.
  std::optional<OutputFlow> BeforeOf(const faults::Fault& fault, const LogSeen& now) const {
    const auto before = before_.find(&fault);
    if (before == before_.end() || !now.process || before->second.process != now.process) return {};
    return before->second.output;
  }

  std::map<const faults::Fault*, LogSeen> before_;
};

}  // namespace giveway::fleetctl
