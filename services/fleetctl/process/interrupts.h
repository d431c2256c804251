// Counts Ctrl-C and SIGTERM: the first asks for a clean stop, the second for an immediate one, the
// third ends the process whatever it is doing. The process is also ended if an interrupted verb
// does not query the count for a second: it hangs, in the library or elsewhere. It says so on
// stderr. Exit code 1, unless the verb asks for another.
#pragma once

#include <csignal>

namespace giveway::fleetctl {

// What happens to an interrupted verb that does not respond.
enum class Silence {
  kHangs,    // it is ended after a second
  kComputes  // it never enters the library, and one step of it may take long
};

// The exit code of a process that is ended so.
enum class HardExit {
  kAsFailed,  // 1, as of a verb that stops in good order: it was interrupted, and so has failed
  kAsSignal   // 128 + the first signal, as a shell reports it: of a verb whose 1 is a verdict
};

// Handles SIGINT, SIGTERM and SIGHUP and ignores SIGPIPE while it lives. One at a time.
class Interrupts {
 public:
  explicit Interrupts(Silence silence = Silence::kHangs, HardExit hard_exit = HardExit::kAsFailed);
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  // A query shows that the verb is alive: the time of its silence starts again.
  static int Count();
  // 128 + the first signal. Only after there was one.
  static int SignalCode();
  // From now on: for a verb that writes what takes longer, interrupted before or meanwhile.
  static void AllowSeconds(unsigned seconds);
  // What a process that is ended so writes to stdout: it runs no destructors. A text that is never
  // freed, or nullptr.
  static void WriteIfEnded(const char* text);

 private:
  struct sigaction before_int_ {};
  struct sigaction before_term_ {};
  struct sigaction before_hup_ {};
  struct sigaction before_alarm_ {};
  struct sigaction before_pipe_ {};
};

}  // namespace giveway::fleetctl
