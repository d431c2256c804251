// A histogram with three significant digits over nine decades, after the idea of Gil Tene's
// HdrHistogram (hdrhistogram.org): within each power of two 1024 buckets of equal width, so that a
// value is known to 1/2048 of itself however large it is. Counts alone are kept, so that two merge
// without loss, over processes and over machines. Pure: the caller decides from which time on a
// duration counts: the intended start, not the one at which it was actually measured.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "services/types/time.h"

namespace giveway {

// A bucket that holds something: all values from `lowest` on, up to the next bucket's.
struct HistogramBucket {
  std::int64_t lowest = 0;
  std::uint64_t count = 0;

  friend constexpr bool operator==(const HistogramBucket&, const HistogramBucket&) = default;
};

// Of whole numbers: nanoseconds, or micrometres where lengths are meant. Each octave that was met
// takes 8 KiB, all of them together 272 KiB; nothing else grows.
class Histogram {
 public:
  // An hour of nanoseconds, or 3600 km of micrometres. More counts as this much, and as Clamped;
  // less than nothing counts as 0.
  static constexpr std::int64_t kHighest = 3'600'000'000'000;

  void Add(std::int64_t value, std::uint64_t times = 1);
  void Add(Nanoseconds duration) { Add(duration.count()); }
  void AddMetres(double metres);  // one that is not finite is left out

  std::uint64_t Count() const { return count_; }
  std::uint64_t Clamped() const { return clamped_; }  // were above kHighest
  // Exact, of what was added; 0 where nothing was.
  std::int64_t Min() const { return count_ == 0 ? 0 : min_; }
  std::int64_t Max() const { return count_ == 0 ? 0 : max_; }
  // The smallest value that at least the share `p`, 0 to 1, of all is no greater than; to 0.05 %.
  // 0 where nothing was added.
  std::int64_t Quantile(double p) const;
  // To 0.05 %.
  double Mean() const;

  void Merge(const Histogram& other);

  // Those that hold something, ascending; and the histogram they came from. Nothing if the
  // buckets are not ascending, none of their places is a bucket's, or min and max do not fit them.
  std::vector<HistogramBucket> Buckets() const;
  static std::optional<Histogram> From(std::span<const HistogramBucket> buckets, std::int64_t min,
                                       std::int64_t max, std::uint64_t clamped);

  friend bool operator==(const Histogram& a, const Histogram& b);

 private:
  struct Octave {
    std::vector<std::uint64_t> counts;  // by bucket; empty until it is met
    std::uint64_t count = 0;            // of all of them: statuses ask for quantiles all the time

    void Add(std::size_t bucket, std::uint64_t times);
  };

  std::vector<Octave> octaves_;
  std::uint64_t count_ = 0;
  std::uint64_t clamped_ = 0;
  std::int64_t min_ = 0;
  std::int64_t max_ = 0;
};

}  // namespace giveway
