// The result of the runs of one generator, in whole numbers, so that sums do not depend on the
// order of addition or the number of machines. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/virtual/virtual_batch.h"

namespace giveway::fleetctl {

struct CampaignSums {
  static constexpr std::size_t kFailingKept = 100;

  std::string generator;
  std::uint32_t runs = 0;
  std::uint32_t failed_runs = 0;
  std::uint32_t contacts = 0;
  std::array<std::uint32_t, sim::kInvariantCount> violations{};
  std::uint32_t unmet = 0;  // runs that missed what the scenario expects
  std::int64_t vehicle_ms = 0;
  std::int64_t delays_us = 0;                     // of all that arrived
  std::map<std::uint32_t, std::uint32_t> delays;  // by tenths of a second
  std::optional<double> separation_m;             // to a micrometre
  TrustCounters trust;
  std::uint64_t hash = 0;
  std::vector<std::uint32_t> failing_seeds;  // ascending, the first kFailingKept

  void Add(const BatchTotals& batch);
  // The generator's name stays.
  void Merge(const CampaignSums& other);
};

// Of all generators; its name and failing seeds are left empty.
CampaignSums SumOf(const std::vector<CampaignSums>& generators);

// By nearest rank, in seconds; nullopt if there is none.
std::optional<double> DelayQuantile(const CampaignSums& sums, double share);
std::optional<double> MeanDelay(const CampaignSums& sums);

}  // namespace giveway::fleetctl
