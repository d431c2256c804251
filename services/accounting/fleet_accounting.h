// What became of the beacons between each two vehicles of a fleet, from what the vehicles report
// as readers: every life of both, added up. Bounded by the pairs. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "services/types/figures/beacon_account.h"
#include "services/types/fleet_facts.h"

namespace giveway {

struct PairAccount {
  VehicleId reader = kNoVehicle;
  VehicleId writer = kNoVehicle;
  AccountSums sums;  // of all their lives
  // Beacons counted twice or not at all: one too many in one life does not make up for one too few
  // in another.
  std::uint64_t differing = 0;
};

class FleetAccounting {
 public:
  // Of further ones only those that differ are kept, at most as many again.
  static constexpr std::size_t kMostPairs = 5000;
  // Accounts of one pair that may still grow: a writer that starts again is another one to its
  // readers, while the one before is still matched.
  static constexpr std::size_t kMostOpen = 8;

  void Fold(const VehicleStatus& status);

  // By reader, then by writer.
  std::vector<PairAccount> Pairs() const;
  // Beacons that a reader counted twice or not at all, of the writers that have left it; by reader.
  const std::map<VehicleId, std::uint64_t>& DepartedDiffering() const { return departed_; }
  // Readers that say they accepted beacons, and reported no account of any.
  std::vector<VehicleId> WithoutAccount() const;

 private:
  struct Open {
    BeaconAccount newest;
    std::uint64_t reported = 0;  // by the report with this number
  };
  struct Pair {
    PairAccount closed;  // of lives that are over; without names
    std::vector<Open> open;
  };

  bool HasRoomFor(const BeaconAccount& account) const;
  static void Add(const BeaconAccount& account, PairAccount* to);
  void Take(const BeaconAccount& account, Pair* pair) const;

  std::map<std::pair<VehicleId, VehicleId>, Pair> pairs_;  // reader, writer
  std::map<VehicleId, std::uint64_t> departed_;
  std::map<VehicleId, bool> accepts_;  // beacons; whether an account was reported, too
  std::uint64_t reports_ = 0;
};

}  // namespace giveway
