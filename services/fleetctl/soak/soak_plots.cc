// The gnuplot programs of a soak's plots. The colours can be distinguished with colour blindness
// (Okabe and Ito 2008) and read on white and on black: the page gives black its text colour.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>

#include "services/fleetctl/process/gnuplot.h"
#include "services/fleetctl/soak/soak_format.h"
#include "services/fleetctl/soak/soak_page.h"

namespace giveway::fleetctl {
namespace {

constexpr std::array<const char*, 7> kColours = {"#0090d0", "#d55e00", "#009e73", "#cc79a7",
                                                 "#e69f00", "#8f6fe0", "#7f7f7f"};
constexpr const char* kGood = "#009e73";
constexpr const char* kBad = "#d55e00";
constexpr std::size_t kMostRows = 48;     // of a timeline; the rest is left out
constexpr std::size_t kMostCurves = 14;   // of processes in one picture
constexpr std::size_t kLabelLength = 24;  // letters of a name

// gnuplot could interpret any character that is not a letter or digit.
std::string PlotLabel(const std::string& text) {
  std::string label;
  for (const char c : text.substr(0, kLabelLength)) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' ||
                       c == '#' || c == '/';
    label += plain ? c : ' ';
  }
  return label;
}

std::string PlotSettings(const std::string& name, int height) {
  return fmt::format(
      "set terminal svg size 900,{} dynamic font 'sans-serif,13' name 'soak_{}'\n"
      "set grid lc rgb '#888888' lw 0.4\nset key above maxcols 4\nset tics nomirror\nset border 3\n"
      "set encoding utf8\n",
      height, name);
}

// Long times are easier to read in minutes than in seconds.
struct TimeAxis {
  double unit_s = 1;
  const char* label = "s";
};

TimeAxis AxisOf(const SoakResult& result) {
  if (result.ran_s > 4 * 86400) return {86400, "days"};
  if (result.ran_s > 4 * 3600) return {3600, "hours"};
  if (result.ran_s > 600) return {60, "min"};
  return {};
}

// Rows from top to bottom, each with its name on the left.
class PlotRows {
 public:
  // The row's height on the axis; 0 if no more fit.
  int Of(const std::string& name) {
    const auto found = std::ranges::find(names_, name);
    if (found != names_.end()) return static_cast<int>(found - names_.begin()) + 1;
    if (names_.size() >= kMostRows) return 0;
    names_.push_back(name);
    return static_cast<int>(names_.size());
  }
  int Height() const { return 150 + 22 * static_cast<int>(names_.size()); }
  std::string Settings() const {
    std::string tics;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      tics += fmt::format("{}'{}' {}", i == 0 ? "" : ", ", PlotLabel(names_[i]), i + 1);
    }
    return fmt::format("set ytics ({})\nset yrange [{}:0.3]\n", tics,
                       static_cast<double>(names_.size()) + 0.7);
  }

 private:
  std::vector<std::string> names_;
};

// One row per kind of fault, in the order of the page's table.
PlotRows KindRows(const SoakResult& result) {
  PlotRows rows;
  for (const FaultSummary& summary : SummariesOf(result.faults)) rows.Of(summary.kind);
  return rows;
}

// "$data << EOD ..." and the plot commands, one after the other.
class PlotParts {
 public:
  void Add(const std::string& data, const std::string& how) {
    if (data.empty()) return;
    const std::string block = fmt::format("$d{}", ++count_);
    blocks_ += block + " << EOD\n" + data + "EOD\n";
    draws_ += (draws_.empty() ? "" : ", ") + block + " " + how;
  }
  bool IsEmpty() const { return draws_.empty(); }
  std::string Text() const { return blocks_ + "plot " + draws_ + "\n"; }

 private:
  int count_ = 0;
  std::string blocks_;
  std::string draws_;
};

std::string Bars(const char* colour, const std::string& title) {
  return fmt::format("using 1:2:3:(0) with vectors nohead lw 7 lc rgb '{}' title '{}'", colour,
                     title);
}

SoakPlot FaultPlot(const SoakResult& result) {
  const TimeAxis axis = AxisOf(result);
  const double least_s = std::max(result.ran_s, 1.0) / 300;  // else it is not visible
  PlotRows rows = KindRows(result);
  std::string seen;
  std::string unseen;
  std::string broken;
  for (const SoakFault& fault : result.faults) {
    const int row = rows.Of(fault.kind);
    if (row == 0) continue;
    (fault.observed ? seen : unseen) += fmt::format("{} {} {}\n", StartOf(fault) / axis.unit_s, row,
                                                    std::max(fault.for_s, least_s) / axis.unit_s);
  }
  for (const SoakViolation& violation : result.violations) {
    broken += fmt::format("{} {}\n", violation.time_s / axis.unit_s, rows.Of("violations"));
  }
  PlotParts parts;
  parts.Add(seen, Bars(kColours[0], "fault, seen by its effect"));
  parts.Add(unseen, Bars(kColours[6], "fault, without effect"));
  parts.Add(broken, fmt::format("using 1:2 with points pt 2 ps 1 lw 2 lc rgb '{}' title "
                                "'violation'",
                                kBad));
  if (parts.IsEmpty()) return {};
  return {"faults", "Faults and violations over time",
          PlotSettings("faults", rows.Height()) + rows.Settings() +
              fmt::format("set xrange [0:{}]\nset xlabel 'time, {}'\n",
                          std::max(result.ran_s, 1.0) / axis.unit_s, axis.label) +
              parts.Text()};
}

