#include "services/fleetctl/soak/soak_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "services/fleetctl/soak/soak_format.h"
#include "services/fleetctl/soak/soak_html.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kPageStyle = R"(
:root { color-scheme: light dark; --line: #ddd; --soft: #f3f3f3; --good: #0b6e4f; --bad: #b00020; --other: #8a6d00 }
@media (prefers-color-scheme: dark) { :root { --line: #444; --soft: #222; --good: #5fd3a8; --bad: #ff8a80; --other: #e6c34a } }
body { font: 15px/1.45 sans-serif; margin: 1.5em auto; max-width: 64em; padding: 0 1em }
h1 { font-size: 1.5em; margin-bottom: .2em } h2 { font-size: 1.2em; margin: 1.6em 0 .4em }
table { border-collapse: collapse; font-size: .93em } td, th { padding: .25em .6em; text-align: right; border-bottom: 1px solid var(--line); vertical-align: top; white-space: nowrap }
td:first-child, th:first-child, .text { text-align: left } td.text { white-space: normal; overflow-wrap: anywhere; min-width: 11em }
.good { color: var(--good) } .bad { color: var(--bad); font-weight: bold } .other { color: var(--other) }
.scroll { overflow-x: auto } .scroll svg { min-width: 40em; max-width: 100%; height: auto }
pre { background: var(--soft); padding: .8em; white-space: pre-wrap; overflow-wrap: anywhere }
summary { cursor: pointer; margin: .4em 0 }
)";

const char* VerdictClass(SoakVerdict verdict) {
  if (verdict == SoakVerdict::kPassed) return "good";
  return verdict == SoakVerdict::kFailed ? "bad" : "other";
}

// gnuplot's black becomes the text colour of the page.
std::string Inlined(const std::string& svg) {
  std::string inlined = svg.substr(std::min(svg.find("<svg"), svg.size()));
  for (const char* black : {"\"black\"", "'black'"}) {
    const std::string word = black;
    const std::string text_colour = word.front() + std::string("currentColor") + word.front();
    for (std::size_t at = inlined.find(word); at != std::string::npos;
         at = inlined.find(word, at + text_colour.size())) {
      inlined.replace(at, word.size(), text_colour);
    }
  }
  return inlined;
}

std::string Picture(const std::vector<DrawnSoakPlot>& plots, const std::string& name) {
  const auto plot = std::ranges::find(plots, name, &DrawnSoakPlot::name);
  if (plot == plots.end()) return "";
  return "<h2>" + HtmlText(plot->title) + "</h2>\n<div class=\"scroll\">" + Inlined(plot->svg) +
         "</div>\n";
}

std::string Head(const SoakResult& result) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Soak of {}: {}</title><style>{}</style></head><body>\n"
      "<h1>Soak of {}: <span class=\"{}\">{}</span></h1>\n",
      HtmlText(result.scenario), ToString(result.verdict), kPageStyle, HtmlText(result.scenario),
      VerdictClass(result.verdict), ToString(result.verdict));
  if (!result.reasons.empty()) {
    html += "<ul>\n";
    for (const std::string& reason : result.reasons) {
      html += "<li>" + HtmlText(reason) + "</li>\n";
    }
    html += "</ul>\n";
  }
  html += "<p>The same again:</p>\n<pre>" + HtmlText(result.command) + "</pre>\n";
  html += "<div class=\"scroll\"><table>\n";
  for (const SummaryRow& row : SummaryOf(result)) {
    if (row.label == "again") continue;
    std::string text = HtmlText(row.text);
    if (!row.link.empty()) text = "<a href=\"" + HtmlText(row.link) + "\">" + text + "</a>";
    html += "<tr><td>" + HtmlText(row.label) + "</td><td class=\"text\">" + text + "</td></tr>\n";
  }
  return html + "</table></div>\n";
}

}  // namespace

std::string ToHtml(const SoakResult& result, const std::vector<DrawnSoakPlot>& plots) {
  std::string html = Head(result);
  html += HistogramSection(result);
  html += Picture(plots, "times") + Picture(plots, "lengths");
  html += ViolationSection(result);
  html += Picture(plots, "faults") + Picture(plots, "modes");
  html += FaultSection(result);
  html += Picture(plots, "detection");
  html += SlopeSection(result);
  html += Picture(plots, "memory");
  html += NearMissSection(result);
  html += Picture(plots, "near_misses");
  html += AccountingSection(result);
  if (plots.empty()) {
    html += "<p>No pictures: gnuplot (Debian: gnuplot-nox) drew none.</p>\n";
  }
  return html + "</body></html>\n";
}

}  // namespace giveway::fleetctl
