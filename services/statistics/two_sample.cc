#include "services/statistics/two_sample.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/hypergeometric.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "services/statistics/distributions.h"
#include "services/statistics/ranks.h"
#include "services/types/math/math.h"

namespace giveway::statistics {
namespace {

// Up to so many values all assignments to the two samples are enumerated.
constexpr std::size_t kMostExact = 40;
constexpr double kTail = 0.99;

// The share of all choices of `chosen` out of the ranks whose sum is at least theirs. Ranks are
// doubled to be whole.
double ExactGreater(const std::vector<double>& ranks, std::size_t chosen, double rank_sum) {
  std::size_t most = 0;
  for (const double rank : ranks) most += static_cast<std::size_t>(2 * rank);
  // ways[k][s]: to choose k ranks of sum s
  std::vector<std::vector<double>> ways(chosen + 1, std::vector<double>(most + 1));
  ways[0][0] = 1;
  for (const double rank : ranks) {
    const auto doubled = static_cast<std::size_t>(2 * rank);
    for (std::size_t k = chosen; k > 0; --k) {
      for (std::size_t s = doubled; s <= most; ++s) ways[k][s] += ways[k - 1][s - doubled];
    }
  }
  const auto least = static_cast<std::ptrdiff_t>(std::llround(2 * rank_sum));
  const auto& sums = ways[chosen];
  const double all = std::accumulate(sums.begin(), sums.end(), 0.0);
  return std::accumulate(sums.begin() + least, sums.end(), 0.0) / all;
}

// `u` pairs of n * m in which `after` is greater; `tied` is the sum of t^3 - t over groups alike.
double NormalGreater(double u, double n, double m, double tied) {
  const double all = n + m;
  const double variance = n * m / 12 * (all + 1 - tied / (all * (all - 1)));
  if (variance <= 0) return 1;
  return NormalAbove((u - n * m / 2 - 0.5) / Sqrt(variance));
}

// Both histograms' buckets side by side: how many of each lie in it.
struct SharedBucket {
  double before = 0;
  double after = 0;
};

std::vector<SharedBucket> SideBySide(const Histogram& before, const Histogram& after) {
  const std::vector<HistogramBucket> a = before.Buckets();
  const std::vector<HistogramBucket> b = after.Buckets();
  std::vector<SharedBucket> shared;
  for (std::size_t i = 0, j = 0; i < a.size() || j < b.size();) {
    const bool of_a = j == b.size() || (i < a.size() && a[i].lowest <= b[j].lowest);
    const bool of_b = i == a.size() || (j < b.size() && b[j].lowest <= a[i].lowest);
    SharedBucket bucket;
    if (of_a) bucket.before = static_cast<double>(a[i++].count);
    if (of_b) bucket.after = static_cast<double>(b[j++].count);
    shared.push_back(bucket);
  }
  return shared;
}

double Weight(const Histogram& histogram, double most) {
  const double count = static_cast<double>(histogram.Count());
  return std::min(1.0, most / count);
}

}  // namespace

double MannWhitneyGreater(std::span<const double> before, std::span<const double> after) {
  if (before.empty() || after.empty()) return 1;
  std::vector<double> all(before.begin(), before.end());
  all.insert(all.end(), after.begin(), after.end());
  const std::vector<double> ranks = MidRanks(all);
  const double rank_sum =
      std::accumulate(ranks.begin() + static_cast<std::ptrdiff_t>(before.size()), ranks.end(), 0.0);
  if (all.size() <= kMostExact) return ExactGreater(ranks, after.size(), rank_sum);
  std::ranges::sort(all);
  double tied = 0;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i;
    while (end < all.size() && all[end] == all[i]) ++end;
    const double alike = static_cast<double>(end - i);
    tied += alike * alike * alike - alike;
    i = end;
  }
  const double n = static_cast<double>(before.size());
  const double m = static_cast<double>(after.size());
  return NormalGreater(rank_sum - m * (m + 1) / 2, n, m, tied);
}

double MannWhitneyGreater(const Histogram& before, double most_before, const Histogram& after,
                          double most_after) {
  if (before.Count() == 0 || after.Count() == 0) return 1;
  const double weight_before = Weight(before, most_before);
  const double weight_after = Weight(after, most_after);
  double below = 0;
  double u = 0;
  double tied = 0;
  for (const SharedBucket& bucket : SideBySide(before, after)) {
    const double a = bucket.before * weight_before;
    const double b = bucket.after * weight_after;
    u += b * (below + a / 2);
    below += a;
    const double alike = a + b;
    if (alike > 1) tied += alike * alike * alike - alike;
  }
  const double m = static_cast<double>(after.Count()) * weight_after;
  return NormalGreater(u, below, m, tied);
}

double TailGreater(const Histogram& before, double most_before, const Histogram& after,
                   double most_after) {
  if (before.Count() == 0 || after.Count() == 0) return 1;
  const double weight_before = Weight(before, most_before);
  const double weight_after = Weight(after, most_after);
  const double n = static_cast<double>(before.Count()) * weight_before;
  const double m = static_cast<double>(after.Count()) * weight_after;
  double tail_before = 0;
  double tail_after = 0;
  const std::vector<SharedBucket> shared = SideBySide(before, after);
  for (std::size_t i = shared.size(); i-- > 1;) {
    tail_before += shared[i].before * weight_before;
    tail_after += shared[i].after * weight_after;
    if (tail_before + tail_after >= (1 - kTail) * (n + m)) break;
  }
  const auto whole = [](double value) { return static_cast<std::uint64_t>(std::llround(value)); };
  return ShareGreater(whole(tail_before), whole(n), whole(tail_after), whole(m));
}

double ShareGreater(std::uint64_t hits_before, std::uint64_t of_before, std::uint64_t hits_after,
                    std::uint64_t of_after) {
  // More than that Boost 1.74 does not count; a file may claim any number.
  constexpr std::uint64_t kMost = std::numeric_limits<unsigned>::max() / 2;
  if (std::max(of_before, of_after) > kMost) return 1;
  if (hits_before > of_before || hits_after > of_after) return 1;
  const std::uint64_t hits = hits_before + hits_after;
  const std::uint64_t fewest_after = hits - std::min(hits, of_before);
  if (hits_after <= fewest_after) return 1;
  const boost::math::hypergeometric_distribution<double> by_chance(
      static_cast<unsigned>(hits), static_cast<unsigned>(of_after),
      static_cast<unsigned>(of_before + of_after));
  return cdf(complement(by_chance, static_cast<unsigned>(hits_after - 1)));
}

double RateGreater(std::uint64_t events_before, double exposure_before, std::uint64_t events_after,
                   double exposure_after) {
  const double share = exposure_after / (exposure_before + exposure_after);
  if (!(share > 0 && share < 1) || events_after == 0) return 1;
  const double after = static_cast<double>(events_after);
  const boost::math::binomial by_chance(static_cast<double>(events_before) + after, share);
  return cdf(complement(by_chance, after - 1));
}

std::vector<double> HolmAdjusted(std::span<const double> p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&p_values](std::size_t i) { return p_values[i]; });
  std::vector<double> adjusted(p_values.size());
  double greatest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double times = static_cast<double>(order.size() - i);
    greatest = std::max(greatest, std::min(1.0, times * p_values[order[i]]));
    adjusted[order[i]] = greatest;
  }
  return adjusted;
}

}  // namespace giveway::statistics
