#include "services/fleetctl/campaign/campaign_sums.h"

#include <algorithm>
#include <cmath>

namespace giveway::fleetctl {
namespace {

// Beyond any run's duration.
constexpr double kLongestDelay_s = 1e6;

void KeepFirst(std::vector<std::uint32_t>* seeds) {
  std::ranges::sort(*seeds);
  if (seeds->size() > CampaignSums::kFailingKept) seeds->resize(CampaignSums::kFailingKept);
}

void KeepLeast(const std::optional<double>& value, std::optional<double>* least) {
  if (value && (!*least || *value < **least)) *least = value;
}

std::uint64_t Arrivals(const CampaignSums& sums) {
  std::uint64_t arrivals = 0;
  for (const auto& [tenths, count] : sums.delays) arrivals += count;
  return arrivals;
}

}  // namespace

void CampaignSums::Add(const BatchTotals& batch) {
  runs += batch.runs;
  failed_runs += static_cast<std::uint32_t>(batch.failing_seeds.size());
  contacts += batch.contacts;
  for (std::size_t i = 0; i < violations.size(); ++i) violations[i] += batch.violations[i];
  unmet += batch.unmet;
  vehicle_ms += std::llround(batch.vehicle_seconds * 1e3);
  for (const double delay_s : batch.delays_s) {
    delays_us += std::llround(delay_s * 1e6);
    ++delays[static_cast<std::uint32_t>(
        std::lround(std::clamp(delay_s, 0.0, kLongestDelay_s) * 10))];
  }
  if (batch.separation_m) KeepLeast(std::round(*batch.separation_m * 1e6) / 1e6, &separation_m);
  trust += batch.trust;
  hash += batch.hash;
  failing_seeds.insert(failing_seeds.end(), batch.failing_seeds.begin(), batch.failing_seeds.end());
  KeepFirst(&failing_seeds);
}

void CampaignSums::Merge(const CampaignSums& other) {
  runs += other.runs;
  failed_runs += other.failed_runs;
  contacts += other.contacts;
  for (std::size_t i = 0; i < violations.size(); ++i) violations[i] += other.violations[i];
  unmet += other.unmet;
  vehicle_ms += other.vehicle_ms;
  delays_us += other.delays_us;
  for (const auto& [tenths, count] : other.delays) delays[tenths] += count;
  KeepLeast(other.separation_m, &separation_m);
  trust += other.trust;
  hash += other.hash;
  failing_seeds.insert(failing_seeds.end(), other.failing_seeds.begin(), other.failing_seeds.end());
  KeepFirst(&failing_seeds);
}

CampaignSums SumOf(const std::vector<CampaignSums>& generators) {
  CampaignSums all;
  for (const CampaignSums& sums : generators) all.Merge(sums);
  all.failing_seeds.clear();
  return all;
}

std::optional<double> DelayQuantile(const CampaignSums& sums, double share) {
  const std::uint64_t arrivals = Arrivals(sums);
  if (arrivals == 0) return std::nullopt;
  const auto rank = static_cast<std::uint64_t>(share * static_cast<double>(arrivals - 1) + 0.5);
  std::uint64_t below = 0;
  for (const auto& [tenths, count] : sums.delays) {
    below += count;
    if (below > rank) return tenths / 10.0;
  }
  return std::nullopt;
}

std::optional<double> MeanDelay(const CampaignSums& sums) {
  const std::uint64_t arrivals = Arrivals(sums);
  if (arrivals == 0) return std::nullopt;
  return static_cast<double>(sums.delays_us) / 1e6 / static_cast<double>(arrivals);
}

}  // namespace giveway::fleetctl
