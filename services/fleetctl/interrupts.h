// Counts Ctrl-C and SIGTERM: the first asks for a clean stop, the second for an immediate one.
#pragma once

#include <csignal>

namespace giveway::fleetctl {

// Handles SIGINT, SIGTERM and SIGHUP and ignores SIGPIPE while it lives. One at a time.
class Interrupts {
 public:
  Interrupts();
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  static int Count();

 private:
  struct sigaction before_int_ {};
  struct sigaction before_term_ {};
  struct sigaction before_hup_ {};
  struct sigaction before_pipe_ {};
};

}  // namespace giveway::fleetctl
