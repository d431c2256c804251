#include "services/fleetctl/tune/tune_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "services/fleetctl/output/html_text.h"
#include "services/fleetctl/tune/tune_report.h"

namespace giveway::fleetctl {
namespace {

// A rate of zero has no place on a logarithmic axis.
constexpr double kLeastRate = 1;

constexpr const char* kAxes =
    "set grid lc rgb '#dddddd'\nset key below\nset logscale y\nset tics nomirror\nset border 3\n";

constexpr const char* kStyle = R"(
body { font: 15px/1.45 sans-serif; margin: 2em auto; max-width: 72em; padding: 0 1em; color: #222; background: #fff }
table { border-collapse: collapse } td, th { padding: .25em .7em; text-align: right; border-bottom: 1px solid #ddd }
td:first-child, th:first-child { text-align: left } tr.chosen { background: #e6f4ea } tr.base { background: #eef2fb }
.differs { color: #b00020 } pre { background: #f5f5f5; padding: 1em; overflow-x: auto } svg { max-width: 100%; height: auto }
)";

// The name distinguishes two plots in one page.
std::string Settings(const std::string& name) {
  return "set terminal svg size 900,560 dynamic font 'sans-serif,13' background '#ffffff' name '" +
         name + "'\n" + kAxes;
}

// Names hold only letters, digits and '_', which gnuplot would set below the line.
std::string Label(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

double OnLogAxis(double rate) { return std::max(rate, kLeastRate); }

TunePlot FrontPlot(const TuneResult& result) {
  std::string front;
  std::string rest;
  for (const TunedCandidate& tuned : result.candidates) {
    if (!tuned.figures) continue;
    const TuneFigures& f = *tuned.figures;
    (tuned.on_front ? front : rest) +=
        fmt::format("{} {} {} {} \"{}\"\n", f.detection_ms, OnLogAxis(f.alarms_per_hour),
                    OnLogAxis(f.alarms_low), OnLogAxis(f.alarms_high), Label(tuned.candidate.name));
  }
  const auto draw = [](const char* data, const char* title, const char* colour) {
    return fmt::format(
        "{0} using 1:2:3:4 with yerrorbars pt 7 ps 0.8 lc rgb '{2}' title '{1}', "
        "{0} using 1:2:5 with labels left offset 0.7,0.4 font ',10' textcolor rgb '{2}' notitle",
        data, title, colour);
  };
  std::string program = Settings("front") +
                        "set xlabel 'a dead vehicle is noticed after, ms (mean, from its last "
                        "beacon)'\nset ylabel 'false alarms per vehicle-hour'\n";
  std::string draws;
  if (!rest.empty()) {
    program += "$rest << EOD\n" + rest + "EOD\n";
    draws = draw("$rest", "beaten by another", "#888888");
  }
  if (!front.empty()) {
    program += "$front << EOD\n" + front + "EOD\n";
    draws += (draws.empty() ? "" : ", ") + draw("$front", "on the front", "#0b6e4f");
  }
  return {"front", "False alarms against detection time", program + "plot " + draws + "\n"};
}

TunePlot PredictionPlot(const TuneResult& result) {
  std::string points;
  for (const TunedCandidate& tuned : result.candidates) {
    if (!tuned.figures || !tuned.predicted) continue;
    const TuneFigures& f = *tuned.figures;
    points += fmt::format("{} {} {} {} \"{}\"\n", OnLogAxis(tuned.predicted->alarms_per_hour),
                          OnLogAxis(f.alarms_per_hour), OnLogAxis(f.alarms_low),
                          OnLogAxis(f.alarms_high), Label(tuned.candidate.name));
  }
  if (points.empty()) return {};
  return {"prediction", "Measured against predicted",
          Settings("prediction") +
              "set logscale x\nset xlabel 'predicted false alarms per vehicle-hour'\n"
              "set ylabel 'measured, with 99 % interval'\n$points << EOD\n" +
              points +
              "EOD\nplot x with lines lc rgb '#bbbbbb' title 'equal', "
              "$points using 1:2:3:4 with yerrorbars pt 7 ps 0.8 lc rgb '#1f4e9c' notitle, "
              "$points using 1:2:5 with labels left offset 0.7,0.4 font ',10' notitle\n"};
}

std::string Row(const TuneResult& result, std::size_t place) {
  const TunedCandidate& tuned = result.candidates[place];
  std::string row = fmt::format("<tr class=\"{}\"><td>{}</td><td>{}</td>",
                                place == result.recommended ? "chosen"
                                : place == 0                ? "base"
                                                            : "",
                                tuned.candidate.name, HtmlEscaped(QosText(tuned.candidate.qos)));
  if (!tuned.figures) {
    return row + "<td colspan=\"9\">" + HtmlEscaped(tuned.trouble) + "</td></tr>\n";
  }
  const TuneFigures& f = *tuned.figures;
  const auto cell = [&row](const std::string& text) { row += "<td>" + text + "</td>"; };
  cell(tuned.on_front ? "yes" : "");
  cell(fmt::format("{:.0f} ({:.0f}&ndash;{:.0f})", f.alarms_per_hour, f.alarms_low, f.alarms_high));
  cell(tuned.predicted ? fmt::format("{:.0f}", tuned.predicted->alarms_per_hour) : "");
  cell(fmt::format("{:.0f} &plusmn; {:.0f}", f.detection_ms, f.detection_error_ms));
  cell(tuned.predicted ? fmt::format("{:.0f}", tuned.predicted->detection_ms) : "");
  cell(fmt::format("{:.1f}", f.age_mean_ms));
  cell(f.heard_bytes_s ? fmt::format("{:.1f}", *f.heard_bytes_s / 1000) : "");
  cell(fmt::format("{:.1f}", f.cpu_share * 100));
  cell("<span class=\"differs\">" + tuned.disagreement + "</span>");
  return row + "</tr>\n";
}

}  // namespace

std::vector<TunePlot> PlotsOf(const TuneResult& result) {
  std::vector<TunePlot> plots{FrontPlot(result)};
  TunePlot prediction = PredictionPlot(result);
  if (!prediction.name.empty()) plots.push_back(std::move(prediction));
  return plots;
}

std::string ToHtml(const TuneResult& result, const std::vector<DrawnPlot>& plots) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<title>fleetctl qos tune</title><style>{}</style></head><body>\n"
      "<h1>Beacon QoS, measured</h1>\n<p>{} vehicles as processes, {} ms a tick, impaired by "
      "<code>{}</code>, base <code>{}</code>, seed {}; each trial watched for {} s.</p>\n"
      "<pre>{}</pre>\n",
      kStyle, result.fleet.vehicles, result.fleet.tick_ms, HtmlEscaped(result.impair),
      HtmlEscaped(result.base_file), result.seed, result.alive_s, HtmlEscaped(VerdictText(result)));
  for (const DrawnPlot& plot : plots) {
    // From the svg element on: what comes before it belongs to a file, not into a page.
    const std::size_t begin = std::min(plot.svg.find("<svg"), plot.svg.size());
    html += "<h2>" + plot.title + "</h2>\n" + plot.svg.substr(begin) + "\n";
  }
  if (plots.empty())
    html += "<p>No pictures: gnuplot (Debian: gnuplot-nox) is not installed.</p>\n";
  html +=
      "<h2>All that was tried</h2>\n<table><tr><th>name</th><th>QoS of fleet/beacon</th>"
      "<th>front</th><th>false alarms per vehicle-hour (99 %)</th><th>predicted</th>"
      "<th>noticed after, ms</th><th>predicted</th><th>beacon age, ms</th><th>heard, kB/s</th>"
      "<th>CPU, %</th><th></th></tr>\n";
  for (std::size_t i = 0; i < result.candidates.size(); ++i) html += Row(result, i);
  return html + "</table>\n</body></html>\n";
}

}  // namespace giveway::fleetctl
