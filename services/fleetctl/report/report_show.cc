#include "services/fleetctl/report/report_show.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "services/runtime/json.h"
#include "services/runtime/utf8.h"

namespace giveway::fleetctl {
namespace {

constexpr std::size_t kNameColumns = 29;
constexpr std::size_t kFigureColumns = 15;

std::string FormatChance(const std::optional<double>& p) {
  if (!p) return "-";
  return *p < 0.0001 ? "<0.0001" : fmt::format("{:.4f}", *p);
}

// A name too long for its column gets a line of its own.
std::string FigureLine(const std::string& change, const std::string& what,
                       const std::string& before, const std::string& after,
                       const std::string& chance) {
  const std::string figures =
      fmt::format("{:>{}} {:>{}} {:>8}", before, kFigureColumns, after, kFigureColumns, chance);
  if (what.size() <= kNameColumns) {
    return fmt::format("{:<9}{:<{}}{}\n", change, what, kNameColumns, figures);
  }
  return fmt::format("{:<9}{}\n{:<{}}{}\n", change, Shortened(what, 68), "", kNameColumns + 9,
                     figures);
}

// One line for each reason.
std::string Untested(const SoakComparison& comparison) {
  std::map<std::string, std::size_t> reasons;
  for (const ComparedFigure& figure : comparison.figures) {
    if (figure.change == Change::kUntested) ++reasons[figure.why_untested];
  }
  std::string text;
  for (const auto& [why, count] : reasons) text += fmt::format("  {} untested: {}\n", count, why);
  return text;
}

}  // namespace

std::string ToText(const SoakComparison& comparison, bool all) {
  std::string text = FigureLine("", "", "before", "after", "chance");
  std::size_t same = 0;
  for (const ComparedFigure& figure : comparison.figures) {
    if (figure.change == Change::kSame) {
      ++same;
      if (!all) continue;
    }
    text += FigureLine(ToString(figure.change), figure.what, figure.before, figure.after,
                       FormatChance(figure.p));
  }
  const auto count = [&comparison](Change change) {
    return std::ranges::count(comparison.figures, change, &ComparedFigure::change);
  };
  return text +
         fmt::format("{} worse, {} better, {} untested, {} the same{}\n", count(Change::kWorse),
                     count(Change::kBetter), count(Change::kUntested), same,
                     all || same == 0 ? "" : " (--all shows them)") +
         Untested(comparison);
}

std::string ToJson(const SoakComparison& comparison) {
  Json json;
  json["worse"] = comparison.AnyWorse();
  json["figures"] = JsonArray(comparison.figures, [](const ComparedFigure& figure) {
    Json object;
    object["what"] = figure.what;
    object["before"] = figure.before;
    object["after"] = figure.after;
    object["change"] = ToString(figure.change);
    object["p"] = OrNull(figure.p);
    if (!figure.why_untested.empty()) object["why_untested"] = figure.why_untested;
    return object;
  });
  return JsonText(std::move(json));
}

}  // namespace giveway::fleetctl
