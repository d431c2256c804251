#include "services/fleetctl/qos/awaited_answer.h"

namespace giveway::fleetctl {

void AwaitedAnswer::Take(const AdminAnswer& answer, SteadyTime now) {
  if (answer.vehicle != vehicle_ || answer.order != order_) return;
  const bool sealed = !has_key_ || answer.seal != Seal{};
  if (!sealed) {
    if (unsealed_) return;
    unsealed_ = answer;
    unsealed_counts_ = now + kUnsealedPatience;
  } else if (answer.state == AnswerState::kRestarting) {
    restarts_ = true;
  } else if (!last_) {
    last_ = answer;
  }
}

bool AwaitedAnswer::IsThere(SteadyTime now) const {
  return last_ || (unsealed_ && !restarts_ && now > unsealed_counts_);
}

std::optional<AdminAnswer> AwaitedAnswer::Get() const {
  if (last_ || restarts_) return last_;
  return unsealed_;
}

}  // namespace giveway::fleetctl
