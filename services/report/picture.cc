#include "services/report/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "services/report/picture_canvas.h"
#include "services/report/picture_marks.h"
#include "services/runtime/utf8.h"

namespace giveway {

namespace {

// 1, 2 or 5 times a power of ten metres, at least `least_px` wide.
double RoundStep(const Canvas& canvas, double least_px) {
  double decade = 0.1;
  while (true) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (canvas.Pixels(decade * factor) >= least_px) return decade * factor;
    }
    decade *= 10;
  }
}

// The first multiple of `step` at or above `low`.
double FirstMultiple(double step, double low) { return std::ceil(low / step) * step; }

}  // namespace

void DrawGrid(Canvas* canvas) {
  const auto& [low, high] = canvas->Shown();
  const double step = RoundStep(*canvas, 60);
  const Pixel from = canvas->TopLeft();
  const Pixel to = canvas->BottomRight();
  canvas->Rectangle(from, to.x - from.x, to.y - from.y, "fill=\"#fafbfc\" stroke=\"#d5d9de\"");
  // Counted, not added up: far from the origin a sum may stand still.
  const auto lines = [step](double first, double last) {
    return static_cast<int>(std::floor((last - first) / step)) + 1;
  };
  const auto style = [](double value) {
    return value == 0 ? "stroke=\"#c3c9d1\"" : "stroke=\"#e6e9ed\"";
  };
  const double first_x = FirstMultiple(step, low.x);
  for (int i = 0; i < lines(first_x, high.x); ++i) {
    const double value = first_x + i * step + 0.0;
    const double x = canvas->At({value, 0}).x;
    canvas->Line({x, from.y}, {x, to.y}, style(value));
    canvas->Text({x, to.y + 16}, fmt::format("{:g}", value), "class=\"axis middle\"");
  }
  const double first_y = FirstMultiple(step, low.y);
  for (int i = 0; i < lines(first_y, high.y); ++i) {
    const double value = first_y + i * step + 0.0;
    const double y = canvas->At({0, value}).y;
    canvas->Line({from.x, y}, {to.x, y}, style(value));
    canvas->Text({from.x - 8, y + 4}, fmt::format("{:g}", value), "class=\"axis end\"");
  }
}

void DrawScaleBar(Canvas* canvas) {
  const double metres = RoundStep(*canvas, 60);
  const Pixel right{canvas->BottomRight().x - 14, canvas->BottomRight().y - 14};
  const Pixel left{right.x - canvas->Pixels(metres), right.y};
  constexpr const char* kStyle = "stroke=\"#444\" stroke-width=\"2\"";
  canvas->Line(left, right, kStyle);
  canvas->Line({left.x, left.y - 4}, {left.x, left.y + 4}, kStyle);
  canvas->Line({right.x, right.y - 4}, {right.x, right.y + 4}, kStyle);
  canvas->Text({(left.x + right.x) / 2, right.y - 7}, fmt::format("{:g} m", metres),
               "class=\"time middle\" style=\"font-size:11px\"");
}

