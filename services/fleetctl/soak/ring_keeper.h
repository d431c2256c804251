// Makes every vehicle keep its recording ring when a promise was broken, by an order on
// fleet/admin, and removes unkept rings of ended lives: a soak of weeks has thousands of lives.
// Does I/O.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "services/fleetctl/soak/soak_result.h"
#include "services/link/operator_link.h"
#include "services/types/admin.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

// Unanswered orders to keep a ring, and which answers count. Pure.
class RingOrders {
 public:
  // `has_key`: answers are sealed, except refusals.
  explicit RingOrders(bool has_key) : has_key_(has_key) {}

  // `keep`: the incident that the order belongs to.
  void Add(std::uint64_t number, VehicleId vehicle, std::size_t keep);
  // The `keep` of an order that the vehicle reports as carried out. An unsealed refusal may come
  // from an intruder: the order remains, and may still be answered.
  std::optional<std::size_t> Take(const AdminAnswer& answer);

 private:
  struct Waiting {
    VehicleId vehicle = kNoVehicle;
    std::size_t keep = 0;
  };
  bool has_key_;
  std::map<std::uint64_t, Waiting> orders_;  // by number
};

class RingKeeper {
 public:
  static constexpr std::size_t kMostOrders = 3;
  // Of the unkept files of one vehicle; two belong to its current life.
  static constexpr std::size_t kMostUnkept = 6;

  // `folder`: where vehicles record, `ring`: how much of it each keeps, `key`: seals orders. Throws
  // LinkError.
  RingKeeper(const link::LinkOptions& options, const std::string& key,
             std::span<const VehicleId> fleet, std::filesystem::path folder, Nanoseconds ring);

  // Sends the order to all that are reached. Not again within a ring's length, which the files
  // cover anyhow, and kMostOrders times at most.
  void Keep(SteadyTime now, double time_s);
  // Takes the answers; removes surplus files.
  void Turn(SteadyTime now);
  const std::vector<KeptRings>& Kept() const { return kept_; }

 private:
  void Prune();

  link::OperatorLink link_;
  RingOrders orders_;
  std::vector<VehicleId> fleet_;
  std::filesystem::path folder_;
  Nanoseconds ring_;
  std::vector<KeptRings> kept_;
  std::set<std::string> kept_files_;
  SteadyTime ordered_{0};
  SteadyTime next_prune_{0};
};

}  // namespace giveway::fleetctl
