#include "services/types/figures/histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace giveway {
namespace {

constexpr int kBitsKept = 11;  // of a value: 2048 steps of an octave
constexpr std::size_t kHalf = std::size_t{1} << (kBitsKept - 1);  // 1024, all but the first octave

// The first octave holds 0 to 1023, the others a power of two each from 1024 on.
struct Place {
  std::size_t octave = 0;
  std::size_t bucket = 0;
};

Place PlaceOf(std::int64_t value) {
  const auto bits = static_cast<std::uint64_t>(value);
  if (bits < kHalf) return {0, bits};
  const int shift = static_cast<int>(std::bit_width(bits)) - kBitsKept;
  return {static_cast<std::size_t>(shift) + 1, static_cast<std::size_t>(bits >> shift) - kHalf};
}

std::int64_t LowestOf(const Place& place) {
  if (place.octave == 0) return static_cast<std::int64_t>(place.bucket);
  return static_cast<std::int64_t>((place.bucket + kHalf) << (place.octave - 1));
}

// The middle of what the bucket holds.
std::int64_t MiddleOf(const Place& place) {
  const std::int64_t width = place.octave == 0 ? 1 : std::int64_t{1} << (place.octave - 1);
  return LowestOf(place) + (width - 1) / 2;
}

}  // namespace

void Histogram::Octave::Add(std::size_t bucket, std::uint64_t times) {
  if (counts.empty()) counts.resize(kHalf);
  counts[bucket] += times;
  count += times;
}

void Histogram::Add(std::int64_t value, std::uint64_t times) {
  if (times == 0) return;
  if (value > kHighest) clamped_ += times;
  value = std::clamp<std::int64_t>(value, 0, kHighest);
  const Place place = PlaceOf(value);
  if (octaves_.size() <= place.octave) octaves_.resize(place.octave + 1);
  octaves_[place.octave].Add(place.bucket, times);
  min_ = count_ == 0 ? value : std::min(min_, value);
  max_ = count_ == 0 ? value : std::max(max_, value);
  count_ += times;
}

void Histogram::AddMetres(double metres) {
  if (!std::isfinite(metres)) return;
  constexpr double kHighestMetres = static_cast<double>(kHighest) * 1e-6;
  Add(static_cast<std::int64_t>(std::llround(std::clamp(metres, 0.0, 2 * kHighestMetres) * 1e6)));
}

std::int64_t Histogram::Quantile(double p) const {
  if (count_ == 0) return 0;
  const double asked = std::ceil(std::clamp(p, 0.0, 1.0) * static_cast<double>(count_));
  const std::uint64_t rank =
      std::clamp<std::uint64_t>(static_cast<std::uint64_t>(asked), 1, count_);
  std::uint64_t seen = 0;
  for (std::size_t octave = 0; octave < octaves_.size(); ++octave) {
    if (seen + octaves_[octave].count < rank) {
      seen += octaves_[octave].count;
      continue;
    }
    for (std::size_t bucket = 0; bucket < kHalf; ++bucket) {
      seen += octaves_[octave].counts[bucket];
      if (seen >= rank) return std::clamp(MiddleOf({octave, bucket}), min_, max_);
    }
  }
  return max_;
}

double Histogram::Mean() const {
  if (count_ == 0) return 0;
  double sum = 0;
  for (std::size_t octave = 0; octave < octaves_.size(); ++octave) {
    for (std::size_t bucket = 0; bucket < octaves_[octave].counts.size(); ++bucket) {
      sum += static_cast<double>(octaves_[octave].counts[bucket]) *
             static_cast<double>(MiddleOf({octave, bucket}));
    }
  }
  return sum / static_cast<double>(count_);
}

void Histogram::Merge(const Histogram& other) {
  if (other.count_ == 0) return;
  if (octaves_.size() < other.octaves_.size()) octaves_.resize(other.octaves_.size());
  for (std::size_t octave = 0; octave < other.octaves_.size(); ++octave) {
    const std::vector<std::uint64_t>& more = other.octaves_[octave].counts;
    for (std::size_t bucket = 0; bucket < more.size(); ++bucket) {
      octaves_[octave].Add(bucket, more[bucket]);
    }
  }
  min_ = count_ == 0 ? other.min_ : std::min(min_, other.min_);
  max_ = count_ == 0 ? other.max_ : std::max(max_, other.max_);
  count_ += other.count_;
  clamped_ += other.clamped_;
}

std::vector<HistogramBucket> Histogram::Buckets() const {
  std::vector<HistogramBucket> buckets;
  for (std::size_t octave = 0; octave < octaves_.size(); ++octave) {
    for (std::size_t bucket = 0; bucket < octaves_[octave].counts.size(); ++bucket) {
      const std::uint64_t count = octaves_[octave].counts[bucket];
      if (count > 0) buckets.push_back({LowestOf({octave, bucket}), count});
    }
  }
  return buckets;
}

std::optional<Histogram> Histogram::From(std::span<const HistogramBucket> buckets, std::int64_t min,
                                         std::int64_t max, std::uint64_t clamped) {
  Histogram histogram;
  std::int64_t before = -1;
  for (const HistogramBucket& bucket : buckets) {
    if (bucket.lowest <= before || bucket.lowest > kHighest || bucket.count == 0 ||
        bucket.lowest != LowestOf(PlaceOf(bucket.lowest))) {
      return std::nullopt;
    }
    histogram.Add(bucket.lowest, bucket.count);
    before = bucket.lowest;
  }
  if (clamped > histogram.count_) return std::nullopt;
  if (buckets.empty()) return histogram;
  if (min < 0 || max > kHighest || min > max || LowestOf(PlaceOf(min)) != buckets.front().lowest ||
      LowestOf(PlaceOf(max)) != buckets.back().lowest) {
    return std::nullopt;
  }
  histogram.min_ = min;
  histogram.max_ = max;
  histogram.clamped_ = clamped;
  return histogram;
}

bool operator==(const Histogram& a, const Histogram& b) {
  return a.count_ == b.count_ && a.clamped_ == b.clamped_ && a.Min() == b.Min() &&
         a.Max() == b.Max() && a.Buckets() == b.Buckets();
}

}  // namespace giveway