namespace {

constexpr double kTop = 34;  // below the plot and its numbers
constexpr double kRow = 22;
constexpr std::size_t kColumns = 3;
constexpr std::size_t kMostVehicles = 12;

struct Mark {
  const char* words;
  std::function<void(Canvas* canvas, Pixel cell)> draw;
};

// One entry: a swatch at the left and the words next to it.
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

void DrawOneLaneMark(Canvas* canvas, Pixel cell) {
  DrawOneLane(canvas, {cell.x + 6, cell.y}, {cell.x + 20, cell.y}, 12);
}

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
  if (!scenario.one_lanes.empty()) marks.push_back({"one-lane section", DrawOneLaneMark});
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

namespace {

constexpr double kHeader = 84;

void IncludeVehicle(WorldBox* box, const VehicleOptions& vehicle) {
  box->Include(vehicle.start_world.position_world, vehicle.profile.body_radius_m);
  if (vehicle.goal.set) box->Include(vehicle.goal.at_world, vehicle.goal.radius_m);
}

void IncludePlace(WorldBox* box, const Scenario& scenario) {
  const auto line = [box](Vec2 from_world, Vec2 to_world) {
    box->Include(from_world, 0);
    box->Include(to_world, 0);
  };
  for (const Wall& wall : scenario.walls) line(wall.from_world, wall.to_world);
  for (const OneLane& lane : scenario.one_lanes) line(lane.from_world, lane.to_world);
  for (const Door& door : scenario.doors) line(door.from_world, door.to_world);
  for (const SignalPlan& s : scenario.signals) line(s.line_from_world, s.line_to_world);
  for (const Obstacle& obstacle : scenario.obstacles) {
    box->Include(obstacle.start_world.position_world, obstacle.radius_m);
    for (const Vec2 p : obstacle.waypoints_world) box->Include(p, obstacle.radius_m);
  }
}

WorldBox BoxOf(const Scenario& scenario, const std::vector<Track>& tracks) {
  WorldBox box;
  for (const VehicleOptions& vehicle : scenario.vehicles) IncludeVehicle(&box, vehicle);
  for (const VehicleOptions& spawn : scenario.spawns) IncludeVehicle(&box, spawn);
  IncludePlace(&box, scenario);
  for (const Track& track : tracks) {
    for (const Truth& truth : track.truths) {
      if (truth.present) box.Include(truth.world_from_body.position_world, 0);
    }
  }
  return box;
}

struct Badge {
  std::string word;
  const char* colour;
};

Badge BadgeOf(const std::optional<Headline>& headline) {
  if (!headline) return {"no verdict", "#777"};
  if (headline->verdict == Verdict::kNotRun) return {"not run", "#777"};
  if (headline->verdict == Verdict::kPassed) return {"passed", "#1a7f37"};
  return {"failed", "#c00000"};
}

void DrawHeader(Canvas* canvas, const Scenario& scenario, const std::optional<Headline>& headline) {
  const Pixel corner = canvas->TopLeft();
  canvas->Text({corner.x, 34}, Shortened(scenario.name, 48), "class=\"title\"");
  const auto [word, colour] = BadgeOf(headline);
  const double width = 26 + 9.0 * static_cast<double>(word.size());
  const double left = canvas->BottomRight().x - width;
  canvas->Rectangle({left, 15}, width, 26, fmt::format("rx=\"13\" fill=\"{}\"", colour));
  canvas->Text({left + width / 2, 33}, word,
               "class=\"middle\" style=\"fill:#fff;font-weight:600;font-size:14px\"");
  const bool passed = headline && headline->verdict == Verdict::kPassed;
  std::string below = headline && !passed ? headline->reason : "";
  std::replace(below.begin(), below.end(), '_', ' ');
  if (below.empty()) below = scenario.description;
  canvas->Text({corner.x, 60}, Shortened(below, 128), "class=\"quiet\"");
}

}  // namespace

std::string DrawRun(const Scenario& written, const std::vector<Track>& tracks,
                    const std::vector<WorldEvent>& all_events,
                    const std::optional<Headline>& headline) {
  const Scenario scenario = WithJoined(written, tracks);
  std::vector<WorldEvent> events = all_events;
  std::erase_if(events, [](const WorldEvent& e) { return !std::isfinite(e.time_s); });
  Canvas canvas(BoxOf(scenario, tracks), kHeader, LegendHeight(scenario));
  DrawGrid(&canvas);
  DrawScaleBar(&canvas);
  for (const Track& track : tracks) KeepLabelsOff(&canvas, track);
  DrawPlace(&canvas, scenario);
  DrawStartsAndGoals(&canvas, scenario);
  for (const Track& track : tracks) {
    DrawTrack(&canvas, track, ColourOf(scenario, track.vehicle));
  }
  DrawClosest(&canvas, scenario, tracks, events);
  DrawHalts(&canvas, scenario, tracks, events);
  DrawDeaths(&canvas, scenario, tracks, events);
  DrawContacts(&canvas, events);
  DrawHeader(&canvas, scenario, headline);
  DrawLegend(&canvas, scenario);
  return canvas.Svg(scenario.name);
}

}  // namespace giveway
