// A figure as it is measured: all its values, and what is reported of them.
#pragma once

#include "services/types/figures/drive_figures.h"
#include "services/types/figures/histogram.h"

namespace giveway {

class MeasuredFigure {
 public:
  // Rounded; less than nothing counts as 0.
  void Add(double value);
  FigureSummary Summary() const;

 private:
  Histogram histogram_;
  FigureSummary summary_;  // without quantiles
};

}  // namespace giveway
