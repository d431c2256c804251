// Orders to keep a ring that are not answered yet, and which answers count. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "services/types/admin.h"

namespace giveway::fleetctl {

class RingOrders {
 public:
  // `has_key`: answers are sealed, but for refusals.
  explicit RingOrders(bool has_key) : has_key_(has_key) {}

  // `keep`: what the order is part of.
  void Add(const AdminOrder& order, std::size_t keep);
  // The `keep` of an order that the vehicle says it carried out. A refusal without a seal may be of
  // an intruder: the order stays, and may still be answered.
  std::optional<std::size_t> Take(const AdminAnswer& answer);

 private:
  struct Waiting {
    VehicleId vehicle = kNobody;
    std::size_t keep = 0;
  };
  bool has_key_;
  std::map<std::uint64_t, Waiting> orders_;  // by number
};

}  // namespace giveway::fleetctl
