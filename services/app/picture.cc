#include "services/app/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "services/app/picture_body.h"
#include "services/app/picture_canvas.h"
#include "services/app/picture_marks.h"
#include "services/app/utf8.h"

namespace giveway::app {
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

}  // namespace

std::string DrawRun(const Scenario& written, const std::vector<Track>& tracks,
                    const std::vector<WorldEvent>& all_events) {
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
  DrawHeader(&canvas, scenario, events);
  DrawLegend(&canvas, scenario);
  return canvas.Svg(scenario.name);
}

}  // namespace giveway::app
