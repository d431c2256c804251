// Whether a second run is different from a first by more than chance: tests of two samples, each
// with its p-value, one-sided: how likely at least so much more is where nothing differs.
// Pure.
//
//   MannWhitneyGreater  values on the whole: Mann and Whitney 1947; exact for few, else normal
//   ShareGreater        a share, as of values in a tail: Fisher's exact test
//   SeriesGreater       two series side by side: Wilcoxon 1945, and Student
//   HolmAdjusted        many tests at once: Holm 1979
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace giveway::statistics {

// That values of `after` are greater than those of `before`. 1 if one of them is empty.
double MannWhitneyGreater(std::span<const double> before, std::span<const double> after);

// That values of `after` are greater than those of `before` at the same place of two series, such
// as the blocks of time of two runs; neighbours may resemble each other. By the signed ranks of the
// differences (Wilcoxon 1945), and never surer than Student's test of those ranks is, after what
// their resemblance takes from their number. Places that only one of them has are left out.
double SeriesGreater(std::span<const double> before, std::span<const double> after);

// That `hits` of `of` became a greater share.
double ShareGreater(std::uint64_t hits_before, std::uint64_t of_before, std::uint64_t hits_after,
                    std::uint64_t of_after);

// In the order given; each as likely as chance alone makes any of them, 1 at most.
std::vector<double> HolmAdjusted(std::span<const double> p_values);

}  // namespace giveway::statistics
