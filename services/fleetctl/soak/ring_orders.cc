#include "services/fleetctl/soak/ring_orders.h"

namespace giveway::fleetctl {

void RingOrders::Add(const AdminOrder& order, std::size_t keep) {
  orders_.emplace(order.number, Waiting{order.vehicle, keep});
}

std::optional<std::size_t> RingOrders::Take(const AdminAnswer& answer) {
  const auto order = orders_.find(answer.order);
  if (order == orders_.end() || order->second.vehicle != answer.vehicle) return std::nullopt;
  if (has_key_ && answer.seal == Seal{}) return std::nullopt;
  const std::size_t keep = order->second.keep;
  orders_.erase(order);
  if (answer.state != AnswerState::kInEffect) return std::nullopt;
  return keep;
}

}  // namespace giveway::fleetctl
