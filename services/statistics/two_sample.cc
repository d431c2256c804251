#include "services/statistics/two_sample.h"

#include <algorithm>
#include <boost/math/distributions/hypergeometric.hpp>
#include <boost/math/distributions/students_t.hpp>
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
constexpr double kMostAlike = 0.98;  // correlation of neighbours; above it nothing is known

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

// Of all choices of signs for the ranks the share whose positive ranks come to at least `sum`.
// Ranks are doubled to be whole.
double ExactSigned(const std::vector<double>& ranks, double sum) {
  std::vector<double> choices{1};
  for (const double rank : ranks) {
    const auto doubled = static_cast<std::size_t>(std::llround(2 * rank));
    choices.resize(choices.size() + doubled);
    for (std::size_t s = choices.size(); s-- > doubled;) choices[s] += choices[s - doubled];
  }
  const auto least = static_cast<std::ptrdiff_t>(std::llround(2 * sum));
  const double all = std::accumulate(choices.begin(), choices.end(), 0.0);
  return std::accumulate(choices.begin() + least, choices.end(), 0.0) / all;
}

// How each difference ranks by its size, with its sign; 0 for none.
std::vector<double> SignedRanks(const std::vector<double>& differences) {
  std::vector<double> sizes;
  for (const double difference : differences) {
    if (difference != 0) sizes.push_back(std::abs(difference));
  }
  const std::vector<double> ranks = MidRanks(sizes);
  std::vector<double> with_signs;
  std::size_t next = 0;
  for (const double difference : differences) {
    with_signs.push_back(difference == 0 ? 0 : std::copysign(ranks[next], difference));
    if (difference != 0) ++next;
  }
  return with_signs;
}

// That the mean of a series is above 0, by Student, where neighbours may resemble each other: so
// many of them that resemble each other as in a process of first order count for fewer.
double SeriesAboveZero(const std::vector<double>& series) {
  const double n = static_cast<double>(series.size());
  const double mean = std::accumulate(series.begin(), series.end(), 0.0) / n;
  double square = 0;
  double product = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    square += (series[i] - mean) * (series[i] - mean);
    if (i > 0) product += (series[i] - mean) * (series[i - 1] - mean);
  }
  if (square <= 0) return mean > 0 ? 0 : 1;
  // A short series shows it too small, by (1 + 4 r) / n.
  const double unbiased = (product / square + 1 / n) / (1 - std::min(4 / n, 0.5));
  const double r = std::clamp(unbiased, 0.0, kMostAlike);
  const double independent = std::max(2.0, n * (1 - r) / (1 + r));
  const double t = mean / std::sqrt(square / (n - 1) / independent);
  return cdf(complement(boost::math::students_t(independent - 1), t));
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

double SeriesGreater(std::span<const double> before, std::span<const double> after) {
  const std::size_t pairs = std::min(before.size(), after.size());
  std::vector<double> differences;
  for (std::size_t i = 0; i < pairs; ++i) differences.push_back(after[i] - before[i]);
  const std::vector<double> with_signs = SignedRanks(differences);
  std::vector<double> ranks;
  double sum = 0;
  for (const double rank : with_signs) {
    if (rank != 0) ranks.push_back(std::abs(rank));
    sum += std::max(0.0, rank);
  }
  if (ranks.size() < 2) return 1;
  // More have their exact share below Student's.
  const double exact = ranks.size() <= kMostExact ? ExactSigned(ranks, sum) : 0;
  return std::max(exact, SeriesAboveZero(with_signs));
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
