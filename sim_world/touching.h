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

struct TouchingPair {
  VehicleId vehicle = kNobody;  // of two vehicles the lower id
  Touched touched = Touched::kVehicle;
  std::uint32_t other = 0;  // the other's id, or the number of the wall, obstacle or door

  friend constexpr auto operator<=>(const TouchingPair&, const TouchingPair&) = default;
};

class Touching {
 public:
  // True if the pair did not touch before.
  bool Begin(const TouchingPair& pair) {
    const auto at = std::ranges::lower_bound(pairs_, pair);
    if (at != pairs_.end() && *at == pair) return false;
    pairs_.insert(at, pair);
    return true;
  }
  template <typename Parted>
  void EndIf(const Parted& parted) {
    std::erase_if(pairs_, parted);
  }
  const std::vector<TouchingPair>& Pairs() const { return pairs_; }
  void Restore(const std::vector<TouchingPair>& pairs) { pairs_ = pairs; }

 private:
  std::vector<TouchingPair> pairs_;  // sorted
};

}  // namespace giveway::sim
