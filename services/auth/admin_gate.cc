#include "services/auth/admin_gate.h"

#include "services/auth/seals.h"

namespace giveway::auth {

std::string AdminGate::WhyNot(const AdminRequest& order) {
  if (open_) return {};
  if (!key_) return "it takes no orders: it was started without --admin-key and --admin";
  if (!IsSealed(*key_, order)) return "the order is not sealed with the key of this fleet";
  if (order.number <= floor_ || used_.contains(order.number)) {
    return "the number of the order is not above those before: it was given before, or the clock "
           "of "
           "the operator is behind that of this service";
  }
  used_.insert(order.number);
  if (used_.size() > kMostRemembered) {
    floor_ = *used_.begin();
    used_.erase(used_.begin());
  }
  return {};
}

void AdminGate::Seal(AdminAnswer* answer) const {
  if (key_) answer->seal = SealOf(*key_, *answer);
}

}  // namespace giveway::auth
