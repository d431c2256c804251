// Whether a second run is different from a first by more than chance: tests of two samples, each
// with its p-value, one-sided: how likely at least so much more is where nothing differs.
// Pure.
//
//   MannWhitneyGreater  values on the whole: Mann and Whitney 1947; exact for few, else normal
//   ShareGreater        a share, as of values in a tail: Fisher's exact test
//   RateGreater         events over time: the exact conditional binomial test
//   HolmAdjusted        many tests at once: Holm 1979
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/types/figures/histogram.h"

namespace giveway::statistics {

// That values of `after` are greater than those of `before`. 1 if one of them is empty.
double MannWhitneyGreater(std::span<const double> before, std::span<const double> after);

// The same of two histograms. Their values stem from few vehicles over a time and resemble each
// other: each histogram weighs no more than `most` independent values.
double MannWhitneyGreater(const Histogram& before, double most_before, const Histogram& after,
                          double most_after);
// That more of `after` than of `before` lies above the 99 % quantile of both together.
double TailGreater(const Histogram& before, double most_before, const Histogram& after,
                   double most_after);

// That `hits` of `of` became a greater share.
double ShareGreater(std::uint64_t hits_before, std::uint64_t of_before, std::uint64_t hits_after,
                    std::uint64_t of_after);

// That events became more frequent; exposures above 0, in one unit.
double RateGreater(std::uint64_t events_before, double exposure_before, std::uint64_t events_after,
                   double exposure_after);

// In the order given; each as likely as chance alone makes any of them, 1 at most.
std::vector<double> HolmAdjusted(std::span<const double> p_values);

}  // namespace giveway::statistics
