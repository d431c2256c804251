// The fallback of a process that tries something which may end it: where a signal such as SIGBUS or
// SIGABRT would, it restarts in place with its previous flags, as RestartWith does.
#pragma once

#include <string>

#include "services/runtime/process.h"
#include "services/runtime/restart.h"

namespace giveway {

// One at a time. The library under a participant is not ours: with shared memory that is full it
// ends the process by SIGBUS, and an exception in one of its threads does by SIGABRT.
class CrashFallback {
 public:
  // From now on until it is destroyed. `flags` are those to go back with, and the flag `why_flag`
  // says what ended it. Not where `stop` is set: then the signal does what it does. Throws
  // std::system_error.
  CrashFallback(NewFlags flags, std::string why_flag, const StopSignal& stop);
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
