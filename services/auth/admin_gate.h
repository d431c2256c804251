// Which orders a service carries out: none by default; any, if it was started to take orders
// without a key; otherwise those with the seal of the operators' key and a number that was not used
// before. Pure but for the digest: the caller passes the time.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "services/types/admin.h"

namespace giveway::auth {

class AdminGate {
 public:
  static constexpr std::size_t kMostRemembered = 64;

  // Takes no order, or with `open` any.
  explicit AdminGate(bool open = false) : open_(open) {}
  // Takes sealed ones whose number is above `floor`: an operator numbers its orders by the time in
  // nanoseconds since 1970, so the start time of this process excludes all orders given to the
  // processes before it.
  AdminGate(std::string key, std::uint64_t floor) : key_(std::move(key)), floor_(floor) {}

  bool IsShut() const { return !open_ && !key_; }
  // Why the order is not to be carried out; empty if it is. One that is carried out is remembered:
  // it is refused from then on.
  std::string WhyNot(const AdminRequest& order);
  // The answer with its seal, where there is a key.
  void Seal(AdminAnswer* answer) const;

 private:
  bool open_ = false;
  std::optional<std::string> key_;
  std::uint64_t floor_ = 0;
  std::set<std::uint64_t> used_;  // above floor_
};

}  // namespace giveway::auth
