#include "services/app/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "services/app/picture_canvas.h"
#include "services/app/picture_marks.h"
#include "services/app/utf8.h"

namespace giveway::app {
namespace {

constexpr double kHeader = 84;
constexpr double kLegendTop = 34;  // below the plot and its numbers
constexpr double kLegendRow = 22;
constexpr std::size_t kLegendColumns = 3;
constexpr std::size_t kLegendVehicles = 12;

WorldBox BoxOf(const Scenario& scenario, const std::vector<Track>& tracks) {
  WorldBox box;
  for (const VehicleOptions& vehicle : scenario.vehicles) {
    box.Include(vehicle.start_world.position_world, vehicle.profile.body_radius_m);
    if (vehicle.goal.set) box.Include(vehicle.goal.at_world, vehicle.goal.radius_m);
  }
  for (const Wall& wall : scenario.walls) {
    box.Include(wall.from_world, 0);
    box.Include(wall.to_world, 0);
  }
  for (const Track& track : tracks) {
    for (const Truth& truth : track.truths) {
      if (truth.present) box.Include(truth.world_from_body.position_world, 0);
    }
  }
  return box;
}

const WorldEvent* Last(const std::vector<WorldEvent>& events, EventKind kind) {
  const auto found = std::find_if(events.rbegin(), events.rend(),
                                  [kind](const WorldEvent& e) { return e.kind == kind; });
  return found == events.rend() ? nullptr : &*found;
}

void DrawHeader(Canvas* canvas, const Scenario& scenario, const std::vector<WorldEvent>& events) {
  const Pixel corner = canvas->TopLeft();
  canvas->Text({corner.x, 34}, Shortened(scenario.name, 48), "class=\"title\"");
  const WorldEvent* verdict = Last(events, EventKind::kVerdict);
  const bool passed = verdict != nullptr && verdict->value == 1;
  const std::string word = verdict == nullptr ? "no verdict" : passed ? "passed" : "failed";
  const char* colour = verdict == nullptr ? "#777" : passed ? "#1a7f37" : "#c00000";
  const double width = 26 + 9.0 * static_cast<double>(word.size());
  const double left = canvas->BottomRight().x - width;
  canvas->Rectangle({left, 15}, width, 26, fmt::format("rx=\"13\" fill=\"{}\"", colour));
  canvas->Text({left + width / 2, 33}, word,
               "class=\"middle\" style=\"fill:#fff;font-weight:600;font-size:14px\"");
  std::string below = verdict == nullptr ? "" : verdict->text;
  std::replace(below.begin(), below.end(), '_', ' ');
  if (below.empty() || passed) below = scenario.description;
  canvas->Text({corner.x, 60}, Shortened(below, 128), "class=\"quiet\"");
}

// One entry: a swatch at the left and the words beside it.
Pixel LegendCell(const Canvas& canvas, std::size_t index) {
  const double column = (canvas.BottomRight().x - canvas.TopLeft().x) / kLegendColumns;
  return {canvas.TopLeft().x + column * static_cast<double>(index % kLegendColumns),
          canvas.BottomRight().y + kLegendTop + 14 +
              kLegendRow * static_cast<double>(index / kLegendColumns)};
}

void LegendText(Canvas* canvas, Pixel cell, const std::string& text) {
  canvas->Text({cell.x + 36, cell.y + 4}, text, "");
}

std::size_t DrawLegendVehicles(Canvas* canvas, const Scenario& scenario) {
  std::size_t index = 0;
  for (; index < std::min(scenario.vehicles.size(), kLegendVehicles); ++index) {
    const VehicleOptions& vehicle = scenario.vehicles[index];
    const Pixel cell = LegendCell(*canvas, index);
    const std::string colour = ColourOf(scenario, vehicle.id);
    canvas->Line(cell, {cell.x + 26, cell.y},
                 fmt::format("stroke=\"{}\" stroke-width=\"3\"", colour));
    LegendText(canvas, cell,
               fmt::format("vehicle {}, {:.3g} m/s, {}", Number(vehicle.id), vehicle.cruise_m_s,
                           Name(vehicle.behaviour)));
  }
  if (index == scenario.vehicles.size()) return index;
  LegendText(canvas, LegendCell(*canvas, index),
             fmt::format("and {} more vehicles", scenario.vehicles.size() - index));
  return index + 1;
}

void DrawLegendMarks(Canvas* canvas, std::size_t first) {
  Pixel cell = LegendCell(*canvas, first);
  canvas->Circle({cell.x + 13, cell.y}, 7, "fill=\"#fff\" stroke=\"#555\" stroke-width=\"2\"");
  canvas->Line({cell.x + 13, cell.y}, {cell.x + 20, cell.y}, "stroke=\"#555\" stroke-width=\"2\"");
  LegendText(canvas, cell, "start and heading");
  cell = LegendCell(*canvas, first + 1);
  canvas->Circle({cell.x + 13, cell.y}, 7,
                 "fill=\"#555\" fill-opacity=\"0.12\" stroke=\"#555\" stroke-width=\"2\" "
                 "stroke-dasharray=\"4 3\"");
  canvas->Circle({cell.x + 13, cell.y}, 2.5, "fill=\"#555\"");
  LegendText(canvas, cell, "goal");
  cell = LegendCell(*canvas, first + 2);
  canvas->Line(cell, {cell.x + 26, cell.y}, "stroke=\"#555\" stroke-width=\"2.5\"");
  for (const double x : {6.0, 20.0}) {
    canvas->Line({cell.x + x, cell.y - 5}, {cell.x + x, cell.y + 5},
                 "stroke=\"#555\" stroke-width=\"2\"");
  }
  LegendText(canvas, cell, "every 2 s (seconds since the start)");
}

std::size_t LegendRows(const Scenario& scenario) {
  const std::size_t vehicles = scenario.vehicles.size();
  const std::size_t cells = std::min(vehicles, kLegendVehicles + 1);
  return (cells + kLegendColumns - 1) / kLegendColumns + 1;
}

}  // namespace

std::string DrawRun(const Scenario& scenario, const std::vector<Track>& tracks,
                    const std::vector<WorldEvent>& all_events) {
  std::vector<WorldEvent> events = all_events;
  std::erase_if(events, [](const WorldEvent& e) { return !std::isfinite(e.time_s); });
  const std::size_t rows = LegendRows(scenario);
  Canvas canvas(BoxOf(scenario, tracks), kHeader,
                kLegendTop + kLegendRow * static_cast<double>(rows) + 16);
  DrawGrid(&canvas);
  DrawScaleBar(&canvas);
  DrawWalls(&canvas, scenario);
  for (const Track& track : tracks) KeepLabelsOff(&canvas, track);
  DrawStartsAndGoals(&canvas, scenario);
  for (const Track& track : tracks) {
    DrawTrack(&canvas, track, ColourOf(scenario, track.vehicle));
  }
  DrawClosest(&canvas, scenario, events);
  DrawHalts(&canvas, scenario, events);
  DrawDeaths(&canvas, scenario, tracks, events);
  DrawContacts(&canvas, events);
  DrawHeader(&canvas, scenario, events);
  DrawLegendVehicles(&canvas, scenario);
  DrawLegendMarks(&canvas, (rows - 1) * kLegendColumns);
  return canvas.Svg(scenario.name);
}

}  // namespace giveway::app
