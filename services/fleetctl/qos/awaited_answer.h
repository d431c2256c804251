// Decides which of the answers received is the one to an order. Pure.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "services/types/admin.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

class AwaitedAnswer {
 public:
  // An unsealed refusal comes from a service with another key, or whose clock is behind; or an
  // intruder replayed the order, and the answer to the operator is still in transit.
  static constexpr Nanoseconds kUnsealedPatience = std::chrono::seconds(1);

  // `has_key`: answers are sealed, except refusals.
  AwaitedAnswer(VehicleId vehicle, std::uint64_t order, bool has_key)
      : vehicle_(vehicle), order_(order), has_key_(has_key) {}

  void Take(const AdminAnswer& answer, SteadyTime now);
  // No further answer needs to be awaited.
  bool IsThere(SteadyTime now) const;
  // The answer that counts when waiting ends. A service that has sealed an answer has the key: an
  // unsealed refusal does not come from it.
  std::optional<AdminAnswer> Get() const;

 private:
  VehicleId vehicle_;
  std::uint64_t order_;
  bool has_key_;
  bool restarts_ = false;  // a sealed answer says that it restarts
  std::optional<AdminAnswer> last_;
  std::optional<AdminAnswer> unsealed_;
  SteadyTime unsealed_counts_{0};
};

}  // namespace giveway::fleetctl
