// Counts Ctrl-C and SIGTERM: the first asks for a clean stop, the second for an immediate one, the
// third ends the process whatever it is doing. So does a verb that has been interrupted and then
// does not ask for the count for a second: it hangs, in the library or elsewhere. Exit code 1.
#pragma once

#include <csignal>

namespace giveway::fleetctl {

// What becomes of an interrupted verb that stays silent.
enum class Silence {
  kHangs,    // it is ended after a second
  kComputes  // it never enters the library, and one step of it may take long
};

// Handles SIGINT, SIGTERM and SIGHUP and ignores SIGPIPE while it lives. One at a time.
class Interrupts {
 public:
  explicit Interrupts(Silence silence = Silence::kHangs);
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  // Asking shows that the verb is alive: its second starts again.
  static int Count();
  // Where a verb that was interrupted has something to do that takes longer.
  static void AllowSeconds(unsigned seconds);

 private:
  struct sigaction before_int_ {};
  struct sigaction before_term_ {};
  struct sigaction before_hup_ {};
  struct sigaction before_alarm_ {};
  struct sigaction before_pipe_ {};
};

}  // namespace giveway::fleetctl
