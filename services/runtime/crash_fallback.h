// The fallback of a process that does something which may end it: where a signal such as SIGBUS or
// SIGABRT would, it restarts in place with other flags, as RestartWith does.
#pragma once

#include <array>
#include <csignal>
#include <string>
#include <vector>

#include "services/runtime/process.h"
#include "services/runtime/restart.h"

namespace giveway {

// All that end a process by a fault of its own.
inline constexpr std::array kCrashSignals{SIGBUS, SIGSEGV, SIGABRT, SIGFPE, SIGILL, SIGSYS};

// One at a time. The library under a participant is not ours: with shared memory that is full it
// ends the process by SIGBUS, and an exception in one of its threads does by SIGABRT.
class CrashFallback {
 public:
  // From now on until it is destroyed, from each of `signals`. `flags` are those to go back with,
  // and the flag `why_flag` says what ended it. Not where `stop` is set: then the signal does what
  // it does. Throws std::system_error.
  CrashFallback(const std::vector<int>& signals, NewFlags flags, std::string why_flag,
                const StopSignal& stop);
  ~CrashFallback();
  CrashFallback(const CrashFallback&) = delete;
  CrashFallback& operator=(const CrashFallback&) = delete;

  // The flags to go back with for any other reason.
  NewFlags Because(const std::string& why) const;

 private:
  const NewFlags flags_;
  const std::string why_flag_;
};

}  // namespace giveway
