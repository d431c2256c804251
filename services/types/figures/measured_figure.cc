#include "services/types/figures/measured_figure.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace giveway {

void MeasuredFigure::Add(double value) {
  constexpr double kMost = std::numeric_limits<std::uint32_t>::max();
  const auto whole = static_cast<std::uint32_t>(std::clamp(std::round(value), 0.0, kMost));
  histogram_.Add(std::int64_t{whole});
  summary_.newest[summary_.count++ % FigureSummary::kNewest] = whole;
  summary_.sum += whole;
  summary_.max = std::max(summary_.max, whole);
}

FigureSummary MeasuredFigure::Summary() const {
  FigureSummary summary = summary_;
  summary.p50 = static_cast<std::uint32_t>(histogram_.Quantile(0.5));
  summary.p99 = static_cast<std::uint32_t>(histogram_.Quantile(0.99));
  return summary;
}

}  // namespace giveway
