// The edges every service process shares: stop signal, ticks on absolute deadlines, log, and the
// flags with their GIVEWAY_ environment twins.
#pragma once

#include <cstdint>
#include <string>

#include "services/types/time.h"

namespace giveway::app {

// Installs handlers for SIGINT and SIGTERM that set a flag, and ignores SIGPIPE. Restores on
// destruction. One at a time.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
  bool IsSet() const;
};

// The steady clock, the only place it is read.
SteadyTime SteadyNow();
void SleepUntil(SteadyTime when);
// A random 32-bit number that is never 0, from the operating system.
std::uint32_t RandomNonZero();

// A tick on absolute deadlines: never catches up, counts what it missed.
class Ticker {
 public:
  explicit Ticker(Nanoseconds period);
  // Sleeps to the next deadline. Returns how many whole periods were missed (0 when on time).
  std::uint32_t Wait();

 private:
  Nanoseconds period_;
  SteadyTime next_;
};

// Log lines go to stderr. Format "text" or "json", level "debug" .. "error".
void InitLog(const std::string& process_name, const std::string& format, const std::string& level);
void LogDebug(const std::string& text);
void LogInfo(const std::string& text);
void LogWarning(const std::string& text);
void LogError(const std::string& text);

}  // namespace giveway::app
