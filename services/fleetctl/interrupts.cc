#include "services/fleetctl/interrupts.h"

namespace giveway::fleetctl {
namespace {

volatile std::sig_atomic_t interrupt_count = 0;

void CountInterrupt(int /*signal_number*/) { interrupt_count = interrupt_count + 1; }

}  // namespace

Interrupts::Interrupts() {
  interrupt_count = 0;
  struct sigaction count {};
  count.sa_handler = CountInterrupt;
  ::sigaction(SIGINT, &count, &before_int_);
  ::sigaction(SIGTERM, &count, &before_term_);
  ::sigaction(SIGHUP, &count, &before_hup_);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  ::sigaction(SIGPIPE, &ignore, &before_pipe_);
}

Interrupts::~Interrupts() {
  ::sigaction(SIGINT, &before_int_, nullptr);
  ::sigaction(SIGTERM, &before_term_, nullptr);
  ::sigaction(SIGHUP, &before_hup_, nullptr);
  ::sigaction(SIGPIPE, &before_pipe_, nullptr);
}

int Interrupts::Count() { return interrupt_count; }

}  // namespace giveway::fleetctl
