#include "services/statistics/slope.h"

#include <algorithm>
#include <cmath>

#include "services/statistics/distributions.h"
#include "services/statistics/ranks.h"

namespace giveway::statistics {
namespace {

constexpr double kTwoSided95 = 1.959963984540054;  // of the normal distribution
constexpr double kSecondsPerHour = 3600;
constexpr double kMostResembling = 0.98;  // correlation of neighbours; above it nothing is known

double MedianOf(std::vector<double>* values) {
  const std::size_t half = values->size() / 2;
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(half);
  std::nth_element(values->begin(), middle, values->end());
  if (values->size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values->begin(), middle)) / 2;
}

// An hour, of every pair of samples that have two times.
std::vector<double> PairSlopes(const std::vector<Sample>& samples) {
  std::vector<double> slopes;
  slopes.reserve(samples.size() * (samples.size() - 1) / 2);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t j = i + 1; j < samples.size(); ++j) {
      const double time_s = samples[j].time_s - samples[i].time_s;
      if (time_s > 0) {
        slopes.push_back((samples[j].value - samples[i].value) / time_s * kSecondsPerHour);
      }
    }
  }
  return slopes;
}

// Of Kendall's S without a trend; values that are alike take from it.
double KendallVariance(const std::vector<Sample>& samples) {
  std::vector<double> values;
  for (const Sample& sample : samples) values.push_back(sample.value);
  std::ranges::sort(values);
  const auto part = [](double n) { return n * (n - 1) * (2 * n + 5) / 18; };
  double variance = part(static_cast<double>(values.size()));
  for (std::size_t i = 0; i < values.size();) {
    std::size_t end = i;
    while (end < values.size() && values[end] == values[i]) ++end;
    variance -= part(static_cast<double>(end - i));
    i = end;
  }
  return std::max(variance, 0.0);
}

// Correlation of ranks (their mean taken off, `square` the sum of their squares) with those `lag`
// earlier.
double RankCorrelation(const std::vector<double>& ranks, double square, std::size_t lag) {
  double product = 0;
  for (std::size_t i = lag; i < ranks.size(); ++i) product += ranks[i] * ranks[i - lag];
  return product / square;
}

// The factor of a process of first order, (1 + r) / (1 - r). Without its trend a short series shows
// r too small, by (2 + 4 r) / n.
double FirstOrder(double correlation, double n) {
  const double unbiased = (correlation + 2 / n) / (1 - 4 / n);
  const double r = std::clamp(unbiased, 0.0, kMostResembling);
  return (1 + r) / (1 - r);
}

// By how much the variance grows because a sample resembles those before it: Hamed and Rao 1998,
// by the ranks of what is left without the trend. Never below 1: nothing is made surer than it is.
double Resemblance(const std::vector<Sample>& samples, double per_hour) {
  std::vector<double> rest;
  for (const Sample& sample : samples) {
    rest.push_back(sample.value - per_hour / kSecondsPerHour * sample.time_s);
  }
  std::vector<double> ranks = MidRanks(rest);
  const double n = static_cast<double>(ranks.size());
  double square = 0;
  for (double& rank : ranks) {
    rank -= (n + 1) / 2;
    square += rank * rank;
  }
  if (square <= 0) return 1;
  const double chance = kTwoSided95 / std::sqrt(n);  // what of a correlation may be chance
  const double first = RankCorrelation(ranks, square, 1);
  double sum = 0;
  for (std::size_t lag = 1; lag <= ranks.size() / 4; ++lag) {
    const double correlation = RankCorrelation(ranks, square, lag);
    const double left = n - static_cast<double>(lag);
    if (std::abs(correlation) > chance) sum += left * (left - 1) * (left - 2) * correlation;
  }
  return std::max(
      {1.0, first > chance ? FirstOrder(first, n) : 1.0, 1 + 2 * sum / (n * (n - 1) * (n - 2))});
}

}  // namespace

std::vector<Sample> BlockMedians(std::span<const Sample> samples, std::size_t blocks) {
  if (samples.size() <= blocks) return {samples.begin(), samples.end()};
  std::vector<Sample> medians;
  for (std::size_t block = 0; block < blocks; ++block) {
    const std::size_t begin = block * samples.size() / blocks;
    const std::size_t end = (block + 1) * samples.size() / blocks;
    std::vector<double> times;
    std::vector<double> values;
    for (std::size_t i = begin; i < end; ++i) {
      times.push_back(samples[i].time_s);
      values.push_back(samples[i].value);
    }
    medians.push_back({MedianOf(&times), MedianOf(&values)});
  }
  return medians;
}

std::optional<Slope> TheilSen(std::span<const Sample> all) {
  if (all.size() < kLeastSamples) return std::nullopt;
  const std::vector<Sample> samples = BlockMedians(all, kMostSlopeSamples);
  std::vector<double> slopes = PairSlopes(samples);
  if (slopes.empty()) return std::nullopt;
  Slope slope;
  slope.samples = all.size();
  slope.spans_s = all.back().time_s - all.front().time_s;
  slope.per_hour = MedianOf(&slopes);
  const double deviation =
      std::sqrt(KendallVariance(samples) * Resemblance(samples, slope.per_hour));
  const auto rising = std::ranges::count_if(slopes, [](double value) { return value > 0; });
  const auto falling = std::ranges::count_if(slopes, [](double value) { return value < 0; });
  if (deviation > 0) {
    slope.chance = NormalAbove((static_cast<double>(rising - falling) - 1) / deviation);
  }
  const double half = kTwoSided95 * deviation / 2;
  const double middle = static_cast<double>(slopes.size()) / 2;
  const double last = static_cast<double>(slopes.size() - 1);
  const auto at = [&slopes, last](double place) {
    const auto nth = slopes.begin() + static_cast<std::ptrdiff_t>(std::clamp(place, 0.0, last));
    std::nth_element(slopes.begin(), nth, slopes.end());
    return *nth;
  };
  slope.low_per_hour = std::min(slope.per_hour, at(std::floor(middle - half) - 1));
  slope.high_per_hour = std::max(slope.per_hour, at(std::ceil(middle + half)));
  return slope;
}

bool GrowsThroughout(std::span<const Sample> samples) {
  constexpr double kStandsStill = 1.0 / 8;  // of the mean rise
  if (samples.size() < kLeastSamples) return false;
  const std::vector<Sample> medians = BlockMedians(samples, kGrowthRuns);
  const double all = medians.back().value - medians.front().value;
  const double least = kStandsStill * all / static_cast<double>(kGrowthRuns - 1);
  return all > 0 && std::ranges::adjacent_find(medians, [least](const Sample& a, const Sample& b) {
                      return b.value - a.value < least;
                    }) == medians.end();
}

bool IsLeak(const Slope& slope, double least_per_hour) {
  return slope.low_per_hour > 0 && slope.per_hour >= least_per_hour;
}

}  // namespace giveway::statistics
