// What runs of one generator came to, in whole numbers, so that sums are the same in whatever order
// and by however many machines they were added up. Pure.
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
  std::int64_t delays_us = 0;                     // of all who arrived
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

// By nearest rank, in seconds; nothing where there is none.
std::optional<double> DelayQuantile(const CampaignSums& sums, double share);
std::optional<double> MeanDelay(const CampaignSums& sums);

}  // namespace giveway::fleetctl
