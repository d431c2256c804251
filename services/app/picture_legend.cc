// The legend below a picture: the vehicles, then each kind of mark that the picture holds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "services/app/picture_body.h"
#include "services/app/picture_marks.h"

namespace giveway::app {
namespace {

constexpr double kTop = 34;  // below the plot and its numbers
constexpr double kRow = 22;
constexpr std::size_t kColumns = 3;
constexpr std::size_t kMostVehicles = 12;

struct Mark {
  const char* words;
  std::function<void(Canvas* canvas, Pixel cell)> draw;
};

// One entry: a swatch at the left and the words beside it.
Pixel Cell(const Canvas& canvas, std::size_t index) {
  const double column = (canvas.BottomRight().x - canvas.TopLeft().x) / kColumns;
  return {canvas.TopLeft().x + column * static_cast<double>(index % kColumns),
          canvas.BottomRight().y + kTop + 14 + kRow * static_cast<double>(index / kColumns)};
}

void Words(Canvas* canvas, Pixel cell, const std::string& text) {
  canvas->Text({cell.x + 36, cell.y + 4}, text, "");
}

std::size_t VehicleRows(const Scenario& scenario) {
  const std::size_t cells = std::min(scenario.vehicles.size(), kMostVehicles + 1);
  return (cells + kColumns - 1) / kColumns;
}

void DrawVehicles(Canvas* canvas, const Scenario& scenario) {
  std::size_t index = 0;
  for (; index < std::min(scenario.vehicles.size(), kMostVehicles); ++index) {
    const VehicleOptions& vehicle = scenario.vehicles[index];
    const Pixel cell = Cell(*canvas, index);
    const std::string colour = ColourOf(scenario, vehicle.id);
    canvas->Line(cell, {cell.x + 26, cell.y},
                 fmt::format("stroke=\"{}\" stroke-width=\"3\"", colour));
    Words(canvas, cell,
          fmt::format("vehicle {}, {:.3g} m/s, {}", Number(vehicle.id), vehicle.cruise_m_s,
                      Name(vehicle.behaviour)));
  }
  if (index == scenario.vehicles.size()) return;
  Words(canvas, Cell(*canvas, index),
        fmt::format("and {} more vehicles", scenario.vehicles.size() - index));
}

void DrawStartMark(Canvas* canvas, Pixel cell) {
  canvas->Circle({cell.x + 13, cell.y}, 7, "fill=\"#fff\" stroke=\"#555\" stroke-width=\"2\"");
  canvas->Line({cell.x + 13, cell.y}, {cell.x + 20, cell.y}, "stroke=\"#555\" stroke-width=\"2\"");
}

void DrawGoalMark(Canvas* canvas, Pixel cell) {
  canvas->Circle({cell.x + 13, cell.y}, 7,
                 "fill=\"#555\" fill-opacity=\"0.12\" stroke=\"#555\" stroke-width=\"2\" "
                 "stroke-dasharray=\"4 3\"");
  canvas->Circle({cell.x + 13, cell.y}, 2.5, "fill=\"#555\"");
}

void DrawTickMark(Canvas* canvas, Pixel cell) {
  canvas->Line(cell, {cell.x + 26, cell.y}, "stroke=\"#555\" stroke-width=\"2.5\"");
  for (const double x : {6.0, 20.0}) {
    canvas->Line({cell.x + x, cell.y - 5}, {cell.x + x, cell.y + 5},
                 "stroke=\"#555\" stroke-width=\"2\"");
  }
}

void DrawSpawnMark(Canvas* canvas, Pixel cell) {
  canvas->Circle({cell.x + 13, cell.y}, 7,
                 "fill=\"#fff\" stroke=\"#888\" stroke-width=\"1.5\" stroke-dasharray=\"3 3\"");
}

void DrawStandingMark(Canvas* canvas, Pixel cell) {
  canvas->Rectangle({cell.x + 5, cell.y - 6}, 16, 12,
                    "fill=\"#5f6670\" fill-opacity=\"0.35\" stroke=\"#5f6670\"");
}

void DrawMovingMark(Canvas* canvas, Pixel cell) {
  canvas->Line(cell, {cell.x + 26, cell.y},
               "stroke=\"#9a6b3f\" stroke-width=\"1.5\" stroke-dasharray=\"2 4\"");
  canvas->Rectangle({cell.x + 1, cell.y - 5}, 13, 10,
                    "fill=\"#9a6b3f\" fill-opacity=\"0.35\" stroke=\"#9a6b3f\"");
}

void DrawDoorMark(Canvas* canvas, Pixel cell) { DrawDoor(canvas, cell, {cell.x + 26, cell.y}); }

// Lying on its side, to fit a row.
void DrawSignalMark(Canvas* canvas, Pixel cell) {
  canvas->Line({cell.x, cell.y - 6}, {cell.x, cell.y + 6}, "stroke=\"#2b2f33\" stroke-width=\"3\"");
  canvas->Rectangle({cell.x + 5, cell.y - 4.5}, 22, 9, "rx=\"3\" fill=\"#2b2f33\"");
  double x = cell.x + 9;
  for (const char* lamp : {"#e5484d", "#f5c518", "#30a46c"}) {
    canvas->Circle({x, cell.y}, 2.5, fmt::format("fill=\"{}\"", lamp));
    x += 7;
  }
}

std::vector<Mark> MarksOf(const Scenario& scenario) {
  std::vector<Mark> marks{{"start and heading", DrawStartMark},
                          {"goal", DrawGoalMark},
                          {"every 2 s (seconds since the start)", DrawTickMark}};
  const auto moves = [](const Obstacle& o) { return !o.waypoints_world.empty(); };
  const auto moving = std::count_if(scenario.obstacles.begin(), scenario.obstacles.end(), moves);
  const auto all = static_cast<std::ptrdiff_t>(scenario.obstacles.size());
  if (!scenario.spawns.empty()) marks.push_back({"spawn place", DrawSpawnMark});
  if (moving < all) marks.push_back({"obstacle", DrawStandingMark});
  if (moving > 0) marks.push_back({"moving obstacle at its start, its route", DrawMovingMark});
  if (!scenario.doors.empty()) marks.push_back({"door", DrawDoorMark});
  if (!scenario.signals.empty()) marks.push_back({"stop line and signal head", DrawSignalMark});
  return marks;
}

}  // namespace

double LegendHeight(const Scenario& scenario) {
  const std::size_t mark_rows = (MarksOf(scenario).size() + kColumns - 1) / kColumns;
  return kTop + kRow * static_cast<double>(VehicleRows(scenario) + mark_rows) + 16;
}

void DrawLegend(Canvas* canvas, const Scenario& scenario) {
  DrawVehicles(canvas, scenario);
  std::size_t index = VehicleRows(scenario) * kColumns;
  for (const Mark& mark : MarksOf(scenario)) {
    const Pixel cell = Cell(*canvas, index++);
    mark.draw(canvas, cell);
    Words(canvas, cell, mark.words);
  }
}

}  // namespace giveway::app
