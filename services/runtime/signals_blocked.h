// Threads that are started while it lives get no signals: those are the loop's, and a handler must
// not run on a thread that waits for a socket, a pipe or a lock. The thread that makes it is given
// back what it had blocked before. Not for what blocks some signals only.
#pragma once

#include <csignal>

namespace giveway {

class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace giveway