SoakPlot ModePlot(const SoakResult& result) {
  const TimeAxis axis = AxisOf(result);
  std::map<VehicleId, std::vector<const ModeChange*>> by_vehicle;
  for (const ModeChange& change : result.modes) by_vehicle[change.vehicle].push_back(&change);
  PlotRows rows;
  std::map<std::string, std::string> spans;  // by mode
  for (const auto& [vehicle, changes] : by_vehicle) {
    const int row = rows.Of(fmt::format("vehicle {}", Number(vehicle)));
    if (row == 0) break;
    for (std::size_t i = 0; i < changes.size(); ++i) {
      const double end_s = i + 1 < changes.size() ? changes[i + 1]->time_s : result.ran_s;
      const double length_s = end_s - changes[i]->time_s;
      if (length_s <= 0) continue;
      spans[changes[i]->mode] +=
          fmt::format("{} {} {}\n", changes[i]->time_s / axis.unit_s, row, length_s / axis.unit_s);
    }
  }
  PlotParts parts;
  std::size_t colour = 0;
  for (const auto& [mode, span] : spans) {
    parts.Add(span, Bars(kColours[colour++ % kColours.size()], PlotLabel(mode)));
  }
  if (parts.IsEmpty()) return {};
  return {"modes", "Modes of the vehicles over time",
          PlotSettings("modes", rows.Height()) + rows.Settings() +
              fmt::format("set xrange [0:{}]\nset xlabel 'time, {}'\n",
                          std::max(result.ran_s, 1.0) / axis.unit_s, axis.label) +
              parts.Text()};
}

SoakPlot NearMissPlot(const SoakResult& result) {
  std::string points;
  for (const NearMiss& miss : result.near_misses) {
    points += fmt::format("{} {} {}\n", miss.x_m, miss.y_m, miss.distance_m);
  }
  PlotParts parts;
  parts.Add(points, "using 1:2:3 with points pt 7 ps 0.8 lc palette notitle");
  if (parts.IsEmpty()) return {};
  return {"near_misses", "Where vehicles came near each other",
          PlotSettings("near_misses", 620) +
              "set size ratio -1\nset offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05\n"
              "set xlabel 'x, m'\nset ylabel 'y, m'\nset cblabel 'shell to shell, m'\n"
              "set palette defined (0 '#d55e00', 0.5 '#e69f00', 1 '#0090d0')\n" +
              parts.Text()};
}

std::string NinesTics(double most) {
  constexpr std::array<const char*, 7> kShares = {"all",      "90 %%",     "99 %%",     "99.9 %%",
                                                  "99.99 %%", "99.999 %%", "99.9999 %%"};
  std::string tics;
  for (std::size_t i = 0; i < kShares.size() && static_cast<double>(i) <= most + 0.01; ++i) {
    tics += fmt::format("{}'{}' {}", i == 0 ? "" : ", ", kShares[i], i);
  }
  return fmt::format("set xtics ({})\nset xrange [0:{:.2f}]\nset rmargin 6\n", tics,
                     std::max(most, 1.0));
}

