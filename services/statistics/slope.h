// How fast a figure grows, and whether that is a leak: the Theil-Sen slope, the median of the
// slopes of all pairs of samples, which up to 29 % of wild samples do not move, with the 95 %
// interval that Kendall's statistic gives it (Sen 1968, "Estimates of the regression coefficient
// based on Kendall's tau"). Samples of a process resemble those before them; what that takes from
// their weight is computed in after Hamed and Rao (1998), and never less than a process of first
// order takes: noise that does not grow, resembling itself or not, has an interval above zero in 2
// to 4 series of 100. Pure.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace giveway::statistics {

struct Sample {
  double time_s = 0;
  double value = 0;

  friend constexpr bool operator==(const Sample&, const Sample&) = default;
};

// Values an hour.
struct Slope {
  double per_hour = 0;
  double low_per_hour = 0;   // 95 % interval
  double high_per_hour = 0;  // never below low
  std::size_t samples = 0;   // that went in
  double spans_s = 0;        // from the first to the last
  double chance = 1;         // that what does not grow seems to grow so; one-sided, by Kendall

  friend constexpr bool operator==(const Slope&, const Slope&) = default;
};

// Fewer say nothing.
inline constexpr std::size_t kLeastSamples = 20;
// More are taken together, neighbours into their medians: a slope costs half this squared.
inline constexpr std::size_t kMostSlopeSamples = 1000;

// Samples ascending in time. Nothing for fewer than kLeastSamples, or if all have one time.
std::optional<Slope> TheilSen(std::span<const Sample> samples);

// Medians of `blocks` runs of neighbours of nearly equal length; the samples if they are fewer.
std::vector<Sample> BlockMedians(std::span<const Sample> samples, std::size_t blocks);

// Below that a growth is no leak: bytes an hour; pieces (descriptors, threads) an hour; processors
// an hour.
inline constexpr double kLeastLeakBytes = 64 * 1024;
inline constexpr double kLeastLeakPieces = 1;
inline constexpr double kLeastLeakProcessors = 0.05;

// Of so many runs of neighbours of nearly equal length each has a median above that of the one
// before, by at least an eighth of what it rises on average: what grows never stands still. What
// fills up, such as caches and pools, does, or nearly.
inline constexpr std::size_t kGrowthRuns = 8;
bool GrowsThroughout(std::span<const Sample> samples);

// The interval lies wholly above zero, and the slope reaches `least_per_hour`. Of one series alone:
// of forty that do not grow, one has such an interval. For many series correct for multiple
// comparisons (HolmAdjusted).
bool IsLeak(const Slope& slope, double least_per_hour);

}  // namespace giveway::statistics
