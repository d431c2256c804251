#include "services/node/interface_check.h"

#include "services/runtime/process.h"

namespace giveway {
namespace {

// Silence does not prove a changed interface, but without silence there is no need to check.
constexpr Nanoseconds kSilence = std::chrono::seconds(2);
constexpr Nanoseconds kCheckEvery = std::chrono::seconds(1);

}  // namespace

bool InterfaceCheck::MustEnd(SteadyTime now, bool heard) {
  if (heard) last_heard_ = now;
  if (now - last_heard_ < kSilence || now < next_check_) return false;
  next_check_ = now + kCheckEvery;
  const std::string change = change_();
  if (change.empty()) return false;
  LogError(change + "; ends, to be started again");
  return true;
}

}  // namespace giveway
