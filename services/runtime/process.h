// The edges every service process shares: stop signal, ticks on absolute deadlines, log. Flags are
// in flags.h.
#pragma once

#include <cstdint>
#include <string>

#include "services/types/time.h"

namespace giveway {

// The first SIGINT or SIGTERM sets a flag; the process then has one second to leave in good order.
// When that is over, or a second one comes that is not the same request sent twice, the process
// ends at once, whatever its threads are doing: with the exit code 128 + signal, as of a shell.
// Nothing is flushed then. SIGPIPE and SIGXFSZ are ignored: a closed pipe and a file that may not
// grow are errors of the write that met them. Restores on destruction. One at a time.
class StopSignal {
 public:
  // Two signals closer than this are one request: `timeout` and terminals signal twice.
  static constexpr Nanoseconds kSameRequest = std::chrono::milliseconds(200);
  static constexpr unsigned kLeave_s = 1;

  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
  bool IsSet() const;
};

// The steady clock, the only place it is read.
SteadyTime SteadyNow();
void SleepUntil(SteadyTime when);
// Processor time that the calling thread has used.
Nanoseconds ThreadTimeNow();
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
// "debug", "info", "warning" or "error". Before InitLog: text from info on, written at once. From
// InitLog on no thread that logs waits for the reader of stderr: see log_queue.h.
void InitLog(const std::string& process_name, const std::string& format, const std::string& level);
void LogDebug(const std::string& text);
void LogInfo(const std::string& text);
void LogWarning(const std::string& text);
// About something that was noticed at `at`: that becomes the line's steady_ns.
void LogInfo(const std::string& text, SteadyTime at);
void LogWarning(const std::string& text, SteadyTime at);
void LogError(const std::string& text);
// At the end of the process, and before it becomes another image: true if all was written in time.
bool FlushLog(Nanoseconds limit);
// By this process, because its reader had stopped.
std::uint64_t LogLinesDropped();

}  // namespace giveway
