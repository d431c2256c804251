// The edges every service process shares: stop signal, ticks on absolute deadlines, log. Flags are
// in flags.h.
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

// What a Ticker does at `now`, given the deadline it waits for.
struct NextTick {
  SteadyTime deadline;       // the one after
  std::uint32_t missed = 0;  // whole periods between the deadline and `now`
};
NextTick AfterDeadline(SteadyTime deadline, Nanoseconds period, SteadyTime now);

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

// Log lines go to stderr. Format "text" or "json" (one object a line: time, steady_ns, level,
// process, text; steady_ns is the steady clock, which all processes of a machine share), level
// "debug", "info", "warning" or "error". Before InitLog: text from info on.
void InitLog(const std::string& process_name, const std::string& format, const std::string& level);
void LogDebug(const std::string& text);
void LogInfo(const std::string& text);
void LogWarning(const std::string& text);
// About something that was noticed at `at`: that becomes the line's steady_ns.
void LogInfo(const std::string& text, SteadyTime at);
void LogWarning(const std::string& text, SteadyTime at);
void LogError(const std::string& text);

}  // namespace giveway::app