// Nines on the x axis: 90, 99, 99.9 % are 1, 2, 3, as in HdrHistogram's own plots.
SoakPlot QuantilePlot(const SoakResult& result, HistogramUnit unit) {
  const bool is_time = unit == HistogramUnit::kNanoseconds;
  PlotParts parts;
  std::size_t colour = 0;
  double most_nines = 0;
  for (const SoakHistogram& measured : result.histograms) {
    const std::uint64_t count = measured.histogram.Count();
    if (measured.unit != unit || count == 0) continue;
    const char* line = kColours[colour++ % kColours.size()];
    const double nines = std::min(6.0, std::log10(static_cast<double>(count)));
    most_nines = std::max(most_nines, nines);
    std::string points;
    for (double x = 0; x <= nines + 1e-9; x += 0.05) {
      points += fmt::format(
          "{:.2f} {}\n", x,
          static_cast<double>(measured.histogram.Quantile(1 - std::pow(10, -x))) * 1e-6);
    }
    parts.Add(points, fmt::format("using 1:2 with lines lw 2 lc rgb '{}' title '{}'", line,
                                  PlotLabel(measured.name)));
    std::string budgets;
    for (const HistogramBudget& budget : measured.budgets) {
      const double x = budget.quantile < 1 ? -std::log10(1 - budget.quantile) : nines;
      budgets += fmt::format("{:.2f} {}\n", x, static_cast<double>(budget.most) * 1e-6);
    }
    parts.Add(budgets, fmt::format("using 1:2 with points pt 8 ps 1.5 lw 2 lc rgb '{}' title "
                                   "'{} budget'",
                                   line, PlotLabel(measured.name)));
  }
  if (parts.IsEmpty()) return {};
  const std::string name = is_time ? "times" : "lengths";
  return {name, is_time ? "Times by their quantiles" : "Lengths by their quantiles",
          PlotSettings(name, 480) + NinesTics(most_nines) +
              "set xlabel 'share that is no greater'\nset yrange [0:*]\n" +
              fmt::format("set ylabel '{}'\n", is_time ? "ms" : "m") + parts.Text()};
}

// Of one kind of resource, the steepest first.
SoakPlot GrowthPlot(const SoakResult& result, ResourceKind kind, const std::string& name,
                    const std::string& title) {
  const TimeAxis axis = AxisOf(result);
  std::vector<const ResourceSlope*> shown;
  for (const ResourceSlope& row : result.slopes) {
    if (row.kind == kind && !row.curve.empty()) shown.push_back(&row);
  }
  std::ranges::stable_sort(shown, std::ranges::greater{},
                           [](const ResourceSlope* row) { return row->slope.per_hour; });
  if (shown.size() > kMostCurves) shown.resize(kMostCurves);
  PlotParts parts;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    std::string points;
    for (const statistics::Sample& sample : shown[i]->curve) {
      points += fmt::format("{} {}\n", sample.time_s / axis.unit_s, sample.value / 1048576);
    }
    parts.Add(points, fmt::format("using 1:2 with lines lw 2 dt {} lc rgb '{}' title '{} {}'",
                                  i / kColours.size() + 1, kColours[i % kColours.size()],
                                  PlotLabel(shown[i]->process), shown[i]->life + 1));
  }
  if (parts.IsEmpty()) return {};
  return {name, title,
          PlotSettings(name, 520) +
              fmt::format("set xlabel 'time, {}'\nset ylabel 'MiB'\n", axis.label) + parts.Text()};
}

SoakPlot DetectionPlot(const SoakResult& result) {
  PlotRows rows = KindRows(result);
  std::string noticed;
  std::string promised;
  std::string recovered;
  for (const SoakFault& fault : result.faults) {
    if (!fault.noticed_after_s && !fault.recovered_after_s) continue;
    const int row = rows.Of(fault.kind);
    if (row == 0) continue;
    if (fault.noticed_after_s) noticed += fmt::format("{} {}\n", *fault.noticed_after_s, row);
    if (fault.promised_s) promised += fmt::format("{} {}\n", *fault.promised_s, row);
    if (fault.recovered_after_s) {
      recovered += fmt::format("{} {}\n", *fault.recovered_after_s, row);
    }
  }
  PlotParts parts;
  const auto points = [](const char* shift, int type, const char* colour, const char* title) {
    return fmt::format("using 1:($2{}) with points pt {} ps 0.8 lw 1.5 lc rgb '{}' title '{}'",
                       shift, type, colour, title);
  };
  parts.Add(noticed, points("-0.15", 7, kColours[0], "noticed after"));
  parts.Add(promised, points("-0.15", 8, kBad, "promised"));
  parts.Add(recovered, points("+0.15", 6, kGood, "recovered after its end"));
  if (parts.IsEmpty()) return {};
  return {"detection", "Noticed and recovered, fault by fault",
          PlotSettings("detection", rows.Height()) + rows.Settings() +
              "set xrange [0:*]\nset xlabel 's'\n" + parts.Text()};
}

}  // namespace

std::vector<SoakPlot> PlotsOf(const SoakResult& result) {
  std::vector<SoakPlot> plots{
      FaultPlot(result),
      ModePlot(result),
      DetectionPlot(result),
      QuantilePlot(result, HistogramUnit::kNanoseconds),
      QuantilePlot(result, HistogramUnit::kMicrometres),
      GrowthPlot(result, ResourceKind::kPrivateBytes, "memory",
                 "Private memory, the steepest lives"),
      GrowthPlot(result, ResourceKind::kHeapBytes, "heap", "Heap in use, the steepest lives"),
      NearMissPlot(result)};
  std::erase_if(plots, [](const SoakPlot& plot) { return plot.name.empty(); });
  return plots;
}

}  // namespace giveway::fleetctl
