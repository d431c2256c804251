// The contacts in progress, from the tick a contact starts until the shells have parted: a pair
// sliding along each other is one contact, not hundreds.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <vector>

#include "services/types/ids.h"
#include "sim_world/body.h"

namespace giveway::sim {

struct ContactPair {
  VehicleId vehicle = kNoVehicle;  // of two vehicles the lower id
  Touched touched = Touched::kVehicle;
  std::uint32_t other = 0;  // the other's id, or the number of the wall, obstacle or door

  friend constexpr auto operator<=>(const ContactPair&, const ContactPair&) = default;
};

class ActiveContacts {
 public:
  // True if the pair did not touch before.
  bool Begin(const ContactPair& pair) {
    const auto at = std::ranges::lower_bound(pairs_, pair);
    if (at != pairs_.end() && *at == pair) return false;
    pairs_.insert(at, pair);
    return true;
  }
  template <typename Parted>
  void EndIf(const Parted& parted) {
    std::erase_if(pairs_, parted);
  }
  const std::vector<ContactPair>& Pairs() const { return pairs_; }
  void Restore(const std::vector<ContactPair>& pairs) { pairs_ = pairs; }

 private:
  std::vector<ContactPair> pairs_;  // sorted
};

}  // namespace giveway::sim
